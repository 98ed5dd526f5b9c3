//! A second look at plans of lattices: cells in floating point, at samples of each stage.

use modl::plan::{Body, CellBox, Law, Plan, Ratio, StageEnd};

/// The deviation that rounding explains, in cell sizes.
const SLACK: f64 = 1e-9;

/// Adds what is wrong with a plan of a lattice.
pub fn recount(plan: &Plan, found: &mut Vec<String>) {
    let Body::Stages(stages) = &plan.body else { return };
    let cell = &plan.library.cells[stages.cell];
    let number = |Ratio(a, b): Ratio| a as f64 / b as f64;
    let (smallest, unit) = (number(stages.limits.smallest), stages.time_unit);
    let fits = cell.size / unit / unit <= cell.force / cell.mass * (1.0 + 1e-6)
        && cell.shrinks_to <= smallest * cell.size * (1.0 + 1e-6)
        && number(stages.limits.speed_squared).sqrt() * cell.size / unit <= cell.speed * (1.0 + 1e-6);
    if !fits {
        found.push("the limits are not those of the cell".into());
    }
    let mut before = vec![None; stages.count as usize];
    place(&mut before, &stages.start);
    for stage in &stages.stages {
        let mut after = before.clone();
        advance(&mut after, &stage.end);
        let seconds = number(stage.time_squared).sqrt();
        let pairs: Vec<(CellBox, CellBox)> =
            before.iter().zip(&after).filter_map(|(a, b)| Some(((*a)?, (*b)?))).collect();
        if pairs.len() != before.len() {
            found.push("a cell is nowhere".into());
            return;
        }
        let (first, last) = ramps(stage.law);
        let top = 2.0 / (2.0 - first - last);
        let steepest = if first.min(last) > 0.0 { top / first.min(last) } else { top / first.max(last) };
        let most = |of: &dyn Fn(usize, &(CellBox, CellBox)) -> f64| {
            pairs.iter().flat_map(|pair| (0..3).map(move |axis| of(axis, pair))).fold(0.0, f64::max)
        };
        let shift = most(&|axis, (a, b)| (b.center[axis] - a.center[axis]).abs());
        let growth = most(&|axis, (a, b)| (b.size[axis] - a.size[axis]).abs());
        let moves = shift > SLACK || growth > SLACK;
        if moves && shift * steepest / seconds / seconds > 1.0 + 1e-6 {
            found.push(format!("{} accelerates too much", stage.name));
        }
        if moves && growth * top / seconds > number(stages.limits.speed_squared).sqrt() * (1.0 + 1e-6) {
            found.push(format!("{} resizes too fast", stage.name));
        }
        let drift =
            |axis: usize| pairs.iter().map(|(a, b)| b.center[axis] - a.center[axis]).sum::<f64>().abs();
        match &stages.anchor {
            None if (0..3).any(|axis| drift(axis) > 1e-6) => {
                found.push(format!("{} moves the centre of mass", stage.name));
            }
            Some(anchor)
                if anchor.cells.iter().any(|&cell| pairs[cell as usize].0 != pairs[cell as usize].1) =>
            {
                found.push(format!("{} moves what is fixed", stage.name));
            }
            _ => {}
        }
        let mut obstacles = vec![None; stages.obstacles().len()];
        place(&mut obstacles, stages.anchor.as_ref().map_or(&[][..], |anchor| &anchor.obstacles[..]));
        for k in 0..=6 {
            let u = f64::from(k) / 6.0;
            let now: Vec<CellBox> = pairs.iter().map(|(a, b)| between(a, b, u)).collect();
            if now
                .iter()
                .any(|cell| obstacles.iter().flatten().any(|o| (0..3).all(|k| overlap(cell, o, k) > 1e-7)))
            {
                found.push(format!("{} runs into an obstacle", stage.name));
            }
            crowd(&stage.name, &now, smallest, (k == 0 || k == 6, cell.slides), found);
        }
        before = after;
    }
}

fn ramps(law: Law) -> (f64, f64) {
    let number = |Ratio(a, b): Ratio| a as f64 / b as f64;
    match law {
        Law::BangBang => (0.5, 0.5),
        Law::Trapezoid(part) => (number(part), number(part)),
        Law::SpeedUp(part) => (number(part), 0.0),
        Law::SlowDown(part) => (0.0, number(part)),
    }
}

/// Sizes are in their range, no two cells overlap, and all hang together over faces; where cells do not slide, middle on
/// middle.
fn crowd(
    stage: &str,
    cells: &[CellBox],
    smallest: f64,
    (at_end, slides): (bool, bool),
    found: &mut Vec<String>,
) {
    if cells.iter().flat_map(|c| c.size).any(|s| !(smallest - SLACK..=1.0 + SLACK).contains(&s)) {
        found.push(format!("{stage}: a cell is too small or too large"));
    }
    let mut reached = vec![false; cells.len()];
    let mut open = vec![0];
    if !cells.is_empty() {
        reached[0] = true;
    }
    while let Some(i) = open.pop() {
        for j in 0..cells.len() {
            let by = [0, 1, 2].map(|axis| overlap(&cells[i], &cells[j], axis));
            let face = by.iter().filter(|o| o.abs() < 1e-7).count() == 1
                && by.iter().filter(|o| **o > 1e-7).count() == 2;
            let apart = |axis: usize| (cells[i].center[axis] - cells[j].center[axis]).abs();
            let face = face && (slides || (0..3).filter(|&axis| apart(axis) < 1e-7).count() == 2);
            if face && !reached[j] {
                reached[j] = true;
                open.push(j);
            }
        }
    }
    for (i, a) in cells.iter().enumerate() {
        if cells[i + 1..].iter().any(|b| (0..3).all(|axis| overlap(a, b, axis) > 1e-7)) {
            found.push(format!("{stage}: cells overlap"));
        }
    }
    // At finitely many instants the judge lets a lattice hang together over less.
    if !at_end && reached.contains(&false) {
        found.push(format!("{stage}: it falls apart"));
    }
}

/// Returns the length by which two cells overlap along an axis; negative for a gap.
fn overlap(a: &CellBox, b: &CellBox, axis: usize) -> f64 {
    (a.size[axis] + b.size[axis]) / 2.0 - (a.center[axis] - b.center[axis]).abs()
}

fn between(a: &CellBox, b: &CellBox, u: f64) -> CellBox {
    let mix = |x: [f64; 3], y: [f64; 3]| [0, 1, 2].map(|axis| x[axis] + (y[axis] - x[axis]) * u);
    CellBox { center: mix(a.center, b.center), size: mix(a.size, b.size) }
}

fn advance(cells: &mut [Option<CellBox>], end: &StageEnd) {
    let moves = match end {
        StageEnd::Runs(runs) => return place(cells, runs),
        StageEnd::Moves(moves) => moves,
    };
    let mut first = 0;
    for span in moves.cells.iter() {
        let (class, next) = (&moves.classes[span.class as usize], first + span.count as usize);
        for cell in cells[first..next].iter_mut().flatten() {
            for axis in 0..3 {
                let number = |Ratio(a, b): Ratio| a as f64 / b as f64;
                cell.center[axis] += number(class.displacement[axis]);
                cell.size[axis] += number(class.growth[axis]);
            }
        }
        first = next;
    }
}

fn place(cells: &mut [Option<CellBox>], runs: &[modl::plan::Run]) {
    for run in runs {
        let counts: Vec<u64> = run.counters.iter().map(|c| c.count).collect();
        for n in 0..counts.iter().product::<u64>() {
            let (mut rest, mut index) = (n, run.first as i64);
            let number = |Ratio(a, b): Ratio| a as f64 / b as f64;
            let (mut center, size) = (run.center.map(number), run.size.map(number));
            for counter in run.counters.iter().rev() {
                let k = rest % counter.count;
                rest /= counter.count;
                index += counter.stride * k as i64;
                for (c, step) in center.iter_mut().zip(counter.step) {
                    *c += number(step) * k as f64;
                }
            }
            cells[index as usize] = Some(CellBox { center, size });
        }
    }
}
