//! `modl watch --page`: a page on this machine that shows a program while it is typed, and changes its text.

mod answers;
mod http;
mod program;
mod server;

use super::arguments::Globals;
use super::disk::Project;
use super::terminal::{cancelled, listen_for_cancel, print, print_error};
use super::{CallError, Ending, show};
use program::Program;
use server::Server;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// The time between two looks at the files, and at whether the user has cancelled.
const POLL_INTERVAL: Duration = Duration::from_millis(20);

/// Serves the page of a program until the user cancels, and prints its address. `port`: that of the page, a free one for `None`;
/// with `open` it is opened in the browser.
///
/// # Errors
/// A message if there is not one program, the file can't be read or lies outside of the project's root, or the port is taken.
pub(super) fn run(
    files: &[PathBuf],
    port: Option<u16>,
    open: bool,
    globals: &Globals,
) -> Result<Ending, CallError> {
    let [file] = files else {
        return Err(CallError("`modl watch --page` shows one program".to_owned()));
    };
    if file == Path::new("-") {
        return Err(CallError(format!("`{}`: standard input does not change", file.display())));
    }
    let project = Project::open(file, globals.root.as_deref(), globals.stdlib.as_deref())?;
    let program = Arc::new(Program::new(file, project));
    let server = Server::bind(program.clone(), port)?;
    listen_for_cancel();
    let address = server.address();
    print(&format!("{address}\n"));
    print_error(&format!("watching {}; the page is for this machine only, Ctrl-C ends\n", file.display()));
    if open && let Err(why) = show::open_address(&address) {
        print_error(&format!("{why}\n"));
    }
    std::thread::scope(|scope| {
        let serving =
            std::thread::Builder::new().name("page".into()).spawn_scoped(scope, || server.serve(&cancelled));
        while !cancelled() {
            program.look();
            std::thread::park_timeout(POLL_INTERVAL);
        }
        program.wake();
        serving.map(drop)
    })
    .map_err(|e| {
        CallError(format!("the system gives no memory for the page: {}", super::disk::system_words(&e)))
    })?;
    Ok(Ending::Cancelled)
}
