//! Stages that state moves in classes: the same motion as with the position of every cell, in all that plans are for.

use crate::support::lattices::{
    PAPER, TERMS, judged_plan, plan_of, random_shape, stages, stages_of, unit_cell,
};
use crate::support::recount_lattice::recount;
use modl::plan::file::{read, schema, write};
use modl::plan::lattice::{end_shapes, peak_forces, time_lower_bound};
use modl::plan::{
    Body, CellMove, CellSpan, CheckKind, Moves, OperationError, Plan, Ratio, Run, StageEnd, Stages, joined,
    reversed, sliced,
};
use modl::planners::NoProgress;
use modl::planners::squeeze::{Method, Problem, Settings, melt, plan, to_row};

/// Returns the sum of two rational numbers.
fn sum(a: Ratio, b: Ratio) -> Ratio {
    let product = |x: i64, y: i64| i128::from(x) * i128::from(y);
    Ratio::new(product(a.0, b.1) + product(b.0, a.1), product(a.1, b.1)).expect("it fits 64 bits")
}

/// Returns centre and size of every cell of runs, by number.
fn listed(runs: &[Run], cells: &mut [[Ratio; 6]]) {
    for run in runs {
        for k in 0..run.count() {
            let (mut rest, mut index, mut center) = (k, run.first as i64, run.center);
            for counter in run.counters.iter().rev() {
                let at = (rest % counter.count) as i64;
                rest /= counter.count;
                index += at * counter.stride;
                for (c, step) in center.iter_mut().zip(counter.step) {
                    *c = sum(*c, step.times(Ratio(at, 1)).expect("it fits 64 bits"));
                }
            }
            let [x, y, z] = center;
            let [a, b, c] = run.size;
            cells[index as usize] = [x, y, z, a, b, c];
        }
    }
}

/// Returns the same stages with the position of every cell at the end of each, added up as fractions.
fn with_positions(stages: &Stages) -> Stages {
    let mut cells = vec![[Ratio::ZERO; 6]; stages.count as usize];
    listed(&stages.start, &mut cells);
    let mut same = stages.clone();
    for stage in &mut same.stages {
        match &stage.end {
            StageEnd::Runs(runs) => listed(runs, &mut cells),
            StageEnd::Moves(moves) => {
                let spans = moves.cells.iter().flat_map(|s| std::iter::repeat_n(s.class, s.count as usize));
                for (cell, class) in cells.iter_mut().zip(spans) {
                    let CellMove { displacement: [x, y, z], growth: [a, b, c] } =
                        moves.classes[class as usize];
                    [x, y, z, a, b, c].into_iter().zip(cell).for_each(|(by, at)| *at = sum(*at, by));
                }
            }
        }
        let run = |(i, [x, y, z, a, b, c]): (usize, &[Ratio; 6])| Run {
            first: i as u64,
            counters: vec![],
            center: [*x, *y, *z],
            size: [*a, *b, *c],
        };
        stage.end = StageEnd::Runs(cells.iter().enumerate().map(run).collect());
    }
    same
}

/// Returns centre and size of every cell between the stages of a plan, and at both ends.
fn configurations(plan: &Plan) -> Vec<Vec<[Ratio; 6]>> {
    let same = with_positions(stages(plan));
    let mut cells = vec![[Ratio::ZERO; 6]; same.count as usize];
    listed(&same.start, &mut cells);
    let mut all = vec![cells.clone()];
    for stage in &same.stages {
        let StageEnd::Runs(runs) = &stage.end else { panic!("it states positions") };
        listed(runs, &mut cells);
        all.push(cells.clone());
    }
    all
}

/// Returns the first moves that stages state.
fn moves(stages: &mut Stages) -> &mut Moves {
    let found = stages.stages.iter_mut().find_map(|stage| match &mut stage.end {
        StageEnd::Moves(moves) => Some(moves),
        StageEnd::Runs(_) => None,
    });
    found.expect("a stage states moves")
}

/// Returns a plan from one random shape to another in a plane.
fn squeezed(seed: u64, count: usize, method: Method) -> Plan {
    let mut seed = seed;
    let mut shape = || random_shape(2, false, &mut seed, count);
    let problem = Problem::floating(unit_cell(), shape(), shape());
    let settings = Settings { method, ..Settings::default() };
    let solution = plan(&problem, &settings, &mut NoProgress).expect("there is a way");
    let Body::Stages(stages) = solution.body else { panic!("it is a lattice") };
    plan_of(stages)
}

/// Returns plans of several methods whose stages state moves.
fn plans() -> Vec<Plan> {
    let solid: Vec<[i64; 3]> = random_shape(3, true, &mut 4, 24);
    let flat: Vec<[i64; 2]> = random_shape(2, true, &mut 5, 40).iter().map(|p| [p[0], p[1]]).collect();
    vec![
        squeezed(1, 30, Method::Merge),
        squeezed(2, 40, Method::Push),
        squeezed(3, 25, Method::Auto),
        plan_of(stages_of(melt(TERMS, &solid, |i| i).expect("it melts"), PAPER)),
        plan_of(stages_of(to_row(TERMS, &flat, |i| i).expect("it merges").reversed(), PAPER)),
        plan_of(stages_of(to_row(TERMS, &flat, |i| i).expect("it merges").turned([2, 0, 1]), PAPER)),
    ]
}

#[test]
fn moves_are_judged_as_positions_are() {
    for plan in plans() {
        let some = stages(&plan).stages.iter().filter(|stage| matches!(stage.end, StageEnd::Moves(_)));
        assert!(some.count() > 2, "the plan states moves");
        let same = with_positions(stages(&plan));
        assert_eq!(end_shapes(stages(&plan)), end_shapes(&same));
        assert_eq!(peak_forces(stages(&plan), true), peak_forces(&same, true));
        assert_eq!(time_lower_bound(stages(&plan), true), time_lower_bound(&same, true));
        let verdict = judged_plan(&plan);
        assert!(verdict.ok(), "{:?}", verdict.failures);
        assert_eq!(verdict, judged_plan(&plan_of(same)));
        let mut found = vec![];
        recount(&plan, &mut found);
        assert_eq!(found, Vec::<String>::new());
    }
}

#[test]
fn cells_are_at_the_same_places_at_all_times() {
    for plan in plans() {
        let same = with_positions(stages(&plan));
        let end = same.duration();
        for i in 0..=40 {
            let t = end * f64::from(i) / 40.0;
            for (a, b) in stages(&plan).state(t).iter().zip(same.state(t)) {
                let near = |axis: usize| {
                    (a.center[axis] - b.center[axis]).abs() < 1e-9
                        && (a.size[axis] - b.size[axis]).abs() < 1e-9
                };
                assert!((0..3).all(near), "at {t}");
            }
        }
    }
}

#[test]
fn plans_with_moves_are_reversed_cut_and_joined_exactly() {
    for plan in plans() {
        let back = reversed(&plan);
        assert!(judged_plan(&back).ok());
        let (start, end) = end_shapes(stages(&plan)).expect("whole places");
        assert_eq!(end_shapes(stages(&back)), Ok((end, start)));
        assert!(configurations(&reversed(&back)) == configurations(&plan));
        // At every third border between stages, but the end, which times in ticks may miss.
        let instants = stages(&plan).instants();
        for &t in instants[..instants.len() - 1].iter().step_by(3) {
            let first = sliced(&plan, 0.0, t).expect("between stages");
            let second = sliced(&plan, t, plan.body.duration()).expect("between stages");
            assert!(judged_plan(&second).ok());
            let both = joined(&first, &second).expect("the one ends as the other starts");
            assert!(configurations(&both) == configurations(&plan));
        }
        let there_and_back = joined(&plan, &back).expect("the one ends as the other starts");
        assert!(judged_plan(&there_and_back).ok());
    }
}

#[test]
fn cells_of_joined_plans_take_the_numbers_of_the_first() {
    let plan = squeezed(6, 30, Method::Merge);
    // The way back with its cells numbered from the end.
    let mut other = reversed(&plan);
    let Body::Stages(renumbered) = &mut other.body else { panic!("it is a lattice") };
    let last = renumbered.count - 1;
    let turn = |runs: &mut Vec<Run>| {
        for run in runs {
            run.first = last - run.first;
            run.counters.iter_mut().for_each(|counter| counter.stride = -counter.stride);
        }
    };
    turn(&mut renumbered.start);
    for stage in &mut renumbered.stages {
        match &mut stage.end {
            StageEnd::Runs(runs) => turn(runs),
            StageEnd::Moves(moves) => {
                moves.cells = moves.cells.iter().rev().copied().collect();
            }
        }
    }
    assert!(judged_plan(&other).ok());
    let both = joined(&plan, &other).expect("the one ends as the other starts");
    assert!(judged_plan(&both).ok());
    let same = joined(&plan, &reversed(&plan)).expect("the one ends as the other starts");
    assert!(configurations(&both) == configurations(&same));
}

#[test]
fn moves_survive_the_file_and_only_they_need_its_version() {
    let validator = jsonschema::validator_for(&schema()).expect("the schema is one");
    for plan in plans() {
        let text = write(&plan).expect("it can be written");
        assert!(text.contains("\"version\": 3"));
        assert_eq!(read(&text).expect("what was written can be read"), plan);
        let value: serde_json::Value = serde_json::from_str(&text).expect("it is JSON");
        assert!(validator.is_valid(&value));
        // Files of before state positions, and have a version that tools of before know.
        let before = plan_of(with_positions(stages(&plan)));
        let text = write(&before).expect("it can be written");
        assert!(text.contains("\"version\": 2") && !text.contains("\"moves\""));
        assert_eq!(read(&text).expect("what was written can be read"), before);
    }
}

#[test]
fn a_span_of_one_cell_is_its_class_alone() {
    let plan = squeezed(7, 30, Method::Merge);
    let value: serde_json::Value =
        serde_json::from_str(&write(&plan).expect("it can be written")).expect("JSON");
    let list = value["body"]["stages"]["stages"].as_array().expect("a list");
    let spans = list.iter().filter_map(|stage| stage["moves"]["cells"].as_array()).flatten();
    let mut kinds = [0, 0];
    for span in spans {
        match span.as_array() {
            None => kinds[0] += usize::from(span.is_u64()),
            Some(pair) => {
                assert!(pair.len() == 2 && pair[1].as_u64() > Some(1), "{span}");
                kinds[1] += 1;
            }
        }
    }
    assert!(kinds.iter().all(|&count| count > 0), "{kinds:?}");
}

/// Each change of the moves, and words of the error.
type Harm = (fn(&mut Moves), &'static str);

#[test]
fn moves_that_make_no_sense_are_refused() {
    let harms: [Harm; 7] = [
        (|m| m.cells = m.cells[1..].into(), "of 29 cells: there are 30"),
        (|m| m.cells = [&m.cells[..], &[CellSpan { class: 0, count: 1 }]].concat().into(), "of 31 cells"),
        (|m| m.cells = vec![CellSpan { class: 99, count: 30 }].into(), "of class 99 of"),
        (
            |m| m.cells = [&m.cells[..], &[CellSpan { class: 0, count: 0 }]].concat().into(),
            "a span of no cells",
        ),
        (|m| m.classes[0].growth[1] = Ratio(1, 0), "no rational number"),
        (|m| m.classes[0].displacement[0] = Ratio(1, 1 << 45), "too fine to be judged exactly"),
        (|m| m.classes[0].displacement[0] = Ratio(i64::MIN, 1), "too far apart"),
    ];
    for (harm, says) in harms {
        let mut plan = squeezed(8, 30, Method::Merge);
        let Body::Stages(stages) = &mut plan.body else { panic!("it is a lattice") };
        // The first span is one cell, so that the first harm takes away one.
        let first = moves(stages);
        let mut spans: Vec<CellSpan> = first.cells.to_vec();
        if spans[0].count > 1 {
            spans[0].count -= 1;
            spans.insert(0, CellSpan { count: 1, ..spans[0] });
            first.cells = spans.into();
        }
        harm(moves(stages));
        let text = write(&plan).expect("it can be written");
        let error = read(&text).expect_err("it is refused");
        assert!(error.message.contains(says), "{error} should say {says}");
        assert!(!judged_plan(&plan).ok());
    }
    let text = write(&squeezed(8, 30, Method::Merge)).expect("it can be written");
    for (from, to, says) in [
        (
            "\"moves\": {",
            "\"end\": [], \"moves\": {",
            "either the positions of cells, `end`, or their `moves`",
        ),
        ("\"moves\": {", "\"more\": {", "unknown field `more`"),
        ("}], \"cells\": [", "}], \"cells\": [-1, ", "did not match"),
        ("}], \"cells\": [", "}], \"cells\": [[1, 2, 3], ", "did not match"),
        ("\"displacement\": [", "\"displacement\": [0, ", ""),
    ] {
        assert!(text.contains(from));
        let error = read(&text.replacen(from, to, 1)).expect_err("it is refused");
        assert!(error.message.contains(says), "{error} should say {says}");
    }
}

#[test]
fn cells_in_the_wrong_class_are_noticed() {
    let plan = squeezed(9, 30, Method::Merge);
    for at in 0..stages(&plan).stages.len() {
        let mut harmed = stages(&plan).clone();
        let StageEnd::Moves(moves) = &mut harmed.stages[at].end else { continue };
        let mut spans: Vec<CellSpan> = moves.cells.to_vec();
        // A cell that moves as another class does takes the centre of mass with it.
        let last = spans.last_mut().expect("there are cells");
        let displacement = |class: u32| moves.classes[class as usize].displacement;
        let others = 0..moves.classes.len() as u32;
        let Some(other) = others.into_iter().find(|&other| displacement(other) != displacement(last.class))
        else {
            continue;
        };
        *last = CellSpan { class: other, ..*last };
        moves.cells = spans.into();
        let verdict = judged_plan(&plan_of(harmed));
        assert!(!verdict.ok(), "stage {at}");
    }
    // A stage whose centre of mass drifts: the recoil of one class is left out.
    let mut harmed = stages(&plan).clone();
    moves(&mut harmed).classes[0].displacement = [Ratio(1, 7); 3];
    let verdict = judged_plan(&plan_of(harmed));
    assert!(
        verdict.failures.iter().any(|failure| failure.kind == CheckKind::Momentum),
        "{:?}",
        verdict.failures
    );
}

#[test]
fn a_plan_is_not_cut_within_a_stage_of_moves() {
    let plan = squeezed(10, 30, Method::Merge);
    let found = sliced(&plan, 0.0, stages(&plan).instants()[1] / 2.0);
    assert!(matches!(found, Err(OperationError::InsideStage { .. })));
}

/// Few displacements occur, whatever the shapes: so a file has a few bytes for each cell and stage, not a position.
#[test]
fn files_of_irregular_shapes_are_short() {
    let plan = squeezed(11, 1000, Method::Merge);
    let (text, count) = (write(&plan).expect("it can be written"), stages(&plan).stages.len());
    let each = text.len() as f64 / 1000.0 / count as f64;
    assert!(each < 5.0, "{each:.1} bytes a cell and stage");
    let positions = write(&plan_of(with_positions(stages(&plan)))).expect("it can be written");
    assert!(
        positions.len() > 20 * text.len(),
        "{} bytes with positions, {} with moves",
        positions.len(),
        text.len()
    );
}
