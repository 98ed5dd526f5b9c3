//! `save`: files in formats of others, by the end of their names.

use super::Native;
use super::plan::{output_path, write_output};
use super::rofi;
use super::save_table;
use super::show::{Form, picture_of, plot_of};
use crate::exchange::{Export, ExportFile, PLAN_FORMATS, PlanFormat};
use crate::formats::{Crease, CreasePattern, ExportFormat, FOLDING_FORMATS, ROBOT_FORMATS, TABLE_FORMATS};
use crate::interpret::argument::parameters;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::plan_value::PlanValue;
use crate::interpret::record::Record;
use crate::interpret::stop::{Eval, Stop};
use crate::interpret::value::Value;
use crate::planners::fold::{Net, Report};
use crate::source::{Diagnostic, code};
use crate::view::{PictureStyle, Side};

/// The built-in `save`, which writes a value to a file: its key with its parameters and its Rust function.
pub(super) const TABLE: &[Native] = &[Native::on_run("save", parameters![what: &Value, file: &str], save)];

/// Runs `save`: writes a value in the format that the ending of the name asks for.
fn save(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (path, name) = output_path(call, "file")?;
    let ending = ending_of(&name);
    let what = call.arg("what");
    if moves(what)
        && let Some((format, _)) = PlanFormat::of_file(&path)
    {
        return export(interpreter, call, format, &path);
    }
    let bytes = if let Some(plot) = plot_of(what) {
        let form = match ending {
            "svg" => Form::Svg,
            "png" => Form::Png { time: 0.0, side: Side::Corner, look: PictureStyle::Room },
            _ => return Err(wrong_ending(call, ending, "a plot")),
        };
        picture_of(interpreter, plot, form).expect("plots are drawn in both forms")
    } else if let Value::List(elements) = what {
        let Some(table) = interpreter.table(what) else {
            let empty = elements.is_empty();
            let message =
                if empty { "an empty list has no records to save" } else { "a list of records is wanted" };
            return Err(call.refuse("what", message));
        };
        let Some(format) = ExportFormat::of_ending(TABLE_FORMATS, ending) else {
            return Err(wrong_ending(call, ending, "a list of records"));
        };
        (format.write)(&save_table::for_file(interpreter, &table)).into_bytes()
    } else if let Some(planned) = plan_in(what) {
        let Some(folded) = planned.report::<Report>() else {
            return Err(wrong_ending(call, ending, "a plan"));
        };
        let Some(format) = ExportFormat::of_ending(FOLDING_FORMATS, ending) else {
            return Err(wrong_ending(call, ending, "a folding"));
        };
        (format.write)(&creases(planned, folded)).into_bytes()
    } else if let Value::Behavior(_) = what {
        return Err(wrong_ending(call, ending, "a plan"));
    } else {
        let Some(format) = ExportFormat::of_ending(ROBOT_FORMATS, ending) else {
            return Err(wrong_ending(call, ending, "a robot"));
        };
        let Some(world) = rofi::world_of(interpreter, call)? else { return Ok(Value::Unknown) };
        (format.write)(&world).into_bytes()
    };
    write_output(interpreter, call.at("file"), &path, bytes)?;
    Ok(Value::Nothing)
}

/// Writes a plan in a format of other programs, below the output folder: several files where the format is of several.
///
/// # Errors
/// A fault where the format has no meaning for the plan, or a file can't be written.
fn export(interpreter: &mut Interpreter, call: &Call, format: &PlanFormat, path: &str) -> Eval<Value> {
    let at = call.at("what");
    let Some(planned) = interpreter.plan_of(call.arg("what"), at)? else { return Ok(Value::Unknown) };
    if interpreter.shared.options.collects {
        return Ok(Value::Nothing);
    }
    let mut plan = planned.plan.clone();
    if format.is_motion {
        // A motion that a robot could execute is judged, as `emit` does.
        let verdict = interpreter.judge(&planned, interpreter.judge_settings(), None)?;
        interpreter.note_exemptions(&planned, &verdict);
        interpreter.note_judgement(&verdict, &crate::plan::headline(&planned.plan, &verdict), call.span);
        if !verdict.ok() {
            interpreter.report_failures(&planned, &verdict, at, None);
            return Ok(Value::Unknown);
        }
        plan.verdict = Some(verdict.as_ref().clone());
    }
    let (folder, file) = path.rsplit_once('/').map_or(("", path), |(folder, file)| (folder, file));
    let (_, stem) = PlanFormat::of_file(file).unwrap_or((format, file));
    let stem = if stem.is_empty() { "plan" } else { stem };
    let export = Export::new(&plan, &planned.robot.name, stem);
    let files = format.write(&export).map_err(|refusal| call.refuse("what", refusal.to_string()))?;
    for ExportFile { name, bytes } in files {
        let path = if folder.is_empty() { name } else { format!("{folder}/{name}") };
        write_output(interpreter, call.at("file"), &path, bytes)?;
    }
    Ok(Value::Nothing)
}

/// Returns the end of a name after its last dot, or after the one before it where a format has two; empty without a
/// dot.
fn ending_of(name: &str) -> &str {
    match PlanFormat::of_file(name) {
        Some((format, _)) => format.ending,
        None => name.rsplit_once('.').map_or("", |(_, ending)| ending),
    }
}

/// Returns the plan that a value is or reports on; `None` for other values.
fn plan_in(value: &Value) -> Option<&PlanValue> {
    let Value::Record(record) = value else { return None };
    match &**record {
        Record::Plan(planned) => Some(planned),
        Record::Native(record) => record.plan().map(|planned| &**planned),
        _ => None,
    }
}

/// Returns true for a plan, a behaviour, and a robot at rest.
fn moves(value: &Value) -> bool {
    matches!(value, Value::Instance(_) | Value::Behavior(_)) || plan_in(value).is_some()
}

/// Returns the fault of a name whose ending does not fit the value: what fits, or everything that `save` knows.
fn wrong_ending(call: &Call, ending: &str, value: &str) -> Stop {
    let endings: Vec<String> = PLAN_FORMATS.iter().map(|format| format!("`.{}`", format.ending)).collect();
    let (last, others) = endings.split_last().expect("there are formats");
    let others = others.join(", ");
    let known = [
        ("a plan", format!("{others} or {last}")),
        ("a robot", format!("{others}, {last}, {}", ExportFormat::endings(ROBOT_FORMATS))),
        ("a folding", format!("{others}, {last} or {}", ExportFormat::endings(FOLDING_FORMATS))),
        ("a plot", "`.svg` or `.png`".to_string()),
        ("a list of records", ExportFormat::endings(TABLE_FORMATS)),
    ];
    let own = known.iter().find(|(kind, _)| *kind == value).map_or("", |(_, endings)| endings);
    let elsewhere = known.iter().find(|(_, endings)| endings.contains(&format!("`.{ending}`")));
    let (message, hint) = match elsewhere {
        Some((other, _)) => (format!("{value} is saved as {own}; `.{ending}` is for {other}"), String::new()),
        None => {
            let all: Vec<String> =
                known.iter().map(|(kind, endings)| format!("{kind} as {endings}")).collect();
            let name =
                if ending.is_empty() { "a name without an ending".into() } else { format!("`.{ending}`") };
            let message = format!("{name} is no format that `save` knows; {value} is saved as {own}");
            (message, format!("`save` writes {}; `emit` writes plans, `show` draws", all.join(", ")))
        }
    };
    let fault = Diagnostic::error(code::BAD_VALUE, message)
        .label(call.at("file"), format!("{value} is saved as {own}"));
    if value == "a plan" {
        return fault.hint("`emit` writes the plan itself, and `show` draws it").into();
    }
    if hint.is_empty() { fault.into() } else { fault.hint(hint).into() }
}

/// Returns the crease pattern of a folding, with the shape after each of its steps.
fn creases(planned: &PlanValue, folded: &Report) -> CreasePattern {
    let (target, layout) = (&folded.target, &folded.layout);
    let net = Net::of(target, layout);
    let step = |face: usize| folded.steps.iter().rposition(|step| step.contains(&face)).map(|i| i + 1);
    let edges = net.edges.iter().map(|edge| Crease {
        vertices: edge.vertices,
        faces: edge.faces.clone(),
        angle: edge.angle,
        step: edge.faces.get(1).and_then(|face| step(*face)),
        glued: edge.glued,
    });
    let after = |done: usize| {
        let angles = folded.angles_after(done);
        net.vertices_at(target, layout, |face| angles[face]).iter().map(|v| [v.x, v.y, v.z]).collect()
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
