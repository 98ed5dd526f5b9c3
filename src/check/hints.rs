//! Hints on how to mend a mismatch: what was probably meant, in the words of the program.

use super::checker::{Checker, DefItem, MemberInfoKind};
use super::describe::dimension_words;
use super::expr::alternatives;
use super::family::Family;
use super::typed::{BinaryOp, DefId, Expr, ExprKind};
use super::types::Type;
use crate::source::{Symbol, library};
use crate::syntax::ast;
use crate::units::{self, Dimension};

/// The most names that a hint lists.
const LISTED_MAX: usize = 12;

impl Checker<'_> {
    /// Returns a hint with the `use` that imports a name that is unknown in `file` (an index into the loaded files) and
    /// that another file or the library declares; `None` if none does.
    pub(super) fn import_hint(&self, file: usize, name: Symbol) -> Option<String> {
        match library::declares(name.as_str()) {
            Some(home) => Some(format!("the library has it: `use std.{home}.{name}`")),
            None => {
                let path = self.declared_elsewhere(file, name)?;
                Some(format!("another file declares it: `use \"{path}\".{{{name}}}`"))
            }
        }
    }

    /// Returns a hint on how to mend the expression `got`, which is not of the type `want`; `None` if none is known.
    pub(super) fn type_hint(&mut self, got: &Expr, want: &Type) -> Option<String> {
        let written = self.quoted(got.span).unwrap_or("it");
        if let Some(hint) = self.port_or_joint(got, want).or_else(|| self.vector_hint(got, want)) {
            return Some(hint);
        }
        match (&got.ty, want) {
            (Type::Fn(f), _) if self.fits(&f.result, want) => Some(format!("call it: `{written}()`")),
            (Type::Port, Type::Joint(_)) => Some(format!("the joint of its connection is `{written}.joint`")),
            (Type::Optional(_), _) => {
                Some(format!("say what stands in when it is missing: `{written} else ...`"))
            }
            (Type::Quantity(_), Type::Int)
                if matches!(&got.kind, ExprKind::Binary { op: BinaryOp::Div, .. }) =>
            {
                Some("`/` gives any number; the whole quotient is `div(a, b)`".into())
            }
            (Type::Quantity(_), Type::Int) => {
                Some(format!("`floor({written})` and `round({written})` are whole; so is `div(a, b)`"))
            }
            (Type::Pose, Type::Signal(_)) => {
                Some("a signal is asked for where it is wanted: `series(pose(port))`".into())
            }
            (Type::Signal(of), Type::Behavior)
                if [Dimension::TORQUE, Dimension::FORCE].iter().any(|load| of.dimension() == Some(*load)) =>
            {
                Some(format!(
                    "there is no action for a torque or a force: a joint takes positions (`move`) and speeds (`spin`), and \
                     `{written}` is what its motor supplies, in a condition or a series"
                ))
            }
            (Type::Instance(id), Type::AnyOf(Family::Config)) => {
                let word = self.family(*id)?.word();
                Some(format!(
                    "a `Config` is a configuration or a module; `{}` is a {word}",
                    self.def(*id).name
                ))
            }
            (Type::Condition, Type::Bool) => {
                Some("a condition is watched while the robot moves; it has no value yet".into())
            }
            _ => None,
        }
    }

    /// Returns the hint that lists the ports, or joints, of the robot, where the other kind is wanted; otherwise
    /// `None`.
    fn port_or_joint(&mut self, got: &Expr, want: &Type) -> Option<String> {
        let wanted = alternatives(want);
        let wants_port = wanted.iter().any(|ty| **ty == Type::Port);
        let wants_joint = wanted.iter().any(|ty| matches!(ty, Type::Joint(_)));
        let owner = match (&got.kind, &got.ty) {
            (ExprKind::Joint { object, .. }, _) if wants_port => &object.ty,
            (ExprKind::Port { object, .. }, _) if wants_joint => &object.ty,
            (_, owner @ Type::Instance(_)) if wants_port || wants_joint => owner,
            _ => return None,
        };
        let Type::Instance(id) = *owner else { return None };
        let (names, what) = match wants_port {
            true => (self.port_names(id), "port"),
            false => (self.joint_names(id), "joint"),
        };
        let owner = self.def(id).name;
        let listed = match names.as_slice() {
            [] => return Some(format!("`{owner}` has no {what}s of its own")),
            [one] => return Some(format!("the {what} of `{owner}` is `{one}`")),
            names if names.len() > LISTED_MAX => format!("{}, ...", names[..LISTED_MAX].join("`, `")),
            [first @ .., last] => format!("{}` and `{last}", first.join("`, `")),
        };
        Some(format!("the {what}s of `{owner}` are `{listed}`"))
    }

    /// Returns the names of the ports of a module or configuration; `edge[i]` for an array.
    fn port_names(&mut self, id: DefId) -> Vec<String> {
        let members = self.members(id);
        let named = |name: Symbol, array: bool| if array { format!("{name}[i]") } else { name.to_string() };
        if self.family(id) == Some(Family::Module) {
            return members.ports.iter().map(|port| named(port.name, port.array)).collect();
        }
        let ports = members.list.iter().filter_map(|member| match member.kind {
            MemberInfoKind::Port(_, array) => Some(named(member.name, array)),
            _ => None,
        });
        ports.collect()
    }

    /// Returns the names of the joints of a module.
    fn joint_names(&mut self, id: DefId) -> Vec<String> {
        self.members(id).joints.iter().map(|joint| joint.name.to_string()).collect()
    }

    /// Returns the hint for a list where a vector, or a list of vectors, is wanted: three coordinates make a
    /// vector where one is expected, and a declaration says that by its type.
    fn vector_hint(&self, got: &Expr, want: &Type) -> Option<String> {
        let wanted = alternatives(want).into_iter().find(|wanted| is_list_for_vector(&got.ty, wanted))?;
        let uneven = match &got.kind {
            ExprKind::List(items) => uneven(&got.ty, items.len(), items.iter().map(list_length)),
            ExprKind::Global(id) => match self.def(*id).item {
                DefItem::Let(ast::Let { value, .. }) => match &value.kind {
                    ast::ExprKind::List(items) => {
                        uneven(&got.ty, items.len(), items.iter().map(written_length))
                    }
                    _ => None,
                },
                _ => None,
            },
            _ => None,
        };
        if let Some(length) = uneven {
            let are = if length == 1 { "is" } else { "are" };
            return Some(format!("a vector has three coordinates, `[x, y, z]`; here {are} {length}"));
        }
        let ty = self.name(wanted);
        let name = match &got.kind {
            ExprKind::Global(_) | ExprKind::Local(_) => self.quoted(got.span).unwrap_or("name"),
            ExprKind::List(_) => return None,
            _ => return Some("three coordinates make a vector where one is expected: `[x, y, z]`".into()),
        };
        Some(format!("say so where it is declared: `let {name}: {ty} = ...`"))
    }
}

/// The built-ins for joints that turn, each with what does the same for joints that slide.
const BY_JOINT: &[(&str, &str)] = &[("angle", "displacement"), ("torque", "force"), ("spin", "move")];

/// Returns a hint for a built-in `function` called with a joint of the wrong kind: the built-in that does the same for
/// it, such as `displacement` of a sliding joint for `angle` of a turning one. `None` if there is no such built-in, or
/// the types are not joints of the two kinds.
pub(super) fn for_other_joints(function: Symbol, got: &Type, want: &Type) -> Option<String> {
    let (Type::Joint(got), Type::Joint(want)) = (got, want) else { return None };
    let slides = |joint: &Type| joint.dimension() == Some(Dimension::LENGTH);
    let function = function.as_str();
    let found = BY_JOINT.iter().find(|(turns, slides)| *turns == function || *slides == function)?;
    match (slides(got), slides(want)) {
        (true, false) => Some(format!("this joint slides: `{}` is for such joints", found.1)),
        (false, true) => Some(format!("this joint turns: `{}` is for such joints", found.0)),
        _ => None,
    }
}

/// Returns true if one type is a list of quantities, or of such lists, where the other is a vector of them.
fn is_list_for_vector(got: &Type, want: &Type) -> bool {
    match (got, want) {
        (Type::List(got), Type::Vec3(want)) => match (got.dimension(), want.dimension()) {
            (Some(got), Some(want)) => got.fits(want),
            _ => false,
        },
        (Type::List(got), Type::List(want)) => is_list_for_vector(got, want),
        _ => false,
    }
}

/// Returns the first number of coordinates other than three: of the list itself if its elements are quantities,
/// else among those of its elements that are known.
fn uneven(ty: &Type, length: usize, mut inner: impl Iterator<Item = Option<usize>>) -> Option<usize> {
    match ty {
        Type::List(element) if element.dimension().is_some() => (length != 3).then_some(length),
        _ => inner.find_map(|length| length.filter(|length| *length != 3)),
    }
}

fn list_length(e: &Expr) -> Option<usize> {
    if let ExprKind::List(items) = &e.kind { Some(items.len()) } else { None }
}

fn written_length(e: &ast::Expr) -> Option<usize> {
    if let ast::ExprKind::List(items) = &e.kind { Some(items.len()) } else { None }
}

/// Returns a likely correction of a quantity of the dimension `have` where `need` is wanted, as a hint; `written` is
/// its source text. `None` if none is known, or there is no text.
pub(super) fn dimension_hint(written: Option<&str>, have: Dimension, need: Dimension) -> Option<String> {
    let written = written?;
    let literal = written.trim_start_matches('-').starts_with(|c: char| c.is_ascii_digit())
        && !written.contains(char::is_whitespace);
    if have.over(Dimension::TIME) == Some(need) {
        return Some(if literal {
            format!("per second? `{written}/s`")
        } else {
            format!("per second? `{written} / 1s`")
        });
    }
    if have == Dimension::NUMBER && need == Dimension::ANGLE {
        return Some(match literal {
            true => angle_hint(written),
            false => format!("in radians it is `{written} * 1rad`, in degrees `{written} * 1deg`"),
        });
    }
    let unit = units::usual_unit(need);
    if have == Dimension::NUMBER && literal {
        return (!unit.is_empty()).then(|| format!("with a unit? `{written}{unit}`"));
    }
    if need == Dimension::NUMBER && have == Dimension::ANGLE {
        return Some(format!("angles are no plain numbers; divide by a unit to get one: `{written} / 1rad`"));
    }
    (literal && !unit.is_empty()).then(|| format!("{} has a unit such as `{unit}`", dimension_words(need)))
}

/// Returns the hint for a plain number, whose source text is `written`, where an angle is wanted. A fraction up to a
/// whole turn is most likely in radians, a larger number in degrees; a small whole number may be either.
pub(super) fn angle_hint(written: &str) -> String {
    let digits: String = written.chars().filter(|c| !matches!(c, '-' | '_')).collect();
    let (whole, small) = match digits.parse::<f64>() {
        Ok(value) => (!digits.contains('.'), value <= std::f64::consts::TAU),
        Err(_) => (true, true),
    };
    match (whole, small) {
        (false, true) => format!("in radians? `{written}rad`"),
        (true, true) => format!("in radians it is `{written}rad`, in degrees `{written}deg`"),
        (_, false) => format!("in degrees? `{written}deg`"),
    }
}
