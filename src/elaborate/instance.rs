//! Instances: a declaration and its arguments, elaborated once and shared.

use crate::check::family::Instantiable;
use crate::check::typed::{DefId, DefKind, Expr, Param};
use crate::interpret::design::{ConfigDesign, Design, DesignKind, Instance};
use crate::interpret::frame::Frame;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::routines::Args;
use crate::interpret::scene::SceneDesign;
use crate::interpret::stop::Eval;
use crate::interpret::value::{Value, arguments_key};
use crate::source::{Diagnostic, Span, code};
use std::cell::Cell;
use std::rc::Rc;

impl Interpreter<'_> {
    /// Returns an instance of a declaration with these arguments, such as `Walker(bend: 35deg)`; [`Value::Unknown`]
    /// where the declaration is broken or an argument is unknown.
    ///
    /// # Errors
    /// As [`design_of`](Self::design_of).
    pub(super) fn make_instance(&mut self, def: DefId, args: Args, span: Span) -> Eval<Value> {
        Ok(match self.design_of(def, args, span)? {
            Some(design) if !design.broken.get() => Value::Instance(self.whole(&design)),
            _ => Value::Unknown,
        })
    }

    /// Returns the design of a declaration with these arguments, elaborated once; it may be broken. `None` where an
    /// argument is unknown, the declaration has no instances, or `check` found mistakes in it. `def`: the
    /// declaration; `args`: its arguments in the order of the parameters.
    ///
    /// # Errors
    /// A fault at `span` where the declaration needs itself, or `Stop::Halt` if a limit is reached or the user cancels.
    pub fn design_of(&mut self, def: DefId, args: Args, span: Span) -> Eval<Option<Rc<Design>>> {
        if self.shared.faulty[def.0 as usize] {
            return Ok(None);
        }
        let Some(body) = self.shared.program.def(def).kind.instantiable() else { return Ok(None) };
        let Some((args, shown)) = self.fill_params(def, body.params, args)? else { return Ok(None) };
        let known = self.memory.designs[def.0 as usize]
            .find(arguments_key(&args), |known| same_args(&known.args, &args));
        match known {
            Some(design) => self.check_complete(&design, span).map(|()| Some(design)),
            None => self.elaborate(def, args, &shown, span).map(Some),
        }
    }

    /// Refuses a configuration that is met again before it is complete, since it is a part of itself.
    fn check_complete(&mut self, design: &Rc<Design>, span: Span) -> Eval<()> {
        let running = design.config().is_some_and(|config| !config.complete.get());
        if running {
            let declared = self.shared.program.def(design.def).span;
            let message = format!("`{}` is a part of itself", design.name);
            return Err(Diagnostic::error(code::DECLARATION_CYCLE, message)
                .label(span, "needed here, before it is complete")
                .label(declared, "declared here")
                .into());
        }
        Ok(())
    }

    /// Returns all arguments with the defaults filled in, and those that differ from the defaults as text;
    /// `None` where one is unknown.
    fn fill_params(
        &mut self,
        def: DefId,
        params: &[Param],
        args: Args,
    ) -> Eval<Option<(Vec<Value>, String)>> {
        let mut filled = Vec::with_capacity(params.len());
        let mut shown = Vec::new();
        let mut given = args.values.into_iter();
        for param in params {
            let default = match &param.default {
                Some(default) => Some(self.default_argument(def, default, &filled)?),
                None => None,
            };
            let value = match given.next().flatten() {
                Some(value) => {
                    if default.as_ref().is_none_or(|d| d.same(&value) != Some(true)) {
                        shown.push(format!("{}: {}", param.name, self.show(&value)));
                    }
                    value
                }
                None => default.unwrap_or(Value::Missing),
            };
            if value.is_unknown() {
                return Ok(None);
            }
            filled.push(value);
        }
        Ok(Some((filled, shown.join(", "))))
    }

    /// Returns the value of a default, which may depend on the parameters before it.
    fn default_argument(&mut self, def: DefId, default: &Expr, before: &[Value]) -> Eval<Value> {
        let shell = self.shell(def, before.to_vec());
        let mut frame = Frame::new(0, Some(shell));
        for (slot, value) in before.iter().enumerate() {
            frame.set_slot(slot, value.clone());
        }
        self.eval(default, &mut frame)
    }

    /// Returns an instance that has arguments, one for each parameter in order, and nothing else: the expressions of a
    /// body are evaluated in it before there is a body.
    pub(super) fn shell(&self, def: DefId, args: Vec<Value>) -> Rc<Instance> {
        let design = Design {
            def,
            name: self.name(def).to_string(),
            args,
            kind: DesignKind::Config(ConfigDesign::default()),
            broken: Cell::new(false),
        };
        Instance::whole(Rc::new(design))
    }

    /// Elaborates a declaration with these arguments and keeps its design, which is marked as broken where an
    /// error was found. `shown`: the arguments that differ from the defaults, in words.
    fn elaborate(&mut self, def: DefId, args: Vec<Value>, shown: &str, span: Span) -> Eval<Rc<Design>> {
        let program = self.shared.program;
        let name = self.name(def);
        let title = if shown.is_empty() { name.to_string() } else { format!("{name}({shown})") };
        let mark = self.reported.errors;
        let design = match &program.def(def).kind {
            DefKind::Config(config) => {
                let scene = config.scene.then(SceneDesign::default);
                let kind = ConfigDesign { closed: config.closed.is_some(), scene, ..ConfigDesign::default() };
                let design = self.keep(def, title, args, DesignKind::Config(kind));
                self.with_call(span, name, |this| this.elaborate_config(config, &design))?;
                design
            }
            other => {
                let shell = self.shell(def, args.clone());
                let kind =
                    self.with_call(span, name, |this| this.elaborate_leaf(other, def, &shell, &title))?;
                let broken = kind.is_none();
                let kind = kind.unwrap_or_else(|| DesignKind::Config(ConfigDesign::default()));
                let design = self.keep(def, title, args, kind);
                if let Some(config) = design.config() {
                    config.complete.set(true);
                }
                if broken {
                    design.broken.set(true);
                }
                design
            }
        };
        if self.failed_since(mark) {
            design.broken.set(true);
        }
        Ok(design)
    }

    /// Elaborates any declaration but a configuration; `None` where it is broken, which has been reported.
    fn elaborate_leaf(
        &mut self,
        kind: &DefKind,
        def: DefId,
        shell: &Rc<Instance>,
        title: &str,
    ) -> Eval<Option<DesignKind>> {
        match kind {
            DefKind::Module(module) => self.elaborate_module(module, def, shell, title),
            DefKind::Facts(facts) => self.elaborate_facts(facts, def, shell, title),
            DefKind::Lattice(lattice) => self.elaborate_lattice(lattice, def, shell),
            DefKind::Truss(truss) => self.elaborate_truss(truss, def, shell),
            _ => Ok(None),
        }
    }

    fn keep(&mut self, def: DefId, name: String, args: Vec<Value>, kind: DesignKind) -> Rc<Design> {
        let design = Rc::new(Design { def, name, args, kind, broken: Cell::new(false) });
        self.memory.designs[def.0 as usize].push(arguments_key(&design.args), design.clone());
        design
    }

    /// Returns the design of a declaration with the defaults of all its parameters, elaborated once; it may be broken.
    /// `None` where a parameter has no default, the declaration has no instances, or `check` found mistakes in it.
    ///
    /// # Errors
    /// A fault at the declaration where it needs itself, or `Stop::Halt` if a limit is reached or the user cancels.
    pub fn default_design(&mut self, def: DefId) -> Eval<Option<Rc<Design>>> {
        let declared = self.shared.program.def(def);
        let Some(Instantiable { params, .. }) = declared.kind.instantiable() else { return Ok(None) };
        if params.iter().any(|p| p.default.is_none()) {
            return Ok(None);
        }
        self.design_of(def, Args { values: vec![None; params.len()], spans: Vec::new() }, declared.span)
    }
}

fn same_args(a: &[Value], b: &[Value]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(x, y)| x.same(y) == Some(true))
}
