//! Identities that stay free behind the declarations of a session's files.

use super::checker::{Checker, DefInfo, DefItem};
use super::typed::DefKind;
use crate::source::{FileId, Span, Symbol};

/// Places behind the declarations of a session's file, and what the number of all is a multiple of.
const GAPS_MIN: usize = 16;
const GAPS_STEP: usize = 64;

impl Checker<'_> {
    /// A file of a session may have more declarations when it is read again, or fewer: those behind it keep
    /// their identities.
    pub(super) fn leave_gaps(&mut self, file: usize, id: FileId) {
        let spare = self.defs.len() + GAPS_MIN;
        let span = Span::new(id, 0, 0);
        self.defs.resize_with(spare.next_multiple_of(GAPS_STEP), || DefInfo {
            name: Symbol::new("_"),
            span,
            whole: span,
            file,
            doc: None,
            item: DefItem::Gap,
            signature: None,
            members: None,
            typed: Some(DefKind::Error),
            inferred: None,
            busy: false,
        });
    }
}
