//! `save`: files in formats of others, by the end of their names.

use super::Native;
use super::plan::{output_path, write_output};
use super::rofi;
use super::show::{Form, picture_of, plot_of};
use crate::formats::{Crease, CreasePattern, ExportFormat, FOLDING_FORMATS, ROBOT_FORMATS};
use crate::interpret::argument::parameters;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::plan_value::PlanValue;
use crate::interpret::record::Record;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;
use crate::planners::fold::{Net, Report};
use crate::view::Side;

/// The natives of this file.
pub(super) const TABLE: &[Native] = &[Native::on_run("save", parameters![what: &Value, file: &str], save)];

/// Runs `save`: writes a robot or a folding in the format that the ending of the name asks for.
fn save(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (path, name) = output_path(call, "file")?;
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    if let Some(plot) = plot_of(call.arg("what")) {
        let form = match ending {
            "svg" => Form::Svg,
            "png" => Form::Png { time: 0.0, side: Side::Corner },
            _ => return Err(call.refuse("file", "the name of a plot's picture ends in `.svg` or `.png`")),
        };
        let bytes = picture_of(interpreter, plot, form).expect("plots are drawn in both forms");
        write_output(interpreter, call.at("file"), &path, bytes)?;
        return Ok(Value::Nothing);
    }
    let robot = ExportFormat::of_ending(ROBOT_FORMATS, ending);
    let folding = ExportFormat::of_ending(FOLDING_FORMATS, ending);
    let [robots, foldings] = [ExportFormat::endings(ROBOT_FORMATS), ExportFormat::endings(FOLDING_FORMATS)];
    let other = format!("a robot's name ends in {robots}, a folding's in {foldings}");
    let text = match call.arg("what") {
        Value::Instance(_) if folding.is_some() => return Err(call.refuse("file", other)),
        Value::Record(_) if robot.is_some() => return Err(call.refuse("file", other)),
        Value::Record(record) => {
            let planned = match &**record {
                Record::Plan(planned) => Some(planned),
                Record::Native(record) => record.plan(),
                _ => None,
            };
            let Some(planned) = planned else {
                return Err(call.refuse("what", "a robot or a folding is wanted"));
            };
            let Some(folded) = planned.report::<Report>() else {
                return Err(call.refuse("what", "this plan folds no pattern: `fold` makes those that do"));
            };
            let Some(format) = folding else {
                let message = format!("the name of a folding's file ends in {foldings}");
                return Err(call.refuse("file", message));
            };
            (format.write)(&creases(planned, folded))
        }
        _ => {
            let Some(format) = robot else {
                return Err(call.refuse("file", format!("the name of a robot's file ends in {robots}")));
            };
            let Some(world) = rofi::world_of(interpreter, call)? else { return Ok(Value::Unknown) };
            (format.write)(&world)
        }
    };
    write_output(interpreter, call.at("file"), &path, text.into_bytes())?;
    Ok(Value::Nothing)
}

/// Returns the crease pattern of a folding, with the shape after each of its steps.
fn creases(planned: &PlanValue, folded: &Report) -> CreasePattern {
    let (target, layout) = (&folded.target, &folded.layout);
    let net = Net::of(target, layout);
    let step = |face: usize| folded.steps.iter().position(|step| step.contains(&face)).map(|i| i + 1);
    let edges = net.edges.iter().map(|edge| Crease {
        vertices: edge.vertices,
        faces: edge.faces.clone(),
        angle: edge.angle,
        step: edge.faces.get(1).and_then(|face| step(*face)),
        glued: edge.glued,
    });
    let after = |done: usize| {
        let angle = |face: usize| {
            let hinge = layout.hinge[face].expect("only the root has none");
            if step(face).is_some_and(|step| step <= done) { target.hinges[hinge].angle } else { 0.0 }
        };
        net.vertices_at(target, layout, angle).iter().map(|v| [v.x, v.y, v.z]).collect()
    };
    CreasePattern {
        title: planned.robot.name.clone(),
        vertices: net.vertices.clone(),
        faces: net.faces.clone(),
        modules: (0..target.faces.len()).map(|face| format!("panel[{face}]")).collect(),
        edges: edges.collect(),
        folded: (1..=folded.steps.len()).map(after).collect(),
    }
}
