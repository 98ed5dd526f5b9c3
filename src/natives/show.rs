//! Built-ins that draw: plans, simulations, robots, lattices and trusses as pages and pictures.

use super::Native;
use super::plan::{output_path, settings, write_output};
use super::plot::PlotValue;
use super::simulate::Simulated;
use crate::check::typed::DefKind;
use crate::geometry::Vec3;
use crate::interpret::argument::{Choice, Positive, parameters};
use crate::interpret::causes::PlanCauses;
use crate::interpret::design::LatticeDesign;
use crate::interpret::design::TrussDesign;
use crate::interpret::design::{Design, DesignKind};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::plan_value::PlanValue;
use crate::interpret::record::Record;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;
use crate::plan::{
    Body, CauseId, CellLimits, Interpolation, Keyframe, Margins, Model, NodePaths, Plan, Ramps, Ratio, Run,
    Settings, Stability, Stages, Surroundings, TrussLimits, World,
};
use crate::planners::morph::{self, TargetShape};
use crate::robot::Library;
use crate::source::{Diagnostic, Span, code};
use crate::view::plot::Plot;
use crate::view::{self, PictureStyle, RenderInput, Side, SimulationInput, StillOptions};
use std::any::Any;
use std::rc::Rc;
use std::sync::Arc;

/// The built-in `show`, which draws a plan, a simulation, a robot or a plot into a file: its key with its parameters and its Rust
/// function.
pub(super) const TABLE: &[Native] = &[Native::on_run(
    "show",
    parameters![
        what: &Value,
        file: &str,
        sample: Positive,
        unstable_for: f64,
        stability: Stability,
        at: f64,
        side: Side,
        reserve: f64,
        slip_max: Option<f64>,
        slip: f64,
        look: PictureStyle
    ],
    show,
)];

/// Runs `show`: draws a lattice or truss as it is declared, a simulation as it was measured, or a plan with its verdict,
/// whose failures are reported.
fn show(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (path, name) = output_path(call, "file")?;
    let Some(form) = form(call, &name)? else {
        return Err(call.refuse("file", "a page's name ends in `.html`, a picture's in `.svg` or `.png`"));
    };
    if let Some(plot) = plot_of(call.arg("what")) {
        let bytes = picture_of(interpreter, plot, form)
            .ok_or_else(|| call.refuse("file", "the name of a plot's picture ends in `.svg` or `.png`"))?;
        write_output(interpreter, call.at("file"), &path, bytes)?;
        return Ok(Value::Nothing);
    }
    if let Some(simulated) = simulated_of(call.arg("what")) {
        let Form::Page = form else {
            return Err(call.refuse("file", "the name of a simulation's page ends in `.html`"));
        };
        let bytes = interpreter.drawn_simulation(simulated);
        write_output(interpreter, call.at("file"), &path, bytes)?;
        return Ok(Value::Nothing);
    }
    let settings = settings(interpreter, call)?;
    if let Value::Instance(instance) = call.arg("what")
        && let Some(plan) = interpreter.still(&instance.design)
    {
        let bytes = interpreter.drawn(&instance.design.name, &plan, form);
        write_output(interpreter, call.at("file"), &path, bytes)?;
        return Ok(Value::Nothing);
    }
    let Some(planned) = interpreter.plan_of(call.arg("what"), call.at("what"))? else {
        return Ok(Value::Unknown);
    };
    let verdict = interpreter.judge(&planned, settings, None)?;
    interpreter.note_exemptions(&planned, &verdict);
    let shown = interpreter.draw(&planned, settings, form, &path, call.at("file"))?;
    if !verdict.ok() {
        interpreter.report_failures(&planned, &verdict, call.at("what"), Some(&shown));
        return Ok(Value::Unknown);
    }
    Ok(Value::Nothing)
}

/// Returns the plot that a value is; `None` for any other value.
pub(super) fn plot_of(value: &Value) -> Option<&Plot> {
    native::<PlotValue>(value).map(PlotValue::plot)
}

/// Returns the simulation that a value is; `None` for any other value.
pub(super) fn simulated_of(value: &Value) -> Option<&Simulated> {
    native(value)
}

/// Returns the record of a type that a value is; `None` for any other value.
fn native<T: 'static>(value: &Value) -> Option<&T> {
    let Value::Record(record) = value else { return None };
    let Record::Native(record) = &**record else { return None };
    let record: &dyn Any = record.as_ref();
    record.downcast_ref()
}

/// Returns a plot as a picture of this form, the bytes of a file; `None` in a form that plots do not have
/// ([`Form::Page`]).
pub(super) fn picture_of(interpreter: &Interpreter, plot: &Plot, form: Form) -> Option<Vec<u8>> {
    match form {
        Form::Page => None,
        Form::Svg => Some(view::plot::svg(plot).into_bytes()),
        Form::Png { .. } => {
            let width = interpreter.shared.options.picture.map_or(PLOT_WIDTH, |(width, _)| width);
            Some(view::plot::png(plot, width))
        }
    }
}

/// The width of the picture of a plot, pixels.
const PLOT_WIDTH: usize = 1440;

/// A form of drawing, chosen by the ending of the file's name.
#[derive(Clone, Copy)]
pub(super) enum Form {
    /// A page in HTML.
    Page,
    /// A drawing in SVG.
    Svg,
    /// A picture in PNG.
    Png {
        /// The time that it shows, s.
        time: f64,
        /// The side from which it is seen.
        side: Side,
        /// Its look.
        look: PictureStyle,
    },
}

fn form(call: &Call, name: &str) -> Eval<Option<Form>> {
    Ok(match name.rsplit_once('.') {
        Some((_, "html")) => Some(Form::Page),
        Some((_, "svg")) => Some(Form::Svg),
        Some((_, "png")) => {
            Some(Form::Png { time: call.get("at")?, side: call.get("side")?, look: call.get("look")? })
        }
        _ => None,
    })
}

impl Choice for Side {
    const WORDS: &'static [(&'static str, Side)] = &[
        ("corner", Side::Corner),
        ("front", Side::Front),
        ("back", Side::Back),
        ("left", Side::Left),
        ("right", Side::Right),
        ("top", Side::Top),
    ];
}

impl Choice for PictureStyle {
    const WORDS: &'static [(&'static str, PictureStyle)] =
        &[("room", PictureStyle::Room), ("figure", PictureStyle::Figure)];
}

impl Interpreter<'_> {
    /// Draws a plan with its verdict under these settings, and writes the drawing to `path`, below the output folder;
    /// returns the path to show.
    ///
    /// # Errors
    /// A fault at `at` where it can't be written.
    pub(super) fn draw(
        &mut self,
        planned: &Rc<PlanValue>,
        settings: Settings,
        form: Form,
        path: &str,
        at: Span,
    ) -> Eval<String> {
        let verdict = self.judge(planned, settings, None)?;
        let plan = Plan { settings, verdict: Some(verdict.as_ref().clone()), ..planned.plan.clone() };
        let title = view::title(&plan, &planned.robot.name);
        let target = planned.report::<morph::Report>().map(|report| &report.target);
        let bytes = match (form, target) {
            (Form::Page, Some(TargetShape::Mesh(target))) => self.drawn_with_target(&title, &plan, target),
            _ => self.drawn(&title, &plan, form),
        };
        write_output(self, at, path, bytes)
    }

    /// Returns the page of a plan with the surface that a truss takes on.
    fn drawn_with_target(&self, title: &str, plan: &Plan, target: &[[Vec3; 3]]) -> Vec<u8> {
        let texts = self.texts_of(plan);
        let input = RenderInput { title, plan, texts: &texts, command: &self.shared.options.command };
        view::target_page(&input, target).into_bytes()
    }

    /// Draws every configuration, lattice and truss of the project's own files, with its defaults, for a
    /// program that draws nothing itself. Faults are reported.
    ///
    /// # Errors
    /// `Stop::Halt` if a limit is reached or the user cancels.
    pub(super) fn draw_declarations(&mut self) -> Eval<()> {
        let program = self.shared.program;
        for &def in &program.own {
            let declared = program.def(def);
            let drawn = matches!(declared.kind, DefKind::Config(_) | DefKind::Lattice(_) | DefKind::Truss(_));
            if drawn && let Some(design) = self.attempt(|this| this.default_design(def))?.flatten() {
                let path = format!("{}.html", declared.name);
                self.attempt(|this| this.draw_design(&design, &path, declared.span))?;
            }
        }
        if self.reported.written.iter().all(|path| !path.ends_with(".html")) && self.reported.errors == 0 {
            let message = "the program emits no plan and declares no robot that needs no arguments, so there is \
                           nothing to show";
            self.report(Diagnostic::warning(code::NOTHING_SHOWN, message).hint(
                "`emit(robot.behavior(), \"name.plan.json\")` writes a plan, of which `modl show` draws a page",
            ));
        }
        Ok(())
    }

    /// Returns a design as it is declared: a plan in which nothing moves, and that is not judged. `None` for other designs
    /// than configurations, lattices and trusses, and for what is broken.
    ///
    /// # Errors
    /// A fault at `at` for a configuration without modules, a fault of a declaration that the robot needs, or
    /// `Stop::Halt` if a limit is reached or the user cancels.
    pub(super) fn as_declared(&mut self, design: &Rc<Design>, at: Span) -> Eval<Option<Plan>> {
        match self.still(design) {
            Some(plan) => Ok(Some(plan)),
            None => Ok(self.plan_pose(design, at)?.map(|planned| planned.plan.clone())),
        }
    }

    fn draw_design(&mut self, design: &Rc<Design>, path: &str, at: Span) -> Eval<()> {
        if let Some(plan) = self.still(design) {
            let bytes = self.drawn(&design.name, &plan, Form::Page);
            write_output(self, at, path, bytes)?;
        } else if let Some(planned) = self.plan_pose(design, at)? {
            let settings = self.judge_settings();
            self.draw(&planned, settings, Form::Page, path, at)?;
        }
        Ok(())
    }

    fn drawn(&self, title: &str, plan: &Plan, form: Form) -> Vec<u8> {
        let texts = self.texts_of(plan);
        let input = RenderInput { title, plan, texts: &texts, command: &self.shared.options.command };
        match form {
            Form::Page => view::page(&input).into_bytes(),
            Form::Svg => view::svg(&input).into_bytes(),
            Form::Png { time, side, look } => {
                let own = StillOptions::default();
                let (width, height) = self.shared.options.picture.unwrap_or((own.width, own.height));
                view::png(&input, &StillOptions { time, side, width, height, look })
            }
        }
    }

    /// Returns the page of a simulation, the bytes of a file.
    fn drawn_simulation(&self, simulated: &Simulated) -> Vec<u8> {
        let Simulated { planned, outcome, runs, notes } = simulated;
        let texts = self.texts_of(&planned.plan);
        let (title, command) = (&planned.robot.name, &self.shared.options.command);
        let input = RenderInput { title, plan: &planned.plan, texts: &texts, command };
        view::simulation_page(&input, &SimulationInput { outcome, runs, notes }).into_bytes()
    }

    /// Returns the user's own files that a plan's causes are written in, in order of loading.
    fn texts_of(&self, plan: &Plan) -> Vec<(String, String)> {
        let named = |name: &str| {
            let places = plan.causes.iter().flat_map(|c| std::iter::once(c).chain(c.caller.as_deref()));
            places.into_iter().any(|place| place.file == name)
        };
        let own = self.shared.sources.files().filter(|(_, file)| !file.library && named(&file.name));
        own.map(|(_, file)| (file.name.to_string(), file.text.to_string())).collect()
    }

    /// Returns a lattice or truss as it is declared: a plan in which nothing moves, and that is not judged.
    /// `None` for other designs, and for a broken cell or strut.
    fn still(&self, design: &Design) -> Option<Plan> {
        let mut library = Library::default();
        let body = match &design.kind {
            DesignKind::Lattice(lattice) => Body::Stages(cells(lattice, &mut library)?),
            DesignKind::Truss(truss) => Body::NodePaths(nodes(truss, &mut library)?),
            _ => return None,
        };
        Some(self.bare_plan("", body, Arc::new(library), World::default(), &PlanCauses::default()))
    }
}

fn cells(lattice: &LatticeDesign, library: &mut Library) -> Option<Stages> {
    let DesignKind::Cell(cell) = &lattice.of.kind else { return None };
    library.cells.push(cell.clone());
    let run = |(index, place): (usize, &[i64; 3])| Run {
        first: index as u64,
        counters: Vec::new(),
        center: place.map(|x| Ratio(x, 1)),
        size: [Ratio::ONE; 3],
    };
    let positions = &lattice.cells.positions;
    Some(Stages {
        cell: 0,
        count: positions.len() as u64,
        time_unit: 1.0,
        limits: CellLimits::default(),
        model: Model::default(),
        anchor: None,
        start: positions.iter().enumerate().map(run).collect(),
        stages: Vec::new(),
    })
}

/// Returns a truss as it is declared as node paths in which nothing moves, and adds its strut to a library; `None` for a
/// broken strut.
pub(super) fn nodes(truss: &TrussDesign, library: &mut Library) -> Option<NodePaths> {
    library.struts.push(truss.strut_kind()?.clone());
    let positions = truss.nodes.iter().map(|node| node.position.into());
    let start = Keyframe {
        time: 0.0,
        interpolation: Interpolation::Linear,
        ramps: Ramps::NONE,
        nodes: positions.collect(),
        cause: CauseId(0),
        margins: Margins::default(),
    };
    Some(NodePaths {
        strut: 0,
        limits: TrussLimits::default(),
        surroundings: Surroundings::default(),
        node_names: truss.nodes.iter().map(|node| node.name.clone()).collect(),
        struts: truss.struts.clone(),
        merged: Vec::new(),
        keyframes: vec![start],
        events: Vec::new(),
    })
}
