//! The manifest of a documentation site: which files `modl doc` wrote, and what its pictures were drawn from.
//!
//! It lies in the site. Its words are believed only as far as the disk bears it out: a picture is taken over if its
//! bytes and all files that it was drawn from are those of the manifest, and a file is removed only if its bytes are.

use super::disk::{self, FILE_BYTES_MAX};
use super::output::{self, Removed};
use crate::document::{Drawing, Site, Sources, digest};
use crate::interpret::WriteError;
use crate::source::Files;
use crate::source::files::join;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// The name of the manifest file in the folder of a documentation site.
pub(super) const NAME: &str = ".modl-doc.json";

/// The manifest of a documentation site: the files that `modl doc` wrote, with their digests.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Manifest {
    /// The version and the digest of the program that wrote it.
    modl: String,
    /// The digests of the files of the site, by name.
    files: BTreeMap<String, String>,
    /// The drawings, by program.
    drawings: BTreeMap<String, Drawn>,
}

/// A drawing, but for the bytes of its picture.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Drawn {
    facts: Vec<String>,
    /// The name of the picture in the site; `None` where nothing was drawn.
    picture: Option<String>,
    sources: Sources,
}

impl Manifest {
    /// Returns the manifest of a site that this program wrote; `modl` is as [`program`] says.
    pub(super) fn of(site: &Site, modl: &str) -> Manifest {
        let files = site.files.iter().map(|(name, bytes)| (name.clone(), digest(bytes))).collect();
        let drawn = |drawing: &Drawing| Drawn {
            facts: drawing.facts.clone(),
            picture: drawing.picture.as_ref().map(|(name, _)| name.clone()),
            sources: drawing.sources.clone(),
        };
        let drawings = site.drawings.iter().map(|(text, drawing)| (text.clone(), drawn(drawing))).collect();
        Manifest { modl: modl.to_owned(), files, drawings }
    }

    /// Returns the manifest of the site in a folder; `None` if there is none that `modl doc` can have written.
    pub(super) fn read(home: &Path) -> Option<Manifest> {
        let bytes = disk::read(&home.join(NAME), FILE_BYTES_MAX).ok()?;
        let manifest: Manifest = serde_json::from_slice(&bytes).ok()?;
        let inside = |name: &String| join("", name).as_ref() == Some(name);
        manifest.files.keys().all(inside).then_some(manifest)
    }

    /// Returns the manifest as the bytes of a JSON file.
    pub(super) fn text(&self) -> Vec<u8> {
        let mut text = serde_json::to_vec_pretty(self).expect("texts in maps are always JSON");
        text.push(b'\n');
        text
    }

    /// Returns the drawings that need not be made anew, by the text of their program: those that this version of `modl`
    /// made from files that are still the same, and whose pictures are still in `home`. Empty if another version made
    /// the site, or `modl` is `None`.
    pub(super) fn known(
        &self,
        home: &Path,
        files: &dyn Files,
        modl: Option<&str>,
    ) -> BTreeMap<String, Drawing> {
        if modl != Some(self.modl.as_str()) {
            return BTreeMap::new();
        }
        let picture = |name: &String| {
            let bytes = disk::read(&home.join(name), FILE_BYTES_MAX).ok()?;
            (self.files.get(name) == Some(&digest(&bytes))).then(|| (name.clone(), bytes))
        };
        let known = |drawn: &Drawn| {
            let picture = match &drawn.picture {
                Some(name) => Some(picture(name)?),
                None => None,
            };
            let (facts, sources) = (drawn.facts.clone(), drawn.sources.clone());
            sources.hold(files).then_some(Drawing { facts, picture, sources })
        };
        let drawings = self.drawings.iter();
        drawings.filter_map(|(text, drawn)| Some((text.clone(), known(drawn)?))).collect()
    }

    /// Removes the files of the site in `home` that `next` does not have. Returns (count, left): the number of those
    /// removed, and the names of those that were left because someone has changed them since.
    ///
    /// # Errors
    /// (name, reason) of the first file that can't be removed.
    pub(super) fn remove_all_but(
        &self,
        next: &Manifest,
        home: &Path,
    ) -> Result<(usize, Vec<String>), (String, WriteError)> {
        let (mut count, mut left) = (0, Vec::new());
        for (name, written) in self.files.iter().filter(|(name, _)| !next.files.contains_key(*name)) {
            match output::remove(home, name, |bytes| digest(bytes) == *written) {
                Ok(Removed::Yes) => count += 1,
                Ok(Removed::Left) => left.push(name.clone()),
                Ok(Removed::Absent) => {}
                Err(e) => return Err((name.clone(), e)),
            }
        }
        Ok((count, left))
    }
}

/// Returns the version and the SHA-256 digest of the running executable, which decide, with the sources, what a site
/// is; `None` if its file can't be read.
pub(super) fn program() -> Option<String> {
    let bytes = std::fs::read(std::env::current_exe().ok()?).ok()?;
    Some(format!("{} {}", env!("CARGO_PKG_VERSION"), digest(&bytes)))
}
