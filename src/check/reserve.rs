//! Reserved definitions: identities (`DefId`) left vacant after the declarations of a session's files.

use super::checker::{Checker, DefInfo, DefItem};
use super::typed::DefKind;
use crate::source::{FileId, Span, Symbol};

/// The least number of vacant definitions after a file of a session.
const RESERVED_MIN: usize = 16;
/// The total number of definitions after a file is a multiple of this.
const RESERVED_STEP: usize = 64;

impl Checker<'_> {
    /// Reserves vacant declarations, at least 16, after those of `file` (an index into the loaded files; `id` is its
    /// identity). A file of a session may have more or fewer declarations when it is read again; those of the files
    /// after it keep their identities.
    pub(super) fn reserve_definitions(&mut self, file: usize, id: FileId) {
        let spare = self.defs.len() + RESERVED_MIN;
        let span = Span::new(id, 0, 0);
        self.defs.resize_with(spare.next_multiple_of(RESERVED_STEP), || DefInfo {
            name: Symbol::new("_"),
            span,
            whole: span,
            file,
            doc: None,
            item: DefItem::Vacant,
            signature: None,
            members: None,
            typed: Some(DefKind::Error),
            inferred: None,
            busy: false,
        });
    }
}
