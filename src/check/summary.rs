//! Declarations as they are written, without their bodies, for documentation, hover and completion.

use super::typed::{BehaviorDef, Def, DefId, DefKind, Member, MemberKind, Param, Program, StudyAxis};
use super::{Checked, Type};
use crate::source::{Span, Symbol};
use std::sync::Arc;

/// A declaration inside a declaration, with its documentation.
#[derive(Clone, Debug)]
pub(crate) struct Inside {
    /// The group under which the member is listed.
    pub group: Group,
    /// The name that is declared.
    pub name: Symbol,
    /// The text of the declaration without the keyword: `bend: Joint<Angle>`, `walk(steps: Int = 4)`.
    pub head: String,
    /// The clauses that a behaviour states, each on one line: what it requires, and what it ensures. Empty for other members.
    pub contracts: Vec<String>,
    /// The text of the member's doc comment; `None` if there is none.
    pub doc: Option<Arc<str>>,
}

/// The groups of items that a declaration contains, in the order in which they are listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Group {
    /// A parameter; the signature shows it, too.
    Parameter,
    /// A joint of a module.
    Joint,
    /// A port, or an array of ports.
    Port,
    /// A part of a configuration, or a list of parts.
    Part,
    /// A `let` at the top of a body.
    Let,
    /// An obstacle of a scene, or an array of obstacles.
    Obstacle,
    /// A behaviour of a configuration.
    Behavior,
    /// A field of a record.
    Field,
    /// A method of a record.
    Method,
}

impl Group {
    /// Returns the singular noun for an item of the group: the keyword that declares it, or a plain word where there is
    /// none.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Group::Parameter => "parameter",
            Group::Joint => "joint",
            Group::Port => "port",
            Group::Part => "part",
            Group::Let => "let",
            Group::Obstacle => "obstacle",
            Group::Behavior => "behavior",
            Group::Field => "field",
            Group::Method => "method",
        }
    }
}

/// Returns the source form of a declaration without its body, such as `fn ramp(i: Int, n: Int = 4) -> Number`.
pub(crate) fn signature(checked: &Checked, id: DefId) -> String {
    let program = &checked.program;
    let def = program.def(id);
    let params = params_of(program, id);
    let names = type_params(&def.kind);
    let written = params.iter().map(|p| with_default(checked, names, p)).collect::<Vec<_>>().join(", ");
    let written = if params.is_empty() { String::new() } else { format!("({written})") };
    match &def.kind {
        DefKind::Let(binding) => format!("let {}: {}", def.name, program.type_name(&binding.ty)),
        DefKind::Fn(f) => called(def.name, &written, &program.type_name(&f.result)),
        DefKind::Native(f) => called(def.name, &written, &program.type_name_with(&f.result, names)),
        DefKind::Record(record) if record.build.is_some() => {
            let fields = params.iter().map(|p| with_default(checked, &[], p)).collect::<Vec<_>>().join(", ");
            if fields.is_empty() {
                format!("record {} {{}}", def.name)
            } else {
                format!("record {} {{ {fields} }}", def.name)
            }
        }
        DefKind::Study(study) => {
            let axis =
                |axis: &StudyAxis| format!("{} in {}", axis.name, checked.sources.text(axis.domain.span));
            let axes = study.axes.iter().map(axis).collect::<Vec<_>>().join(", ");
            let each: String = study.each.iter().map(|one| format!(" each {}", axis(one))).collect();
            let row = study.row.map_or_else(String::new, |row| format!(" = {}", program.def(row).name));
            let span = study.sampler_span;
            format!("study {}({axes}) by {}{each}{row}", def.name, checked.sources.text(span))
        }
        DefKind::Error => def.name.to_string(),
        _ => format!("{} {}{written}", word(&def.kind), def.name),
    }
}

/// Returns the keyword of a declaration, such as `module` or `fn`; empty for an error.
pub(crate) fn word(kind: &DefKind) -> &'static str {
    match kind {
        DefKind::Let(_) => "let",
        DefKind::Fn(_) | DefKind::Native(_) => "fn",
        DefKind::Record(record) if record.build.is_some() => "record",
        DefKind::Record(_) => "type",
        DefKind::Connector(_) => "connector",
        DefKind::Study(_) => "study",
        kind => kind.instantiable().map_or("", |instantiable| instantiable.word),
    }
}

/// Returns the signature of a function.
fn called(name: Symbol, params: &str, result: &str) -> String {
    let params = if params.is_empty() { "()" } else { params };
    format!("fn {name}{params} -> {result}")
}

/// Returns a parameter with its default: `n: Int = 4`.
pub(crate) fn with_default(checked: &Checked, type_params: &[Symbol], param: &Param) -> String {
    let default = param.default.as_ref().map(|value| checked.sources.text(value.span));
    let default = default.map(|text| format!(" = {text}")).unwrap_or_default();
    format!("{}{default}", param_text(&checked.program, type_params, param))
}

/// Returns a parameter as it is written, without its default, such as `n: Int`. `type_params` are the names of the type
/// parameters of its function, in order.
pub(crate) fn param_text(program: &Program, type_params: &[Symbol], param: &Param) -> String {
    let dots = if param.variadic { "..." } else { "" };
    format!("{}: {}{dots}", param.name, program.type_name_with(&param.ty, type_params))
}

/// Returns the names of the type parameters of a built-in, in order; empty for other declarations, whose types name
/// them.
pub(crate) fn type_params(kind: &DefKind) -> &[Symbol] {
    match kind {
        DefKind::Native(native) => &native.type_params,
        _ => &[],
    }
}

/// Returns the parameters of a declaration that can be called, in order; empty for others.
pub(crate) fn params_of(program: &Program, id: DefId) -> &[Param] {
    match &program.def(id).kind {
        DefKind::Fn(function) => &function.params,
        DefKind::Native(native) => &native.params,
        DefKind::Record(record) => record.build.as_ref().map_or(&[], |build| &build.params),
        kind => kind.instantiable().map_or(&[], |instantiable| instantiable.params),
    }
}

/// Returns the parameters, joints, ports, parts, values, behaviours, fields and methods of a declaration: group
/// by group, and in a group in the order of the text. Private `let`s and ports of a configuration are left out.
pub(crate) fn inside(checked: &Checked, def: &Def) -> Vec<Inside> {
    let program = &checked.program;
    let entry = |group, name: Symbol, head: String, doc: &Option<Arc<str>>| Inside {
        group,
        name,
        head,
        contracts: Vec::new(),
        doc: doc.clone(),
    };
    let names = type_params(&def.kind);
    let params = |params: &[Param], type_params: &[Symbol]| {
        params.iter().map(|p| with_default(checked, type_params, p)).collect::<Vec<_>>().join(", ")
    };
    let of_params = |params: &[Param]| -> Vec<Inside> {
        let named =
            params.iter().map(|p| entry(Group::Parameter, p.name, with_default(checked, names, p), &None));
        named.collect()
    };
    // The `let`s and ports of a body.
    let of_members = |members: &[Member]| -> Vec<Inside> {
        let named = members.iter().filter_map(|m| match m.kind {
            _ if m.name.as_str().starts_with('_') => None,
            MemberKind::Let(_) => {
                Some(entry(Group::Let, m.name, format!("{}: {}", m.name, program.type_name(&m.ty)), &m.doc))
            }
            MemberKind::Port { ref count, .. } => {
                let many = count.as_ref().map_or("", |_| "[]");
                Some(entry(Group::Port, m.name, format!("{}{many}", m.name), &m.doc))
            }
            MemberKind::Obstacle => {
                let many = if matches!(m.ty, Type::List(_)) { "[]" } else { "" };
                Some(entry(Group::Obstacle, m.name, format!("{}{many}", m.name), &m.doc))
            }
            _ => None,
        });
        named.collect()
    };
    match &def.kind {
        DefKind::Module(module) => {
            let joints = module.joints.iter().map(|j| {
                let position = program.type_name(&Type::Quantity(j.dimension));
                entry(Group::Joint, j.name, format!("{}: Joint<{position}>", j.name), &j.doc)
            });
            let ports = module.ports.iter().map(|p| {
                entry(Group::Port, p.name, format!("{}{}", p.name, if p.array { "[]" } else { "" }), &p.doc)
            });
            let before = of_params(&module.params).into_iter().chain(joints).chain(ports);
            before.chain(of_members(&module.members)).collect()
        }
        DefKind::Config(config) => {
            let parts = config.parts.iter().map(|part| {
                let many = part.count.as_ref().map_or_else(String::new, |_| "[]".to_owned());
                let head = format!("{}{many}: {}", part.name, checked.sources.text(part.ty_span));
                let member = config.members.iter().find(|member| member.name == part.name);
                entry(Group::Part, part.name, head, &member.and_then(|member| member.doc.clone()))
            });
            let behaviors = config.behaviors.iter().map(|b| {
                let head = format!("{}({})", b.name, params(&b.params, &[]));
                let inside = entry(Group::Behavior, b.name, head, &b.doc);
                Inside { contracts: contracts(checked, b), ..inside }
            });
            let before = of_params(&config.params).into_iter().chain(parts);
            before.chain(of_members(&config.members)).chain(behaviors).collect()
        }
        DefKind::Record(record) => {
            let fields = record.fields.iter().map(|f| {
                let built = record.build.iter().flat_map(|build| &build.params).find(|p| p.name == f.name);
                let head = built.map_or_else(
                    || format!("{}: {}", f.name, program.type_name(&f.ty)),
                    |param| with_default(checked, &[], param),
                );
                entry(Group::Field, f.name, head, &f.doc)
            });
            let methods = record.methods.iter().map(|id| {
                let method = program.def(*id);
                let own = params_of(program, *id).get(1..).unwrap_or_default();
                let result = match &method.kind {
                    DefKind::Native(native) => program.type_name_with(&native.result, &native.type_params),
                    _ => String::new(),
                };
                let head = format!("{}({}) -> {result}", method.name, params(own, type_params(&method.kind)));
                entry(Group::Method, method.name, head, &method.doc)
            });
            fields.chain(methods).collect()
        }
        DefKind::Fn(f) => of_params(&f.params),
        DefKind::Native(f) => of_params(&f.params),
        DefKind::Facts(d) => of_params(&d.params),
        DefKind::Lattice(d) => of_params(&d.params).into_iter().chain(of_members(&d.members)).collect(),
        DefKind::Truss(d) => of_params(&d.params).into_iter().chain(of_members(&d.members)).collect(),
        _ => Vec::new(),
    }
}

/// Returns the requirements and contracts of a behaviour as they are written, each on one line.
fn contracts(checked: &Checked, behavior: &BehaviorDef) -> Vec<String> {
    let clause = |(span, _): &(Span, bool)| {
        let text = checked.sources.text(*span).split_whitespace().collect::<Vec<_>>().join(" ");
        // `expect` states nothing that a caller can rely on.
        (!text.starts_with("expect")).then_some(text)
    };
    behavior.contracts.iter().filter_map(clause).collect()
}
