//! The members of a type, with their own types, for completion after a dot.

use crate::check::summary::{param_text, params_of, word};
use crate::check::typed::{DefId, DefKind, Member, MemberKind, NativeDef, Param, RecordDef};
use crate::check::{Checked, Program, Type};
use crate::source::Symbol;

/// A candidate of completion: a name with a short description.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Named {
    /// The name as completion inserts it.
    pub name: String,
    /// The description of the name: a type or a kind.
    pub about: String,
}

impl Named {
    /// Returns a name with a description.
    pub(crate) fn new(name: impl Into<String>, about: impl Into<String>) -> Named {
        Named { name: name.into(), about: about.into() }
    }
}

/// Returns the candidates after `value.` for a value of this type, sorted by name; empty for a type without
/// members.
pub(super) fn members(checked: &Checked, ty: &Type) -> Vec<Named> {
    let program = &checked.program;
    match ty {
        Type::Instance(id) => of_instance(program, *id),
        Type::Record(id) => of_record(program, *id),
        // A behaviour has the members of its plan.
        Type::Behavior => prelude(checked, "Plan").map_or_else(Vec::new, |plan| of_record(program, plan)),
        Type::Vec3(of) => ["x", "y", "z"].map(|axis| Named::new(axis, program.type_name(of))).to_vec(),
        Type::Range(of) => ["from", "to"].map(|end| Named::new(end, program.type_name(of))).to_vec(),
        Type::Pose => vec![Named::new("position", "Vec3<Length>")],
        Type::Port => vec![Named::new("joint", "the joint of its connection")],
        _ => Vec::new(),
    }
}

/// Returns a record of the library by its name; `None` if there is none.
fn prelude(checked: &Checked, name: &str) -> Option<DefId> {
    let record = |id: &usize| matches!(checked.program.defs[*id].kind, DefKind::Record(_));
    let found = (0..checked.program.defs.len()).filter(record).find(|id| {
        let def = &checked.program.defs[*id];
        def.name == name && checked.sources.file(def.file).library
    });
    found.and_then(|index| u32::try_from(index).ok()).map(DefId)
}

/// Returns the members of an instance, sorted by name.
fn of_instance(program: &Program, id: DefId) -> Vec<Named> {
    let mut found: Vec<Named> = Vec::new();
    let kind = &program.def(id).kind;
    let listed: &[Member] = match kind {
        DefKind::Module(module) => {
            let joints = module.joints.iter().map(|j| {
                let position = program.type_name(&Type::Quantity(j.dimension));
                Named::new(j.name.as_str(), format!("Joint<{position}>"))
            });
            found.extend(joints);
            let ports = module.ports.iter();
            found.extend(ports.map(|p| Named::new(p.name.as_str(), if p.array { "ports" } else { "Port" })));
            let aliases = module.joint_aliases.iter().map(|(name, _)| (*name, "a joint"));
            let aliases = aliases.chain(module.port_aliases.iter().map(|(name, _)| (*name, "a port")));
            found.extend(aliases.map(|(name, what)| Named::new(name.as_str(), what)));
            &module.members
        }
        DefKind::Config(config) => {
            let behaviors = config.behaviors.iter();
            found.extend(
                behaviors
                    .map(|b| Named::new(b.name.as_str(), params_text(program, &b.params, &[], "Behavior"))),
            );
            &config.members
        }
        DefKind::Facts(facts) => &facts.members,
        DefKind::Lattice(lattice) => &lattice.members,
        DefKind::Truss(truss) => &truss.members,
        _ => &[],
    };
    let plain = listed.iter().filter(|m| !matches!(m.kind, MemberKind::Behavior(_)));
    found.extend(plain.map(|m| Named::new(m.name.as_str(), program.type_name(&m.ty))));
    sorted(found)
}

/// Returns the fields and methods of a record, inherited ones included, sorted by name.
fn of_record(program: &Program, id: DefId) -> Vec<Named> {
    let mut found = Vec::new();
    let mut line = Some(id);
    // A record and those that it extends.
    while let Some(DefKind::Record(record)) = line.map(|id| &program.def(id).kind) {
        found.extend(record.fields.iter().map(|f| Named::new(f.name.as_str(), program.type_name(&f.ty))));
        found.extend(methods(program, record));
        line = record.is;
    }
    sorted(found)
}

/// Returns the methods of a record.
fn methods(program: &Program, record: &RecordDef) -> Vec<Named> {
    let method = |id: &DefId| match &program.def(*id).kind {
        DefKind::Native(native) => {
            let own = native.params.get(1..).unwrap_or_default();
            let about = native_text(program, native, own);
            Some(Named::new(program.def(*id).name.as_str(), about))
        }
        _ => None,
    };
    record.methods.iter().filter_map(method).collect()
}

/// Returns candidates by name, a joint before the port of its name.
fn sorted(mut found: Vec<Named>) -> Vec<Named> {
    found.sort_by(|a, b| a.name.cmp(&b.name));
    found.dedup_by(|b, a| a.name == b.name);
    found
}

/// Returns parameters and result as text: `(x: Length, n: Int) -> Angle`.
fn params_text(program: &Program, params: &[Param], type_params: &[Symbol], result: &str) -> String {
    let params: Vec<String> = params.iter().map(|p| param_text(program, type_params, p)).collect();
    format!("({}) -> {result}", params.join(", "))
}

/// Returns some of the parameters of a built-in, and its result, in words of a signature.
fn native_text(program: &Program, native: &NativeDef, params: &[Param]) -> String {
    let names = &native.type_params;
    params_text(program, params, names, &program.type_name_with(&native.result, names))
}

/// Returns the parameters of the behaviour or method `name` of a type, in order, without its object; empty if there is
/// none of this name.
pub(super) fn params_of_member(checked: &Checked, ty: &Type, name: Symbol) -> Vec<Param> {
    let program = &checked.program;
    let mut line = match ty {
        Type::Instance(id) => {
            let DefKind::Config(config) = &program.def(*id).kind else { return Vec::new() };
            let behavior = config.behaviors.iter().find(|b| b.name == name);
            return behavior.map_or_else(Vec::new, |b| b.params.clone());
        }
        Type::Record(id) => Some(*id),
        Type::Behavior => prelude(checked, "Plan"),
        _ => None,
    };
    while let Some(DefKind::Record(record)) = line.map(|id| &program.def(id).kind) {
        let method = record.methods.iter().find(|id| program.def(**id).name == name);
        if let Some(method) = method {
            return params_of(program, *method).get(1..).unwrap_or_default().to_vec();
        }
        line = record.is;
    }
    Vec::new()
}

/// Returns a short description of a declaration: the type of a `let` or function, else its keyword.
pub(super) fn about(program: &Program, id: DefId) -> String {
    match &program.def(id).kind {
        DefKind::Let(binding) => program.type_name(&binding.ty),
        DefKind::Fn(f) => params_text(program, &f.params, &[], &program.type_name(&f.result)),
        DefKind::Native(f) => native_text(program, f, &f.params),
        DefKind::Record(_) => "a record".into(),
        kind => word(kind).into(),
    }
}
