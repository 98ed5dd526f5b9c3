//! `save`: files in formats of others, by the end of their names.

use super::Native;
use super::plan::{output_path, write_output};
use super::rofi;
use crate::interpret::argument::parameters;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::plan_value::PlanValue;
use crate::interpret::record::Record;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;
use crate::planners::fold::{Net, Report};
use crate::view::{Crease, CreasePattern, fold_file};

pub const TABLE: &[Native] = &[Native::on_run("save", parameters![what: &Value, file: &str], save)];

fn save(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (path, name) = output_path(call, "file")?;
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    let bytes = match (call.arg("what"), ending) {
        (Value::Instance(_), "fold") | (Value::Record(_), "rofi" | "json") => {
            return Err(
                call.refuse("file", "a robot's name ends in `.rofi` or `.json`, a folding's in `.fold`")
            );
        }
        (Value::Record(record), _) => {
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
            if ending != "fold" {
                return Err(call.refuse("file", "the name of a folding's file ends in `.fold`"));
            }
            fold_file(&creases(planned, folded))
        }
        _ => match rofi::written(interpreter, call, ending)? {
            Some(text) => text,
            None => return Ok(Value::Unknown),
        },
    };
    write_output(interpreter, call.at("file"), &path, bytes.into_bytes())?;
    Ok(Value::Nothing)
}

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
