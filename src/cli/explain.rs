//! `modl explain`: the pages of `docs/errors/`, embedded.

use super::arguments::Globals;
use super::terminal::{print, print_json};
use super::{CallError, Ending};
use crate::document::page_of_code;
use crate::source::{code, suggest::suggest};

/// Runs the command `modl explain`: prints the page of a diagnostic code, in letters of any case, or lists all codes
/// for `None`.
///
/// # Errors
/// A message for an unknown code.
pub(super) fn run(wanted: Option<&str>, globals: &Globals) -> Result<Ending, CallError> {
    let Some(wanted) = wanted else {
        list(globals);
        return Ok(Ending::Fine);
    };
    let wanted = wanted.trim().to_ascii_uppercase();
    let found = code::ALL.iter().find(|(code, _)| code.0 == wanted);
    let Some((code, title)) = found else {
        return Err(CallError(unknown(&wanted)));
    };
    let page = page_of_code(code.0).map_or_else(|| format!("# {code}: {title}\n"), str::to_owned);
    if globals.json {
        print_json(&format!(
            "{:#}",
            serde_json::json!({ "ok": true, "code": code.0, "title": title, "page": page })
        ));
    } else {
        print(&page);
    }
    Ok(Ending::Fine)
}

/// Lists all codes with their titles.
fn list(globals: &Globals) {
    if globals.json {
        let all: Vec<_> =
            code::ALL.iter().map(|(c, title)| serde_json::json!({ "code": c.0, "title": title })).collect();
        print_json(&format!("{:#}", serde_json::json!({ "ok": true, "codes": all })));
    } else {
        let lines: Vec<String> = code::ALL.iter().map(|(code, title)| format!("{code}  {title}\n")).collect();
        print(&lines.concat());
    }
}

/// Returns the message about an unknown code, with the nearest known one.
fn unknown(wanted: &str) -> String {
    let near = suggest(wanted, code::ALL.iter().map(|(code, _)| code.0));
    let near = near.map_or_else(String::new, |code| format!("; did you mean {code}?"));
    format!("there is no code `{wanted}`{near} (`modl explain` lists them all)")
}
