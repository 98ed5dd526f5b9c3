//! Lattices some of whose cells stand fast, among obstacles.

use crate::support::lattices::{block, judged_plan, plan_of, random_shape, stages, unit_cell};
use crate::support::recount_lattice::recount;
use modl::plan::file::{read, write};
use modl::plan::lattice::{peak_forces, time_lower_bound};
use modl::plan::{
    Anchor, Body, CheckKind, OperationError, Plan, Ratio, Run, Stages, joined, reversed, sliced,
};
use modl::planners::NoProgress;
use modl::planners::squeeze::{AnchorFault, Method, ModelChoice, Problem, Refusal, Settings, plan};

type Site = [i64; 3];

fn squeezed([start, goal, fixed, obstacles]: [&[Site]; 4], settings: &Settings) -> Result<Plan, Refusal> {
    let [start, goal, fixed, obstacles] = [start, goal, fixed, obstacles].map(<[Site]>::to_vec);
    let problem = Problem { fixed, obstacles, ..Problem::floating(unit_cell(), start, goal) };
    let solution = plan(&problem, settings, &mut NoProgress)?;
    assert_eq!((solution.report.method, solution.report.balanced), (Method::Push, false));
    let Body::Stages(stages) = solution.body else { panic!("it is a lattice") };
    Ok(plan_of(stages))
}

fn changed(plan: &Plan, change: impl FnOnce(&mut Stages)) -> Plan {
    let mut stages = stages(plan).clone();
    change(&mut stages);
    plan_of(stages)
}

/// Returns the kinds of checks that fail.
fn kinds(plan: &Plan) -> Vec<CheckKind> {
    judged_plan(plan).failures.iter().map(|failure| failure.kind).collect()
}

/// Returns the sites that the cells of a plan fill at a time, in ascending order, where they stand.
fn sites(plan: &Plan, time: f64) -> Vec<Site> {
    let mut sites: Vec<Site> = stages(plan)
        .state(time)
        .iter()
        .map(|cell| {
            assert_eq!(cell.size, [1.0; 3]);
            cell.center.map(|x| (x - 0.5) as i64)
        })
        .collect();
    sites.sort_unstable();
    sites
}

/// Checks a plan by the judge and by samples, and that it goes where it should, not up to a translation.
fn check(problem: [&[Site]; 4]) -> Plan {
    let found = squeezed(problem, &Settings::default()).expect("there is a way");
    let verdict = judged_plan(&found);
    assert!(verdict.ok(), "{:?}", verdict.failures);
    assert!(
        time_lower_bound(stages(&found), true).expect("they are few") <= verdict.duration * (1.0 + 1e-12)
    );
    let mut wrong = vec![];
    recount(&found, &mut wrong);
    assert_eq!(wrong, Vec::<String>::new());
    let sorted = |sites: &[Site]| {
        let mut sites = sites.to_vec();
        sites.sort_unstable();
        sites
    };
    assert_eq!(sites(&found, 0.0), sorted(problem[0]));
    assert_eq!(sites(&found, found.body.duration()), sorted(problem[1]));
    found
}

/// A row of five fixed cells with three on it, which slide along it by two.
fn sliding() -> Plan {
    let row = |xs: std::ops::Range<i64>, y: i64| xs.map(move |x| [x, y, 0]);
    let base: Vec<Site> = row(0..5, 0).collect();
    let with = |xs| base.iter().copied().chain(row(xs, 1)).collect::<Vec<Site>>();
    check([&with(0..3), &with(2..5), &base, &[[5, 1, 0], [-1, 1, 0]]])
}

#[test]
fn a_line_is_pushed_off_from_what_is_fixed() {
    let plan = sliding();
    // Two stages of 2 units, in which three cells accelerate at 1: the base holds three times a cell's force.
    let found = stages(&plan);
    assert_eq!(found.stages.iter().map(|stage| stage.time_squared).collect::<Vec<_>>(), [Ratio(4, 1); 2]);
    let verdict = judged_plan(&plan);
    assert!((verdict.dynamics.expect("a lattice has them").peak_force - 3.0).abs() < 1e-12);
    for (above, below) in peak_forces(found, true).expect("they are few") {
        assert_eq!(above, 12 * below, "the force times the square of the duration");
    }
    // Somewhere a cell goes by 2: in no less than 2 √2 units from rest to rest.
    assert!((time_lower_bound(found, true).expect("they are few") - 2.0 * 2.0_f64.sqrt()).abs() < 1e-12);
    // Centres of mass move: nothing that floats can do that.
    assert!(kinds(&changed(&plan, |stages| stages.anchor = None)).contains(&CheckKind::Momentum));
}

#[test]
fn the_judge_notices_what_moves_though_fixed_and_what_is_in_the_way() {
    let plan = sliding();
    let with_cells = |cells: &[u64]| {
        changed(&plan, |stages| stages.anchor.as_mut().expect("it has one").cells = cells.to_vec())
    };
    let moved =
        sites(&plan, 0.0).iter().position(|site| *site == [0, 1, 0]).expect("a cell that slides") as u64;
    let mut found = kinds(&with_cells(&[moved]));
    found.dedup();
    assert_eq!(found, [CheckKind::Momentum]);
    assert!(judged_plan(&with_cells(&[0])).ok(), "one of the fixed cells is enough");
    let with_obstacle = |center: [Ratio; 3], size: Ratio| {
        let run = Run { first: 0, counters: vec![], center, size: [size; 3] };
        changed(&plan, |stages| stages.anchor.as_mut().expect("it has one").obstacles = vec![run])
    };
    let half = Ratio(1, 2);
    // At a site that a cell comes to, beside it, and so that its corner is in the way or just not.
    for (x, y, size, free) in [
        (Ratio(9, 2), Ratio(3, 2), Ratio::ONE, false),
        (Ratio(11, 2), Ratio(3, 2), Ratio::ONE, true),
        (Ratio(9, 2), Ratio(5, 2), Ratio::ONE, true),
        (Ratio(9, 2), Ratio(5, 2), Ratio(1001, 1000), false),
        (Ratio(3, 2), Ratio(-1, 2), Ratio(1, 1), true),
        (Ratio(3, 2), Ratio(-1, 4), Ratio(1, 1), false),
    ] {
        let plan = with_obstacle([x, y, half], size);
        let expected: &[CheckKind] = if free { &[] } else { &[CheckKind::Collision] };
        let mut found = kinds(&plan);
        found.dedup();
        assert_eq!(found, expected, "{x:?} {y:?} {size:?}");
    }
    // Away from the plane of the cells nothing is in the way.
    assert!(judged_plan(&with_obstacle([half, Ratio(3, 2), Ratio(3, 2)], Ratio::ONE)).ok());
}

#[test]
fn a_tower_goes_to_the_other_side_of_a_wall_through_its_base() {
    // A block of three layers, whose lowest is fixed; a wall stands on it between the tower and its goal.
    let slab = block([7, 3, 1]);
    let with = |x: i64| [&slab[..], &[[x, 3, 0], [x, 4, 0]]].concat();
    let base: Vec<Site> = (0..7).map(|x| [x, 0, 0]).collect();
    let wall: Vec<Site> = (3..9).flat_map(|y| [-1, 0, 1].map(|z| [3, y, z])).collect();
    check([&with(2), &with(4), &base, &wall]);
}

/// Returns random cells that hang together around a core: `count` with those of the core.
fn grown(core: &[Site], dimensions: usize, count: usize, seed: &mut u64) -> Vec<Site> {
    let mut cells = core.to_vec();
    let mut left = random_shape(dimensions, false, seed, 4 * count);
    while cells.len() < count {
        let beside = |a: &Site, b: &Site| (0..3).map(|k| (a[k] - b[k]).abs()).sum::<i64>() == 1;
        let next = left.iter().position(|s| !cells.contains(s) && cells.iter().any(|c| beside(c, s)));
        cells.push(left.remove(next.expect("the random shape is large, and begins within the core")));
    }
    cells
}

#[test]
fn a_way_is_found_past_what_is_put_in_the_way() {
    let (core, mut seed, mut blocked) = (block([3, 2, 1]), 5, 0);
    for _ in 0..10 {
        let (start, goal) = (grown(&core, 2, 24, &mut seed), grown(&core, 2, 24, &mut seed));
        let free = check([&start, &goal, &core, &[]]);
        // A site that the plan uses on its way.
        let visited = stages(&free).instants().into_iter().flat_map(|t| stages(&free).state(t));
        let mut sites = visited.map(|cell| cell.center.map(|x| (x - 0.5).round() as i64));
        let Some(site) = sites.find(|site| !start.contains(site) && !goal.contains(site)) else { continue };
        let Ok(found) = squeezed([&start, &goal, &core, &[site]], &Settings::default()) else { continue };
        check([&start, &goal, &core, &[site]]);
        let wall = stages(&found).anchor.clone();
        assert!(kinds(&changed(&free, |stages| stages.anchor = wall)).contains(&CheckKind::Collision));
        blocked += 1;
    }
    assert!(blocked > 2, "{blocked}");
}

/// Random shapes that share a fixed core, with obstacles at random sites around.
#[test]
fn random_shapes_grow_around_a_fixed_core() {
    let (mut seed, mut found) = (1, 0);
    for round in 0..40 {
        let (dimensions, count) = (2 + round % 2, 12 + round);
        let core = block([3, 2, dimensions as i64 - 1]);
        let [start, goal] = [0, 1].map(|_| grown(&core, dimensions, count, &mut seed));
        let mut obstacles = random_shape(dimensions, true, &mut seed, 8);
        obstacles.iter_mut().for_each(|site| site[0] += 5);
        obstacles.retain(|site| !start.contains(site) && !goal.contains(site));
        let problem = [&start[..], &goal[..], &core[..], &obstacles[..]];
        match squeezed(problem, &Settings::default()) {
            Ok(_) => {
                check(problem);
                found += 1;
            }
            Err(refusal) => assert_eq!(refusal, Refusal::Anchor(AnchorFault::NoWay)),
        }
    }
    assert!(found >= 30, "{found} of 40");
}

#[test]
fn anchored_plans_are_written_reversed_cut_and_joined() {
    let plan = sliding();
    let text = write(&plan).expect("it can be written");
    assert!(text.contains("\"version\": 3") && text.contains("\"anchor\""));
    assert_eq!(read(&text).expect("what was written can be read"), plan);
    let back = reversed(&plan);
    assert!(judged_plan(&back).ok());
    assert_eq!(sites(&back, back.body.duration()), sites(&plan, 0.0));
    let half = sliced(&plan, 0.0, stages(&plan).instants()[1]).expect("between stages");
    assert!(judged_plan(&half).ok());
    let both = joined(&plan, &back).expect("the one ends as the other starts");
    assert!(judged_plan(&both).ok());
    assert_eq!(stages(&both).anchor, stages(&plan).anchor);
    // Another anchor, none, or other obstacles: the two are not one plan.
    let changes: [fn(&mut Stages); 3] = [
        |stages| stages.anchor = None,
        |stages| stages.anchor.as_mut().expect("it has one").cells.truncate(1),
        |stages| stages.anchor.as_mut().expect("it has one").obstacles.clear(),
    ];
    for change in changes {
        assert_eq!(joined(&plan, &changed(&back, change)), Err(OperationError::Surroundings));
    }
}

#[test]
fn anchors_that_make_no_sense_are_refused() {
    let anchor = |cells: &[u64], size: Ratio| {
        let run = Run { first: 0, counters: vec![], center: [Ratio(40, 1); 3], size: [size; 3] };
        Some(Anchor { cells: cells.to_vec(), obstacles: vec![run] })
    };
    let plan = sliding();
    for (anchor, balanced, says) in [
        (anchor(&[], Ratio::ONE), false, "the fixed cells must be some of the cells"),
        (anchor(&[1, 0], Ratio::ONE), false, "the fixed cells must be some of the cells"),
        (anchor(&[0, 0], Ratio::ONE), false, "the fixed cells must be some of the cells"),
        (anchor(&[8], Ratio::ONE), false, "the fixed cells must be some of the cells"),
        (anchor(&[0], Ratio::ZERO), false, "the size of an obstacle must be positive"),
        (anchor(&[0], Ratio(-1, 1)), false, "the size of an obstacle must be positive"),
        (anchor(&[0], Ratio(1, 0)), false, "no rational number"),
        (anchor(&[0], Ratio::ONE), true, "not balanced by itself"),
    ] {
        let plan = changed(&plan, |stages| {
            stages.anchor = anchor;
            stages.model.balanced = balanced;
        });
        let error = read(&write(&plan).expect("it can be written")).expect_err("it is refused");
        assert!(error.message.contains(says), "{error} should say {says}");
        assert_eq!(kinds(&plan), [CheckKind::Form]);
    }
}

#[test]
fn problems_whose_fixed_cells_and_obstacles_do_not_fit_are_refused() {
    let square = block([2, 2, 1]);
    let row = block([4, 1, 1]);
    let corner: &[Site] = &[[0, 0, 0]];
    let refused = |fixed: &[Site], obstacles: &[Site], settings: &Settings| match squeezed(
        [&square, &row, fixed, obstacles],
        settings,
    ) {
        Err(Refusal::Anchor(fault)) => fault,
        other => panic!("{other:?}"),
    };
    let auto = Settings::default();
    assert_eq!(refused(&[], &[[9, 9, 9]], &auto), AnchorFault::Floating);
    assert_eq!(refused(&[[9, 0, 0]], &[], &auto), AnchorFault::NotThere { site: [9, 0, 0], at_start: true });
    assert_eq!(refused(&[[1, 1, 0]], &[], &auto), AnchorFault::NotThere { site: [1, 1, 0], at_start: false });
    assert_eq!(
        refused(corner, &[[1, 1, 0]], &auto),
        AnchorFault::Occupied { site: [1, 1, 0], at_start: true }
    );
    assert_eq!(
        refused(corner, &[[3, 0, 0]], &auto),
        AnchorFault::Occupied { site: [3, 0, 0], at_start: false }
    );
    let fold = Settings { method: Method::Fold, ..auto.clone() };
    assert_eq!(refused(corner, &[], &fold), AnchorFault::Method(Method::Fold));
    let balanced = Settings { model: ModelChoice::Balanced, ..auto.clone() };
    assert_eq!(refused(corner, &[], &balanced), AnchorFault::Balanced);
    // All cells are fixed but one, which is walled in.
    let walls: Vec<Site> = [[2, 1, 0], [1, 2, 0], [1, 1, 1], [1, 1, -1]].to_vec();
    let ell: Vec<Site> = vec![[0, 0, 0], [1, 0, 0], [0, 1, 0]];
    let (start, goal) = ([&ell[..], &[[1, 1, 0]]].concat(), [&ell[..], &[[2, 0, 0]]].concat());
    let found = squeezed([&start, &goal, &ell, &walls], &auto);
    assert_eq!(found.expect_err("it is walled in"), Refusal::Anchor(AnchorFault::NoWay));
    // A plan without motion, and one of cells that keep their size.
    let still = check([&square, &square, corner, &[]]);
    assert_eq!(still.body.duration(), 0.0);
}
