//! The program of the page: its text as it is on disk, what it shows, and the changes that are written.

use super::super::disk::{self, FILE_BYTES_MAX, Project};
use super::super::output;
use super::super::watched::Watched;
use crate::interrupt::CancelState;
use crate::live::{Document, Edit, Model, Refusal};
use crate::source::{Files, ReadError};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// The most declarations whose models are kept: as many as pages show at a time.
const MODELS_MAX: usize = 8;

/// The program of a page, which all its pages share.
pub(super) struct Program {
    /// The file as the user named it.
    file: PathBuf,
    imports: Arc<Imports>,
    state: Mutex<State>,
    changed: Condvar,
}

/// The state that changes while the page is open.
struct State {
    document: Document,
    /// The reason why the file can't be read; `None` if it can.
    gone: Option<String>,
    /// The models of the present version, by the name that is wanted; empty for none.
    models: BTreeMap<String, Arc<Model>>,
    /// The state by which work on the present version is given up.
    cancel: CancelState,
    /// The versions of the program's own file.
    own: Arc<Watched>,
    /// True once the page ends.
    over: bool,
}

impl State {
    /// Gives up what was found of the version before.
    fn renew(&mut self) {
        self.models.clear();
        self.cancel.cancel();
        self.cancel = CancelState::default();
    }
}

/// The text that a page shows at a time, with what it shows.
pub(super) struct Shown {
    /// The version of the text.
    pub version: u64,
    /// The text.
    pub text: String,
    /// The reason why the file can't be read; `None` if it can.
    pub gone: Option<String>,
    /// True if a change can be undone, and true if one can be made again.
    pub can: (bool, bool),
    /// The model of the text.
    pub model: Arc<Model>,
}

/// The files of the project without the program's own, with a record of those that were read.
struct Imports {
    project: Project,
    watched: Mutex<Arc<Watched>>,
}

impl Files for Imports {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        self.watched.lock().unwrap_or_else(PoisonError::into_inner).note(&self.project.root().join(path));
        self.project.read(path)
    }

    fn library(&self, path: &str) -> Option<Cow<'static, str>> {
        self.project.library(path)
    }

    fn list(&self, folder: &str) -> Vec<String> {
        self.project.list(folder)
    }
}

/// Returns the text of a file, and the reason why it is none.
fn read(file: &Path) -> Result<String, String> {
    let bytes = disk::read(file, FILE_BYTES_MAX).map_err(|e| e.0)?;
    String::from_utf8(bytes).map_err(|_| format!("the file `{}` is not UTF-8 text", file.display()))
}

impl Program {
    /// Returns the program of a file, which `project` was opened for.
    pub(super) fn new(file: &Path, project: Project) -> Program {
        let name = project.name.clone();
        let imports = Arc::new(Imports { project: project.unread(), watched: Mutex::default() });
        let own = Arc::new(Watched::default());
        own.note(file);
        let (text, gone) = read(file).map_or_else(|why| (String::new(), Some(why)), |text| (text, None));
        let document = Document::new(imports.clone(), &name, &text);
        let (models, cancel) = (BTreeMap::new(), CancelState::default());
        let state = State { document, gone, models, cancel, own, over: false };
        Program { file: file.to_owned(), imports, state: Mutex::new(state), changed: Condvar::new() }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Reads the file again if it has changed, and takes note of changes of what it imports.
    pub(super) fn look(&self) {
        let mut state = self.lock();
        let imported = self.imports.watched.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let (own, others) = (state.own.poll(), imported.poll());
        if !own && !others {
            return;
        }
        if others {
            *self.imports.watched.lock().unwrap_or_else(PoisonError::into_inner) = Arc::default();
        }
        if own {
            state.own = Arc::new(Watched::default());
            state.own.note(&self.file);
        }
        let before = (state.document.version(), state.gone.clone());
        match read(&self.file) {
            Ok(text) => {
                state.gone = None;
                state.document.replace(&text);
            }
            Err(why) => state.gone = Some(why),
        }
        let same = state.document.version() == before.0;
        if same && (others || state.gone != before.1) {
            state.document.touch();
        }
        if state.document.version() != before.0 {
            state.renew();
            self.changed.notify_all();
        }
    }

    /// Wakes whoever waits for a change, because the page ends.
    pub(super) fn wake(&self) {
        let mut state = self.lock();
        state.over = true;
        state.cancel.cancel();
        self.changed.notify_all();
    }

    /// Returns what a page shows once the text has another version than `since`; `None` if it has none in a time. `wanted`: the
    /// declaration that is shown.
    pub(super) fn shown(&self, since: u64, wanted: &str, patience: Duration) -> Option<Shown> {
        let unchanged = |state: &mut State| state.document.version() == since && !state.over;
        let waited = self.changed.wait_timeout_while(self.lock(), patience, unchanged);
        let (mut state, _) = waited.unwrap_or_else(PoisonError::into_inner);
        loop {
            if state.over || state.document.version() == since {
                return None;
            }
            if let Some(model) = state.models.get(wanted) {
                let (version, text) = (state.document.version(), state.document.text().to_owned());
                let (gone, can) = (state.gone.clone(), state.document.can());
                return Some(Shown { version, text, gone, can, model: model.clone() });
            }
            state = self.filled(state, wanted);
        }
    }

    /// Finds the model of a declaration, without the lock, and keeps it unless the text has changed meanwhile.
    fn filled<'s>(&'s self, state: MutexGuard<'s, State>, wanted: &str) -> MutexGuard<'s, State> {
        let (reading, cancel) = (state.document.reading(), state.cancel.clone());
        drop(state);
        let named = Some(wanted).filter(|wanted| !wanted.is_empty());
        let model = Arc::new(reading.model(named, &cancel));
        let mut state = self.lock();
        if state.document.version() == reading.version() && !cancel.is_cancelled() {
            if state.models.len() >= MODELS_MAX {
                state.models.clear();
            }
            state.models.insert(wanted.to_owned(), model);
        }
        state
    }

    /// Returns what the text shows before a change, with the robot of the change, and the text of that version.
    ///
    /// # Errors
    /// A [`Refusal`] where the text has another version, or the file can't be read.
    fn before(&self, version: u64, robot: &str) -> Result<(Document, Arc<Model>, CancelState), Refusal> {
        let mut state = self.lock();
        loop {
            if let Some(why) = &state.gone {
                return Err(Refusal::Refused(why.clone()));
            }
            if state.over || state.document.version() != version {
                return Err(Refusal::Outdated);
            }
            if let Some(model) = state.models.get(robot) {
                return Ok((state.document.reading(), model.clone(), state.cancel.clone()));
            }
            state = self.filled(state, robot);
        }
    }

    /// Returns what the text would show after a change; nothing is written.
    ///
    /// # Errors
    /// A [`Refusal`] as for [`Document::edited`].
    pub(super) fn preview(&self, version: u64, edit: &Edit) -> Result<Model, Refusal> {
        let (document, model, cancel) = self.before(version, edit.robot())?;
        document.edited(version, edit, &model, &cancel).map(|(_, model)| model)
    }

    /// Makes a change, and writes the file. Returns the new version.
    ///
    /// # Errors
    /// A [`Refusal`] as for [`Document::edited`], or where the file has changed since it was read or can't be written; it then stays
    /// as it is.
    pub(super) fn edit(&self, version: u64, edit: &Edit) -> Result<u64, Refusal> {
        let (document, model, cancel) = self.before(version, edit.robot())?;
        let (text, model) = document.edited(version, edit, &model, &cancel)?;
        let mut state = self.lock();
        self.write(&state, version, &text)?;
        state.document.accept(text);
        state.renew();
        state.models.insert(edit.robot().to_owned(), Arc::new(model));
        self.changed.notify_all();
        Ok(state.document.version())
    }

    /// Undoes the last change, or (`forth`) makes the one that was undone last again, and writes the file. Returns the new version.
    ///
    /// # Errors
    /// A [`Refusal`] as for [`Document::moved`], or where the file has changed since it was read or can't be written.
    pub(super) fn step(&self, version: u64, forth: bool) -> Result<u64, Refusal> {
        let mut state = self.lock();
        let text = state.document.moved(version, forth)?;
        self.write(&state, version, &text)?;
        state.document.accept_move(text, forth);
        state.renew();
        self.changed.notify_all();
        Ok(state.document.version())
    }

    /// Writes a text into the file, whole or not at all, unless another one stands there than the one that it was made of.
    fn write(&self, state: &State, version: u64, text: &str) -> Result<(), Refusal> {
        if state.over || state.document.version() != version {
            return Err(Refusal::Outdated);
        }
        match read(&self.file) {
            Err(why) => return Err(Refusal::Refused(why)),
            Ok(there) if there != state.document.text() => return Err(Refusal::Outdated),
            Ok(_) => {}
        }
        output::replace(&self.file, text.as_bytes()).map_err(|e| {
            let (file, why) = (self.file.display(), disk::system_words(&e));
            Refusal::Refused(format!("the file `{file}` can't be written: {why}"))
        })
    }
}
