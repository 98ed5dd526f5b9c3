//! The base pose, support and contacts of the robot on the ground over time: from the judge's rollout,
//! thinned to what is visible.

use super::number::{list, number, place};
use super::tolerances::TOLERANCES;
use crate::geometry::Pose;
use crate::plan::verify::articulated::{self, Moment};
use serde_json::{Value, json};

/// The most base poses that one linear piece replaces.
const RUN_MAX: usize = 64;

/// The most load ratios in one page.
const LOADS_MAX: usize = 40_000;

/// The most contact points in one page.
const CONTACTS_MAX: usize = 20_000;

/// The most moments with a support polygon in one page.
const SUPPORTS_MAX: usize = 500;

/// Returns base poses (`X_WB`) as `[time, x, y, z, qx, qy, qz, qw]`, in seconds and metres, in order of time; poses
/// between them are linear in these numbers. Alone stands the start pose if the plan has no rollout.
pub(super) fn base(moments: &[Moment], start: &Pose) -> Value {
    let poses: Vec<(f64, Pose)> = moments.iter().map(|moment| (moment.time, moment.base)).collect();
    if poses.is_empty() { path(&[(0.0, *start)]) } else { path(&poses) }
}

/// Returns poses at times (s) in the form of [`base`].
pub(super) fn path(poses: &[(f64, Pose)]) -> Value {
    let key = |(time, pose): &(f64, Pose)| {
        let (p, q) = (pose.translation.vector, pose.rotation);
        list([*time, p.x, p.y, p.z, q.i, q.j, q.k, q.w])
    };
    Value::Array(kept(poses).into_iter().map(|i| key(&poses[i])).collect())
}

/// Returns the indices of the poses between which linear interpolation is within tolerance, the first and the last
/// among them.
fn kept(poses: &[(f64, Pose)]) -> Vec<usize> {
    let mut kept = vec![0];
    let mut from = 0;
    for to in 1..poses.len() {
        let straight = to - from <= RUN_MAX && (from + 1..to).all(|i| between(poses, from, to, i));
        if !straight {
            from = to - 1;
            kept.push(from);
        }
    }
    if poses.len() > 1 {
        kept.push(poses.len() - 1);
    }
    kept
}

/// Returns true if pose `i` is within tolerance of the line between two others.
fn between(poses: &[(f64, Pose)], from: usize, to: usize, i: usize) -> bool {
    let numbers = |at: usize| {
        let (p, q) = (poses[at].1.translation.vector, poses[at].1.rotation);
        [p.x, p.y, p.z, q.i, q.j, q.k, q.w]
    };
    let (a, b, c) = (numbers(from), numbers(to), numbers(i));
    let whole = poses[to].0 - poses[from].0;
    let part = if whole > 0.0 { (poses[i].0 - poses[from].0) / whole } else { 0.0 };
    let sign = if (3..7).map(|k| a[k] * b[k]).sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
    let near = |k: usize| {
        let end = if k < 3 { b[k] } else { sign * b[k] };
        let line = a[k] + (end - a[k]) * part;
        let same = (line - c[k]).abs() <= TOLERANCES.base;
        same || (k >= 3 && (line + c[k]).abs() <= TOLERANCES.base)
    };
    (0..7).all(near)
}

/// Returns `[time, x, y, z of the centre of mass, margin or null, held, corners]` of moments in order of time, in
/// seconds and metres in the world, thinned to about [`SUPPORTS_MAX`]. The corners are those of the support polygon as
/// `[x, y, x, y, ...]`, counter-clockwise from above; `held` is as in [`Moment::held`].
pub(super) fn supports(moments: &[Moment]) -> Vec<Value> {
    let stride = moments.len().div_ceil(SUPPORTS_MAX).max(1);
    let last = moments.len().saturating_sub(1);
    let chosen = moments.iter().enumerate().filter(|(i, _)| i % stride == 0 || *i == last);
    chosen
        .map(|(_, m)| {
            let margin = m.margin.map_or(Value::Null, number);
            let corners = list(m.support.iter().flatten().map(|x| place(*x)));
            let [x, y, z] = [m.centre.x, m.centre.y, m.centre.z].map(number);
            json!([number(m.time), x, y, z, margin, m.held, corners])
        })
        .collect()
}

/// Returns `[time, [x, y, x, y, ...]]` of the points that touch the ground, in seconds and metres in the world, for
/// each moment at which they differ from those before; and true if some moment has as many as the judge's limit of
/// contacts, so that others may be left out.
pub(super) fn contacts(moments: &[Moment]) -> (Vec<Value>, bool) {
    let most = moments.iter().map(|m| m.contacts.len()).max().unwrap_or(0);
    let afforded = CONTACTS_MAX / most.max(1);
    let stride = moments.len().div_ceil(afforded.max(1)).max(1);
    let mut changes: Vec<Value> = Vec::new();
    let mut last: Option<&[[f64; 2]]> = None;
    for moment in moments.iter().step_by(stride) {
        if last.is_some_and(|last| same(last, &moment.contacts)) {
            continue;
        }
        last = Some(&moment.contacts);
        changes.push(json!([number(moment.time), list(moment.contacts.iter().flatten().map(|x| place(*x)))]));
    }
    (changes, most >= articulated::CONTACTS_MAX)
}

/// Returns true if two sets of points are equal within tolerance.
fn same(a: &[[f64; 2]], b: &[[f64; 2]]) -> bool {
    let near =
        |(p, q): (&[f64; 2], &[f64; 2])| p.iter().zip(q).all(|(x, y)| (x - y).abs() <= TOLERANCES.base);
    a.len() == b.len() && a.iter().zip(b).all(near)
}

/// Returns a curve in millimetres, `[[time, value], ...]`, from points (time in s, value in m) in order of time;
/// `least`, such a point too, is inserted at its time, `None` for none.
pub(super) fn curve(mut points: Vec<(f64, f64)>, least: Option<(f64, f64)>) -> Vec<Value> {
    if let Some(least) = least.filter(|_| !points.is_empty()) {
        let at = points.partition_point(|(time, _)| *time <= least.0);
        points.insert(at, least);
    }
    points.iter().map(|(time, value)| json!([number(*time), number(value * 1e3)])).collect()
}

/// Returns `{joints, moments: [[time, [ratio, ...]], ...]}`: the load of each joint as a fraction of its limit (1 is
/// the limit), in the order of `joints`, at so many moments that a page holds them. `joints` are the numbers of the
/// joints as in their `JointId`, ascending. Null if no load is known.
pub(super) fn loads(moments: &[Moment]) -> Value {
    let weighed: Vec<&Moment> = moments.iter().filter(|m| !m.loads.is_empty()).collect();
    let mut joints: Vec<usize> =
        weighed.iter().flat_map(|m| m.loads.iter().map(|(joint, _)| *joint)).collect();
    joints.sort_unstable();
    joints.dedup();
    if joints.is_empty() {
        return Value::Null;
    }
    let stride = (weighed.len() * joints.len()).div_ceil(LOADS_MAX);
    let ratios = |m: &Moment| -> Vec<f64> {
        let mut ratios = vec![0.0_f64; joints.len()];
        for &(joint, ratio) in &m.loads {
            // A joint with limits of its own and at its motor counts with the greater.
            let at = joints.partition_point(|j| *j < joint);
            ratios[at] = ratios[at].max(ratio);
        }
        ratios.iter().map(|r| libm::round(r * 1e3) / 1e3).collect()
    };
    let sampled = weighed.iter().step_by(stride.max(1)).map(|m| json!([number(m.time), ratios(m)]));
    json!({ "joints": joints, "moments": sampled.collect::<Vec<_>>() })
}
