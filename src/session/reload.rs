//! Invalidation of values when files are read again.

use super::dependencies::Dependencies;
use crate::check::typed::{Def, DefId, DefKind};
use crate::check::{Checked, Type};
use std::collections::BTreeSet;

/// Returns the declarations whose values must be computed again after the files were read anew, sorted by [`DefId`];
/// `before` and `after`: the programs before and after. `None` if no identity is preserved, so that no value can be
/// kept.
///
/// A declaration that moved within its file is computed again, too, unless it is plain data: values of robots and plans
/// record their positions in the source.
pub(super) fn stale(before: &Checked, after: &Checked) -> Option<Vec<DefId>> {
    let names = |checked: &Checked| -> Vec<_> {
        checked.sources.files().map(|(_, file)| file.name.to_string()).collect()
    };
    if names(before) != names(after) || before.program.defs.len() != after.program.defs.len() {
        return None;
    }
    let mut changed = Vec::new();
    for (index, (old, new)) in before.program.defs.iter().zip(&after.program.defs).enumerate() {
        let text = |checked: &Checked, def: &Def| checked.sources.text(def.whole).to_owned();
        let same = old.file == new.file
            && old.name == new.name
            && text(before, old) == text(after, new)
            && (old.whole == new.whole || is_plain(new));
        if !same {
            changed.push(DefId(index as u32));
        }
    }
    let mut stale: BTreeSet<DefId> = changed.iter().copied().collect();
    for checked in [before, after] {
        stale.extend(Dependencies::of(checked).users_of(&changed));
    }
    Some(stale.into_iter().collect())
}

/// Returns true if the value of a declaration is plain data, without positions in the source.
fn is_plain(def: &Def) -> bool {
    fn plain(ty: &Type) -> bool {
        match ty {
            Type::Quantity(_) | Type::Int | Type::Bool | Type::Text | Type::Pose => true,
            Type::Cells | Type::Mesh | Type::Cloud | Type::Terrain => true,
            Type::List(of) | Type::Vec3(of) | Type::Range(of) | Type::Optional(of) => plain(of),
            _ => false,
        }
    }
    match &def.kind {
        DefKind::Let(binding) => plain(&binding.ty),
        // A vacant definition.
        DefKind::Error => true,
        _ => false,
    }
}
