//! The data of a lattice plan in a page: runs and moves of cells as they are in the plan.

use super::number::{list, number};
use crate::plan::{Moves, Ratio, Run, StageEnd, Stages};
use crate::robot::Library;
use serde_json::{Value, json};

/// Returns the stages, start cells and laws of a lattice plan as JSON: the size of a cell in metres, durations in
/// seconds, places as runs or moves of cells as they are in the plan.
pub(super) fn body(stages: &Stages, library: &Library) -> Value {
    let cell = library.cells.get(stages.cell);
    let stage = |stage: &crate::plan::Stage| {
        let (first, last) = stage.law.ramps();
        let (key, end) = match &stage.end {
            StageEnd::Runs(list) => ("end", Value::from(runs(list))),
            StageEnd::Moves(list) => ("moves", moves(list)),
        };
        json!({
            "name": stage.name,
            "duration": number(stage.duration() * stages.time_unit),
            "law": [number(first.to_f64()), number(last.to_f64())],
            key: end,
            "cause": stage.cause.0,
        })
    };
    json!({
        "form": "stages",
        "cell": cell.map_or("cell", |cell| cell.name.as_str()),
        "size": number(cell.map_or(1.0, |cell| cell.size)),
        "count": stages.count,
        "obstacles": stages.anchor.as_ref().map_or_else(Vec::new, |anchor| runs(&anchor.obstacles)),
        "start": runs(&stages.start),
        "stages": stages.stages.iter().map(stage).collect::<Vec<_>>(),
    })
}

/// Returns runs as `[first, [[count, stride, dx, dy, dz], ...], centre, size]`, in cell sizes.
fn runs(runs: &[Run]) -> Vec<Value> {
    let ratios = |r: &[Ratio; 3]| list(r.iter().map(|r| r.to_f64()));
    let run = |run: &Run| {
        let counters = run.counters.iter().map(|c| {
            let [x, y, z] = c.step.map(|r| number(r.to_f64()));
            json!([c.count, c.stride, x, y, z])
        });
        json!([run.first, counters.collect::<Vec<_>>(), ratios(&run.center), ratios(&run.size)])
    };
    runs.iter().map(run).collect()
}

/// Returns moves as `[classes, spans]`: of each class `[dx, dy, dz, growth along x, y, z]`, in cell sizes, and of each
/// span of cells `[class, count]`, or the class alone of one cell. Nothing is rounded, for moves add up.
fn moves(moves: &Moves) -> Value {
    let exact = |ratio: Ratio| if ratio.1 == 1 { json!(ratio.0) } else { json!(ratio.to_f64()) };
    let classes = moves.classes.iter().map(|class| class.ratios().map(exact).collect::<Vec<_>>());
    let span = |class: u32, count: u32| if count == 1 { json!(class) } else { json!([class, count]) };
    let spans = moves.cells.iter().map(|s| span(s.class, s.count));
    json!([classes.collect::<Vec<_>>(), spans.collect::<Vec<_>>()])
}
