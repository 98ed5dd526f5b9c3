//! Histories of long plans: evenly thinned out, to the end, also of plans that the judge refuses for their samples.

use crate::support::arms::robot_of;
use crate::support::motions::{Motion, STATICS};
use crate::support::robots::{boxed, joint, link};
use modl::geometry::{Pose, Vec3};
use modl::plan::verify::articulated::{CONTACTS_MAX, MOMENTS_MAX, history};
use modl::plan::verify::verify;
use modl::plan::{CheckKind, Plan};
use modl::robot::{JointKind, Limits};

/// Returns a plan of a block on the ground whose weight slides to and fro along x, once a second.
fn to_and_fro(seconds: usize) -> Plan {
    let block = vec![boxed(Vec3::new(-0.1, -0.1, 0.0), Vec3::new(0.1, 0.1, 0.1))];
    let weight = vec![boxed(Vec3::new(-0.01, -0.01, 0.2), Vec3::new(0.01, 0.01, 0.22))];
    let links = vec![
        link("block", block, 1.0, Vec3::z() * 0.05, 0.5),
        link("weight", weight, 1.0, Vec3::z() * 0.21, 0.5),
    ];
    let range = Limits { range: Some((-1.0, 1.0)), ..Limits::default() };
    let slide = joint("slide", (0, 1), JointKind::Prismatic, Pose::identity(), Vec3::x(), range);
    let mut motion = Motion::new(robot_of(links, vec![slide]));
    for second in 0..seconds {
        let begin = second as f64;
        motion = motion.segment(0, begin, begin + 1.0, vec![0.0, 0.05, 0.0]);
    }
    motion.plan(STATICS)
}

/// Returns the position of the weight at a time (s), from the middle, m: that of the centre of mass is half of it.
fn slid(time: f64) -> f64 {
    let part = time - libm::floor(time);
    2.0 * part * (1.0 - part) * 0.05
}

#[test]
fn a_history_is_even_and_goes_to_the_end() {
    for (seconds, until, sample) in
        [(50, 50.0, 0.01), (50, 50.0, 0.005), (50, 30.005, 0.005), (10, 9.99, 0.001)]
    {
        let mut plan = to_and_fro(seconds);
        plan.settings.sample = sample;
        let moments = history(&plan, until);
        assert!(moments.len() > MOMENTS_MAX / 2 - 1 && moments.len() <= MOMENTS_MAX + 1, "{}", moments.len());
        let (first, last) = (&moments[0], &moments[moments.len() - 1]);
        assert_eq!(first.time, 0.0);
        assert!((last.time - until).abs() < sample, "{} of {until}", last.time);
        // One in so many samples is kept, and the last.
        let stride = moments[1].time - first.time;
        for pair in moments.windows(2) {
            let step = pair[1].time - pair[0].time;
            assert!(step > 0.0 && step <= stride * (1.0 + 1e-6), "{} after {}", pair[1].time, pair[0].time);
        }
        for moment in &moments {
            let centre = slid(moment.time) / 2.0;
            assert!((moment.centre.x - moment.base.translation.x - centre).abs() < 1e-9, "{moment:?}");
            assert!((moment.margin.expect("it stands") - (0.1 - centre)).abs() < 1e-9, "{moment:?}");
            assert!(moment.contacts.len() <= CONTACTS_MAX && moment.support.len() == 4);
        }
    }
}

/// A plan of more samples than are allowed is refused, and still seen at some to its end.
#[test]
fn a_plan_that_is_refused_for_its_samples_has_a_history_to_its_end() {
    let mut plan = to_and_fro(20);
    (plan.settings.sample, plan.settings.samples_max) = (0.001, 5000);
    let verdict = verify(&plan);
    assert_eq!(verdict.failures.iter().map(|failure| failure.kind).collect::<Vec<_>>(), [CheckKind::Form]);
    let moments = history(&plan, 20.0);
    assert!(moments.len() > 1000 && moments.len() <= MOMENTS_MAX + 1, "{}", moments.len());
    assert!((moments[moments.len() - 1].time - 20.0).abs() < 1e-9);
}
