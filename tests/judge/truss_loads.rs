//! The judge on the forces, the rigidity and the slip of trusses, against statics done by hand.

use super::truss_judge::{plan_in, straight};
use crate::support::verdicts::status;
use modl::plan::{
    Body, CauseId, CheckKind, Exemption, ExemptionKind, Ground, NodePaths, Plan, Status, Verdict, World,
    verify,
};
use modl::robot::Library;
use std::sync::Arc;

type Place = [f64; 3];

/// Root of three quarters.
const HIGH: f64 = 0.866_025_403_784_438_6;
const A: Place = [0.0, 0.0, 0.0];
const B: Place = [1.0, 0.0, 0.0];
const C: Place = [0.5, HIGH, 0.0];
const TOP: Place = [0.5, HIGH / 3.0, 0.8];
const STANDING: World = World { gravity: 9.80665, ground: Ground::Settle, ..World::FREE };
const TETRA: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];

fn paths(plan: &mut Plan) -> &mut NodePaths {
    let Body::NodePaths(paths) = &mut plan.body else { unreachable!("a truss's plan") };
    paths
}

/// A tripod that rises a little, of struts that bear `force` (N); its plan may be excused from that.
fn tripod(force: f64, excused: bool, friction: f64) -> Verdict {
    let up = [0.5, HIGH / 3.0, 0.9];
    let world = World { friction, ..STANDING };
    let keyframes = vec![straight(0.0, &[A, B, C, TOP]), straight(10.0, &[A, B, C, up])];
    let mut plan = plan_in(world, &TETRA, keyframes);
    let mut library = Library::clone(&plan.library);
    library.struts[0].force = force;
    plan.library = Arc::new(library);
    let kind = ExemptionKind::Overload(None);
    let exemption = Exemption { kind, from: 0.0, to: 10.0, cause: CauseId(0) };
    plan.exemptions = excused.then_some(exemption).into_iter().collect();
    verify::verify(&plan)
}

/// The pressure in a leg of the tripod at its lowest: half of each of three struts of 1 kg is at the top, and three legs
/// carry that; where the legs are flattest they carry most.
fn leg() -> f64 {
    let weight = 1.5 * 9.80665;
    let length = libm::sqrt(0.8 * 0.8 + 1.0 / 3.0);
    weight / 3.0 * length / 0.8
}

#[test]
fn the_legs_of_a_tripod_carry_what_is_above_them() {
    let verdict = tripod(200.0, false, 1.0);
    assert_eq!(verdict.failures, vec![]);
    assert_eq!(status(&verdict, CheckKind::StrutLoad), Status::Sampled(3));
    // With friction the ground takes the thrust of the legs, which nothing but the top's equilibrium decides.
    let best = verdict.force_margin.expect("told");
    assert!((best.value - (1.0 - leg() / 200.0)).abs() < 1e-6, "{best:?}");
    assert_eq!(best.time, 0.0);
    let elastic = verdict.elastic_margin.expect("told");
    assert!((elastic.value - best.value).abs() < 1e-6, "{elastic:?}");
    // On ice the sides of the foot hold the legs together: each is the side of an equilateral triangle pulled outwards
    // by the thrust of a leg at each corner.
    let ice = tripod(200.0, false, 1e-9);
    assert_eq!(ice.failures, vec![]);
    let thrust = 1.5 * 9.80665 / 3.0 * (1.0 / libm::sqrt(3.0)) / 0.8;
    let side = thrust / libm::sqrt(3.0);
    let most = leg().max(side);
    assert!((ice.force_margin.expect("told").value - (1.0 - most / 200.0)).abs() < 1e-4);
}

#[test]
fn a_strut_too_weak_is_refused_with_what_the_path_needs_unless_it_is_excused() {
    let strong = tripod(leg() * 1.001, false, 1.0);
    assert_eq!(strong.failures, vec![]);
    let weak = tripod(leg() * 0.5, false, 1.0);
    let [failure] = &weak.failures[..] else { panic!("one failure: {:?}", weak.failures) };
    assert_eq!(failure.kind, CheckKind::StrutLoad);
    assert!(failure.message.contains("-- n3 would bear 6.04688N at 0ms"), "{}", failure.message);
    assert!((failure.value - 2.0).abs() < 1e-5, "{failure:?}");
    assert_eq!(status(&weak, CheckKind::StrutLoad), Status::Failed);
    let excused = tripod(leg() * 0.5, true, 1.0);
    assert_eq!(excused.failures, vec![]);
    assert!((excused.force_margin.as_ref().expect("told").value + 1.0).abs() < 1e-5);
    assert_eq!(status(&excused, CheckKind::StrutLoad), Status::Exempt);
    assert_eq!(excused.unneeded_exemptions, Vec::<usize>::new());
    assert!(excused.notes.iter().any(|note| note.contains("bears 6.04688N")), "{:?}", excused.notes);
    // An exemption that nothing needs is told.
    assert_eq!(tripod(200.0, true, 1.0).unneeded_exemptions, [0]);
}

/// The tripod is lowest, and its legs bear most, at the start of either half; only the first is excused.
#[test]
fn an_excuse_holds_for_its_own_time() {
    let low = [0.5, HIGH / 3.0, 0.75];
    let places = [(0.0, TOP), (10.0, low), (20.0, TOP)];
    let keyframes = places.map(|(time, top)| straight(time, &[A, B, C, top])).to_vec();
    let mut plan = plan_in(STANDING, &TETRA, keyframes);
    let mut library = Library::clone(&plan.library);
    library.struts[0].force = leg() * 0.9;
    plan.library = Arc::new(library);
    let kind = ExemptionKind::Overload(None);
    plan.exemptions = vec![Exemption { kind, from: 0.0, to: 12.0, cause: CauseId(0) }];
    let verdict = verify::verify(&plan);
    let [failure] = &verdict.failures[..] else { panic!("one failure: {:?}", verdict.failures) };
    assert_eq!(failure.time, 15.0, "{failure:?}");
    assert!(verdict.force_margin.expect("told").time == 10.0);
}

/// A mast on the tripod whose three struts come to lie in one plane: nothing holds it across.
#[test]
fn a_node_that_nothing_holds_is_refused() {
    let out = |y: f64| [0.5, 0.493 + y, 1.364];
    // The plane of the nodes 0, 1 and 3 meets the mast at this y.
    let flat = HIGH / 3.0 * 1.364 / 0.8 - 0.493;
    let struts = [&TETRA[..], &[(4, 0), (4, 1), (4, 3)]].concat();
    let keyframes =
        |to: f64| vec![straight(0.0, &[A, B, C, TOP, out(-0.3)]), straight(100.0, &[A, B, C, TOP, out(to)])];
    let held = verify::verify(&plan_in(STANDING, &struts, keyframes(-0.25)));
    assert_eq!(held.failures, vec![]);
    assert!(held.rigidity.expect("told").value > 0.05);
    let lost = verify::verify(&plan_in(STANDING, &struts, keyframes(flat)));
    let kinds: Vec<CheckKind> = lost.failures.iter().map(|failure| failure.kind).collect();
    assert!(
        kinds.contains(&CheckKind::Rigidity) && kinds.contains(&CheckKind::Stability),
        "{:?}",
        lost.failures
    );
    for failure in &lost.failures {
        assert_eq!(failure.at, ["n4"], "{failure:?}");
    }
    assert!(lost.rigidity.expect("told").value < 1e-6);
}

#[test]
fn slip_has_a_limit_where_a_plan_keeps_one() {
    let aside = |p: Place| [p[0] + 0.2, p[1], p[2]];
    let slid = |slip: f64| {
        let places = [A, B, C, TOP];
        let keyframes = vec![straight(0.0, &places), straight(100.0, &places.map(aside))];
        let mut plan = plan_in(STANDING, &TETRA, keyframes);
        paths(&mut plan).limits.slip = slip;
        verify::verify(&plan)
    };
    // Three feet slide by 0.2 m each.
    assert_eq!(slid(0.601).failures, vec![]);
    assert_eq!(status(&slid(0.601), CheckKind::Slip), Status::Proved);
    let far = slid(0.599);
    assert_eq!(far.failures.iter().map(|f| f.kind).collect::<Vec<_>>(), [CheckKind::Slip]);
    assert!((far.failures[0].value - 0.6).abs() < 1e-9);
}
