//! The types of plain paths, such as `robot.leg[0]`, in a program that is checked already: nothing is checked anew for them.

use super::dependencies::meant;
use crate::check::typed::{DefId, DefKind};
use crate::check::{Checked, Type};
use crate::source::Symbol;

/// Returns the type of a path of names and indices that begins with a `let` of the program, with an instance of a declaration,
/// `Chain3()`, or with a list of one, `[Chain3()]`. `None` for other expressions, and where a name on the path is not plain.
pub(super) fn type_of_path(checked: &Checked, path: &str) -> Option<Type> {
    let (mut ty, mut rest) = head(checked, path.trim())?;
    while !rest.is_empty() {
        if let Some(behind) = rest.strip_prefix('[') {
            let Type::List(of) = ty else { return None };
            // An index with brackets of its own is no plain one.
            let (index, behind) = behind.split_once(']')?;
            if index.contains(['[', '(']) {
                return None;
            }
            (ty, rest) = ((*of).clone(), behind);
        } else {
            let (name, behind) = word(rest.strip_prefix('.')?)?;
            (ty, rest) = (member(checked, &ty, name)?, behind);
        }
    }
    Some(ty)
}

/// Returns the type of the `let` of this name that the files of the project declare last, in any place.
pub(super) fn type_of_let(checked: &Checked, name: &str) -> Option<Type> {
    let own = |file| !checked.sources.file(file).library;
    let named = checked.lets.iter().filter(|(span, _)| own(span.file) && checked.sources.text(*span) == name);
    named.max_by_key(|(span, _)| (span.file, span.start)).map(|(_, ty)| ty.clone())
}

/// Returns the word with which a text begins, and the rest; `None` if it begins with none.
fn word(text: &str) -> Option<(&str, &str)> {
    let end = text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len());
    (end > 0 && !text.starts_with(|c: char| c.is_ascii_digit())).then(|| text.split_at(end))
}

/// Returns the type of the value with which a path begins, and the rest of the path.
fn head<'p>(checked: &Checked, path: &'p str) -> Option<(Type, &'p str)> {
    if let Some(listed) = path.strip_prefix('[') {
        let (ty, rest) = head(checked, listed)?;
        return Some((Type::List(ty.into()), rest.strip_prefix(']')?));
    }
    let (name, rest) = word(path)?;
    let id = *meant(checked).get(&Symbol::new(name))?;
    match &checked.program.def(id).kind {
        DefKind::Let(binding) => known(&binding.ty, rest),
        kind if kind.instantiable().is_some() => Some((Type::Instance(id), rest.strip_prefix("()")?)),
        _ => None,
    }
}

fn known<'p>(ty: &Type, rest: &'p str) -> Option<(Type, &'p str)> {
    (!ty.is_error()).then(|| (ty.clone(), rest))
}

/// Returns the type of a member of an instance, or of a field of a record; `None` for other types and members.
fn member(checked: &Checked, of: &Type, name: &str) -> Option<Type> {
    let program = &checked.program;
    let ty = match of {
        Type::Instance(id) => {
            let members = program.def(*id).kind.instantiable()?.members;
            members.iter().find(|member| member.name == name)?.ty.clone()
        }
        Type::Record(id) => {
            let mut line: Option<DefId> = Some(*id);
            loop {
                let DefKind::Record(record) = &program.def(line?).kind else { return None };
                if let Some(field) = record.fields.iter().find(|field| field.name == name) {
                    break field.ty.clone();
                }
                line = record.is;
            }
        }
        _ => return None,
    };
    (!ty.is_error()).then_some(ty)
}
