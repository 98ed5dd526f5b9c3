//! The state of checking: declarations with what is known of them, and the diagnostics so far.
//!
//! Declarations refer to each other in any order, so each fact about one is computed when first needed: its
//! signature (from its text), its members, and its typed body. Only a typed body can need another body,
//! through inferred types; a cycle of those is an error.

use super::family::Family;
use super::load::{ImportTarget, Loaded};
use super::typed::{self, DefId, DefKind, MemberId, Program};
use super::types::Type;
use crate::source::suggest::suggest;
use crate::source::{Diagnostic, FileId, Sources, Span, Symbol, code};
use crate::syntax::ast;
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

/// The entity that a name at the top of a file stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Entity {
    /// A declaration.
    Def(DefId),
    /// `use std.gaits`: a file whose items are reached by `gaits.name`.
    File(usize),
    /// An erroneous name that has been reported.
    Error,
}

/// The syntax tree of a declaration, by its keyword.
#[derive(Clone, Copy)]
pub(super) enum DefItem<'a> {
    /// A constant: `let`.
    Let(&'a ast::Let),
    /// A function: `fn`.
    Fn(&'a ast::Fn),
    /// A built-in function: `extern fn`.
    Native(&'a ast::ExternFn),
    /// A method: an `extern fn` in an `extern type`, the record whose identity is the second.
    Method(&'a ast::ExternFn, DefId),
    /// A record: `record`.
    Record(&'a ast::Record),
    /// A record type of the standard library: `extern type`.
    ExternType(&'a ast::ExternType),
    /// A connector: `connector`.
    Connector(&'a ast::Connector),
    /// A module: `module`.
    Module(&'a ast::Module),
    /// A cell of a lattice or a strut of a truss: `cell`, `strut`.
    Facts(&'a ast::Facts),
    /// A configuration or a scene: `config`, `scene`.
    Config(&'a ast::Config),
    /// A lattice: `lattice`.
    Lattice(&'a ast::Lattice),
    /// A truss: `truss`.
    Truss(&'a ast::Truss),
    /// A study of designs: `study`.
    Study(&'a ast::Study),
    /// A vacant definition, reserved for a later declaration.
    Vacant,
}

/// The state of checking of one declaration.
pub(super) struct DefInfo<'a> {
    /// The name that is declared.
    pub name: Symbol,
    /// The span of the name in the declaration.
    pub span: Span,
    /// The span of the whole declaration, from its keyword to its end.
    pub whole: Span,
    /// The file of the declaration, as an index into [`Loaded::files`](super::load::Loaded::files).
    pub file: usize,
    /// The text of the doc comment; `None` if there is none.
    pub doc: Option<Arc<str>>,
    /// The syntax tree of the declaration.
    pub item: DefItem<'a>,
    /// The signature of the declaration; `None` until it is computed.
    pub signature: Option<Rc<Signature>>,
    /// The members of the declaration; `None` until they are computed.
    pub members: Option<Rc<Members<'a>>>,
    /// The typed body of the declaration; `None` until it is checked.
    pub typed: Option<DefKind>,
    /// The type of a `let`, or the inferred result of a `fn`; `None` until it is computed.
    pub inferred: Option<Type>,
    /// True while the body is being checked; needing it then is a cycle.
    pub busy: bool,
}

/// The signature of a declaration that can be called.
#[derive(Clone, Debug, Default)]
pub(super) struct Signature {
    /// The parameters, in order; of a method the object comes first.
    pub params: Vec<ParamInfo>,
    /// The declared result, [`Type::Nothing`] for an `extern fn` without one; `None` if it is inferred from the
    /// body.
    pub result: Option<Type>,
    /// The type parameters, in order; empty for what is not a function.
    pub type_params: Vec<TypeParam>,
    /// True if the parameters are the fields of a record, which are given by name.
    pub fields: bool,
}

/// A type parameter of a function.
#[derive(Clone, Copy, Debug)]
pub(super) struct TypeParam {
    /// The name of the type parameter.
    pub name: Symbol,
    /// The types that the type parameter may stand for.
    pub bound: Bound,
}

/// The bound of a type parameter: the types that it may stand for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Bound {
    /// No bound is written.
    Anything,
    /// It is the dimension of quantities, no type of its own.
    Dimension,
    /// An `Int` or any quantity.
    Quantity,
    /// An instance of a declaration of this family.
    Family(Family),
}

/// A parameter of a function, record or declaration with instances: its name, its type, and if it has a default.
#[derive(Clone, Debug)]
pub(super) struct ParamInfo {
    /// The name of the parameter, by which calls may name the argument.
    pub name: Symbol,
    /// The span of the name in the declaration.
    pub span: Span,
    /// The type that arguments of the parameter must fit.
    pub ty: Type,
    /// True if the parameter has a default.
    pub has_default: bool,
    /// True if the parameter takes all remaining positional arguments.
    pub variadic: bool,
}

impl ParamInfo {
    /// Returns true if an argument may be left out: the parameter has a default, is variadic or optional.
    pub(super) fn may_be_left_out(&self) -> bool {
        self.has_default || self.variadic || matches!(self.ty, Type::Optional(_))
    }
}

/// The names inside a declaration with instances: members, joints, ports, parts and behaviours.
#[derive(Default)]
pub(super) struct Members<'a> {
    /// All members: a [`MemberId`] is an index into them.
    pub list: Vec<MemberInfo<'a>>,
    /// The members by name; a member's name is in it once.
    pub index: HashMap<Symbol, MemberId>,
    /// The joints, in the order of the text; modules only.
    pub joints: Vec<JointInfo<'a>>,
    /// The indices in `joints` by name, aliases included.
    pub joint_index: HashMap<Symbol, usize>,
    /// The ports, in the order of the text, an array as one; modules only.
    pub ports: Vec<PortInfo>,
    /// The indices in `ports` by name, aliases included.
    pub port_index: HashMap<Symbol, usize>,
    /// The behaviours, in the order of the text; configurations only.
    pub behaviors: Vec<BehaviorInfo<'a>>,
}

/// A member of a declaration with instances: its name with its syntax, not yet checked.
pub(super) struct MemberInfo<'a> {
    /// The name of the member, as in `object.name`.
    pub name: Symbol,
    /// The span of the name in the declaration.
    pub span: Span,
    /// The text of the doc comment; `None` if there is none.
    pub doc: Option<Arc<str>>,
    /// The kind of the member, with its syntax tree.
    pub kind: MemberInfoKind<'a>,
}

/// The kinds of members, each with its syntax.
#[derive(Clone, Copy)]
pub(super) enum MemberInfoKind<'a> {
    /// The parameter at this index.
    Param(usize),
    /// A `let` at the top of the body.
    Let(&'a ast::Let),
    /// A part, with its index among the parts.
    Part(&'a ast::Part, usize),
    /// A port clause, with true if it is an array.
    Port(&'a ast::ConfigClauseKind, bool),
    /// A behaviour, by its index among the behaviours.
    Behavior(usize),
    /// A node of a truss.
    Node {
        /// True for an array of nodes.
        array: bool,
    },
    /// An obstacle of a scene.
    Obstacle {
        /// True for an array of obstacles.
        array: bool,
    },
}

/// A joint of a module: its name with its syntax, not yet checked.
pub(super) struct JointInfo<'a> {
    /// The name of the joint, by which programs command it.
    pub name: Symbol,
    /// The span of the name in the declaration.
    pub span: Span,
    /// The text of the doc comment; `None` if there is none.
    pub doc: Option<Arc<str>>,
    /// The clause that declares the joint.
    pub clause: &'a ast::ModuleClauseKind,
    /// A further clause `joint b = -a` by which a joint between links follows others; `None` if there is none.
    pub follows: Option<&'a ast::ModuleClauseKind>,
    /// The dimension of the joint's position: an angle or a length.
    pub dimension: crate::units::Dimension,
}

/// A port, or an array of ports, of a module: its name with its syntax, not yet checked.
pub(super) struct PortInfo {
    /// The name of the port, or of the array of ports.
    pub name: Symbol,
    /// The span of the name in the declaration.
    pub span: Span,
    /// The text of the doc comment; `None` if there is none.
    pub doc: Option<Arc<str>>,
    /// True if the port is an array.
    pub array: bool,
}

/// A behaviour of a configuration: its name with its syntax, not yet checked.
pub(super) struct BehaviorInfo<'a> {
    /// The syntax tree of the behaviour.
    pub ast: &'a ast::Behavior,
    /// The text of the doc comment; `None` if there is none.
    pub doc: Option<Arc<str>>,
    /// The signature of the behaviour: its parameters; the result is a behaviour.
    pub signature: Rc<Signature>,
}

/// The state of checking a program.
pub(super) struct Checker<'a> {
    /// The parsed files of the program with their imports.
    pub loaded: &'a Loaded,
    /// The texts that were read, to which spans refer.
    pub sources: &'a Sources,
    /// All declarations, by [`DefId`]: the index in this list is the number in the identity.
    pub defs: Vec<DefInfo<'a>>,
    /// The scope of each file; entries of a session use that of the first entry.
    scopes: Vec<HashMap<Symbol, Entity>>,
    /// The index of the file whose scope the entries of a session share; `None` outside of a session.
    shared: Option<usize>,
    /// The spans at which declarations are named, each with the declaration, in the order of checking.
    pub uses: RefCell<Vec<(Span, DefId)>>,
    /// The names of `let`s that state no type, each with the type of its value, in the order of checking.
    pub lets: Vec<(Span, Type)>,
    /// The values of members' `let`s, once checked, by declaration and member; `None` while one is being checked.
    pub member_lets: HashMap<(DefId, MemberId), Option<typed::Expr>>,
    /// The number of slots that the expressions of a declaration's members need, by declaration; none for one without
    /// such expressions.
    pub member_frames: HashMap<DefId, usize>,
    /// The diagnostics found so far, in order.
    pub diagnostics: Vec<Diagnostic>,
    /// The number of declarations being checked, each needed by the one before.
    pub open_declarations: usize,
    /// The number of lambdas within each other, now open, that are being checked for a wider binding of a type
    /// parameter.
    pub widening: u8,
}

impl<'a> Checker<'a> {
    /// Returns the checker of the loaded files before any declaration is entered. `diagnostics` are those of loading.
    pub(super) fn new(loaded: &'a Loaded, sources: &'a Sources, diagnostics: Vec<Diagnostic>) -> Checker<'a> {
        Checker {
            loaded,
            sources,
            defs: Vec::new(),
            scopes: Vec::new(),
            shared: loaded.files.iter().position(|file| file.entry),
            uses: RefCell::default(),
            lets: Vec::new(),
            member_lets: HashMap::new(),
            member_frames: HashMap::new(),
            diagnostics,
            open_declarations: 0,
            widening: 0,
        }
    }

    /// Returns the state of a declaration. Panics if there is none of this identity.
    pub(super) fn def(&self, id: DefId) -> &DefInfo<'a> {
        &self.defs[id.0 as usize]
    }

    /// Returns the state of a declaration, to change it. Panics if there is none of this identity.
    pub(super) fn def_mut(&mut self, id: DefId) -> &mut DefInfo<'a> {
        &mut self.defs[id.0 as usize]
    }

    /// Adds a diagnostic to those so far.
    pub(super) fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// Returns the entity of a name at the top of a file (an index into the loaded files), the prelude included;
    /// `None` for an unknown name.
    pub(super) fn entity(&self, file: usize, name: Symbol) -> Option<Entity> {
        let own = self.top(file).get(&name).copied();
        own.or_else(|| self.loaded.prelude.and_then(|p| self.top(p).get(&name).copied()))
    }

    /// Returns the entity of a name at the top of a file (an index into the loaded files), the prelude included, and
    /// records its use at `span`; `None` for an unknown name.
    pub(super) fn named_entity(&self, file: usize, name: Symbol, span: Span) -> Option<Entity> {
        let found = self.entity(file, name);
        if let Some(Entity::Def(id)) = found {
            self.uses.borrow_mut().push((span, id));
        }
        found
    }

    /// Returns the names at the top of a file (an index into the loaded files), imports included but not the prelude,
    /// with their entities.
    pub(super) fn top(&self, file: usize) -> &HashMap<Symbol, Entity> {
        &self.scopes[self.scope_index(file)]
    }

    /// Returns the index of a file's scope.
    fn scope_index(&self, file: usize) -> usize {
        if self.loaded.files[file].entry { self.shared.unwrap_or(file) } else { file }
    }

    /// Sets the entity of a name at the top of a file.
    fn set(&mut self, file: usize, name: Symbol, entity: Entity) {
        let index = self.scope_index(file);
        self.scopes[index].insert(name, entity);
    }

    /// Returns a built-in by its name in the prelude; `None` if the prelude has none, or could not be read.
    pub(super) fn prelude_def(&self, name: &str) -> Option<DefId> {
        match self.top(self.loaded.prelude?).get(&Symbol::new(name)) {
            Some(Entity::Def(id)) => Some(*id),
            _ => None,
        }
    }

    /// Returns the names visible at the top of a file (an index into the loaded files), the prelude's included, in no
    /// order.
    pub(super) fn visible_names(&self, file: usize) -> Vec<&'static str> {
        let mut names: Vec<&str> = self.top(file).keys().map(|s| s.as_str()).collect();
        if let Some(prelude) = self.loaded.prelude {
            names.extend(self.top(prelude).keys().map(|s| s.as_str()));
        }
        names
    }

    /// Enters the declarations of every file into its scope, then the imports; reports names that are declared twice.
    pub(super) fn declare(&mut self) {
        let mut of_entries = Vec::new();
        let in_session = self.loaded.files.iter().any(|file| file.entry);
        for (index, file) in self.loaded.files.iter().enumerate() {
            self.scopes.push(HashMap::new());
            for item in &file.ast.items {
                let declared = self.declare_item(index, item);
                match declared {
                    Some(declared) if file.entry => of_entries.push((index, declared)),
                    Some((name, id)) => self.enter(index, name, id),
                    None => {}
                }
            }
            if in_session && !file.entry && !self.sources.file(file.ast.id).library {
                self.reserve_definitions(index, file.ast.id);
            }
        }
        let mut of_entries = of_entries.into_iter().peekable();
        for (index, file) in self.loaded.files.iter().enumerate() {
            // In order of entries, so that the last one counts.
            while let Some((_, (name, id))) = of_entries.next_if(|(of, _)| *of == index) {
                self.enter(index, name, id);
            }
            for import in &file.imports {
                self.declare_import(index, import);
            }
            for name in &file.ast.unread {
                let index = self.scope_index(index);
                self.scopes[index].entry(*name).or_insert(Entity::Error);
            }
        }
    }

    /// Returns true if a declaration of this name is in a piece of text that could not be parsed.
    pub(super) fn is_unread(&self, name: Symbol) -> bool {
        self.loaded.files.iter().any(|file| file.ast.unread.contains(&name))
    }

    /// Adds the declaration of an item, and those of a record's methods; returns its name and identity, or
    /// `None` if it declares nothing.
    fn declare_item(&mut self, file: usize, item: &'a ast::Item) -> Option<(ast::Name, DefId)> {
        use ast::ItemKind as K;
        let (name, def) = match &item.kind {
            K::Let(x) => (x.name, DefItem::Let(x)),
            K::Fn(x) => (x.name, DefItem::Fn(x)),
            K::ExternFn(x) => (x.name, DefItem::Native(x)),
            K::Record(x) => (x.name, DefItem::Record(x)),
            K::ExternType(x) => (x.name, DefItem::ExternType(x)),
            K::Connector(x) => (x.name, DefItem::Connector(x)),
            K::Module(x) => (x.name, DefItem::Module(x)),
            K::Facts(x) => (x.name, DefItem::Facts(x)),
            K::Config(x) => (x.name, DefItem::Config(x)),
            K::Lattice(x) => (x.name, DefItem::Lattice(x)),
            K::Truss(x) => (x.name, DefItem::Truss(x)),
            K::Study(x) => (x.name, DefItem::Study(x)),
            K::Use(_) | K::Test(_) | K::Statement(_) | K::Error => return None,
        };
        let id = self.add_def(file, name, item, def);
        if let DefItem::ExternType(record) = def {
            for (doc, method) in &record.methods {
                let id = self.add_def(file, method.name, item, DefItem::Method(method, id));
                self.defs[id.0 as usize].doc = doc.as_deref().map(Arc::from);
            }
        }
        Some((name, id))
    }

    /// Enters a declaration into the scope of its file; reports a second one of the same name.
    fn enter(&mut self, file: usize, name: ast::Name, id: DefId) {
        if let Some(Entity::Def(first)) = self.top(file).get(&name.text).copied()
            && self.def(first).file == file
        {
            let first = self.def(first).span;
            return self.declared_twice(name.text, first, name.span);
        }
        self.set(file, name.text, Entity::Def(id));
    }

    /// Adds a declaration that has not been checked yet.
    fn add_def(&mut self, file: usize, name: ast::Name, whole: &ast::Item, item: DefItem<'a>) -> DefId {
        self.defs.push(DefInfo {
            name: name.text,
            span: name.span,
            whole: whole.span,
            file,
            doc: whole.doc.as_deref().map(Arc::from),
            item,
            signature: None,
            members: None,
            typed: None,
            inferred: None,
            busy: false,
        });
        DefId(self.defs.len() as u32 - 1)
    }

    /// Reports that a name is declared at both of these spans.
    pub(super) fn declared_twice(&mut self, name: Symbol, first: Span, second: Span) {
        self.report(
            Diagnostic::error(code::DECLARED_TWICE, format!("`{name}` is declared twice"))
                .label(second, "declared again here")
                .label(first, "first declared here")
                .hint("give one of them another name"),
        );
    }

    /// Enters an import into the scope of its file; reports a name that is taken, except that in a session a
    /// later import replaces what an earlier entry declared.
    fn declare_import(&mut self, file: usize, import: &super::load::Import) {
        let entity = match import.target {
            ImportTarget::Error => Entity::Error,
            ImportTarget::File(target) => Entity::File(target),
            ImportTarget::Item { file: target, item, span } => self.imported(target, item, span),
        };
        // In a session the later import counts.
        let older = |first| self.loaded.files[file].entry && self.def(first).file != file;
        if let Some(Entity::Def(first)) = self.top(file).get(&import.name).copied()
            && entity != Entity::Error
            && !older(first)
        {
            if entity != Entity::Def(first) {
                let first = self.def(first).span;
                if first.file == import.span.file {
                    self.declared_twice(import.name, first, import.span);
                } else {
                    self.report(
                        Diagnostic::error(
                            code::DECLARED_TWICE,
                            format!("`{}` is imported twice", import.name),
                        )
                        .label(import.span, "two items of this name are imported")
                        .hint(format!("rename one: `{{{} as Other}}`", import.name)),
                    );
                }
            }
            return;
        }
        self.set(file, import.name, entity);
    }

    /// Returns the entity that an import of an item stands for; reports an unknown or private one.
    fn imported(&mut self, target: usize, item: Symbol, span: Span) -> Entity {
        let id = self.loaded.files[target].ast.id;
        let shown = self.sources.file(id).name.clone();
        // Only a file's own declarations can be imported from it.
        let own = self.top(target).get(&item).copied();
        let declared = own.filter(|e| matches!(e, Entity::Def(id) if self.def(*id).file == target));
        match declared {
            Some(entity) if item.as_str().starts_with('_') => {
                self.report(
                    Diagnostic::error(code::PRIVATE_NAME, format!("`{item}` is private to `{shown}`"))
                        .label(span, "names that begin with `_` can't be imported"),
                );
                let _ = entity;
                Entity::Error
            }
            Some(entity) => entity,
            None if self.is_unread(item) => Entity::Error,
            None => {
                let names = self.top(target).keys().map(|s| s.as_str());
                let near = suggest(item.as_str(), names);
                let mut diagnostic =
                    Diagnostic::error(code::UNKNOWN_IMPORT, format!("`{shown}` has no `{item}`"))
                        .label(span, "no such item");
                if let Some(near) = near {
                    diagnostic = diagnostic.hint(format!("`{near}`?"));
                }
                self.report(diagnostic);
                Entity::Error
            }
        }
    }

    /// Returns the family (module, configuration, cell and so on) of a declaration with instances; `None` for other
    /// declarations. Panics if there is none of this identity.
    pub(super) fn family(&self, id: DefId) -> Option<Family> {
        Some(match self.def(id).item {
            DefItem::Module(_) => Family::Module,
            DefItem::Config(_) => Family::Config,
            DefItem::Facts(x) => x.family.into(),
            DefItem::Lattice(_) => Family::Lattice,
            DefItem::Truss(_) => Family::Truss,
            _ => return None,
        })
    }

    /// Returns (program, diagnostics): the typed program, and the diagnostics in the order of discovery, once every
    /// declaration has been checked; one that has not is [`DefKind::Error`]. `statements` and `tests`: those of the
    /// file that is run.
    pub(super) fn finish(
        self,
        statements: typed::Body,
        tests: Vec<typed::Test>,
    ) -> (Program, Vec<Diagnostic>) {
        let mut own = Vec::new();
        let mut defs = Vec::with_capacity(self.defs.len());
        for (index, info) in self.defs.into_iter().enumerate() {
            let file: FileId = self.loaded.files[info.file].ast.id;
            if !self.sources.file(file).library && !matches!(info.item, DefItem::Vacant) {
                own.push(DefId(index as u32));
            }
            let kind = info.typed.unwrap_or(DefKind::Error);
            defs.push(typed::Def {
                name: info.name,
                span: info.span,
                whole: info.whole,
                file,
                doc: info.doc,
                kind,
            });
        }
        (Program { defs, statements, tests, own }, self.diagnostics)
    }
}
