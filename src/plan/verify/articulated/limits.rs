//! Range, speed and acceleration of joints and motors, by the convex hull property of Bernstein polynomials:
//! proved at every instant.

use super::tolerances::{NUMERICS, Tolerances};
use crate::plan::polynomial::{derivative, elevated, greatest, greatest_size};
use crate::plan::verify::ledger::{Ledger, keep_least};
use crate::plan::{CauseId, CheckKind, ExemptionKind, Failure, Status, Tracks};
use crate::robot::{Drive, JointId, drives};
use crate::units::{Dimension, quantity};

/// A polynomial piece of the motion of a drive, within one segment, or one rest, of each of its joints.
struct Piece {
    /// The start of the piece, s.
    start: f64,
    /// The end of the piece, s.
    end: f64,
    /// The Bernstein control points of the drive's position, rad or m.
    control: Vec<f64>,
    /// The cause of the joints' segment that began last; `None` for the position at the start of the plan.
    cause: Option<CauseId>,
}

/// Judges range, speed and acceleration of every joint and motor that states a limit. Under full dynamics (`full`) a
/// driven joint ([`Drive::driven`]) that states no acceleration limit must not jump in velocity: its torque would have
/// no bound.
pub(super) fn judge(tracks: &Tracks, full: bool, tolerances: &Tolerances, ledger: &mut Ledger) {
    let drives = drives(&tracks.robot);
    for drive in &drives {
        let pieces = pieces(tracks, drive);
        range(tracks, drive, &pieces, tolerances, ledger);
        speed(drive, &pieces, full, tolerances, ledger);
        acceleration(drive, &pieces, full, tolerances, ledger);
    }
    let status = |stated: bool| if stated { Status::Proved } else { Status::NoLimit };
    ledger.check(CheckKind::JointRange, status(drives.iter().any(|d| d.limits.range.is_some())));
    ledger.check(CheckKind::Speed, status(drives.iter().any(|d| speed_limit(d, full).is_some())));
    ledger.check(CheckKind::Acceleration, status(drives.iter().any(|d| d.limits.acceleration.is_some())));
}

/// Returns the motion of a drive, in order of time: the weighted sum of the motions of its joints, cut at each instant
/// at which a segment of one of them begins or ends. Intervals in which none of them has a segment are left out.
fn pieces(tracks: &Tracks, drive: &Drive) -> Vec<Piece> {
    let moving: Vec<_> = drive
        .terms
        .iter()
        .filter_map(|&(joint, factor)| Some((tracks.track(JointId(joint as u32))?, joint, factor)))
        .collect();
    // Instants at which a piece of any joint of the drive begins or ends.
    let mut cuts: Vec<f64> =
        moving.iter().flat_map(|(t, ..)| t.segments.iter().flat_map(|s| [s.start, s.end])).collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    // The constant contribution of joints that do not move.
    let still: f64 = drive
        .terms
        .iter()
        .filter(|(joint, _)| tracks.track(JointId(*joint as u32)).is_none())
        .map(|&(joint, factor)| factor * tracks.start.joints[joint])
        .sum();
    let mut next = vec![0; moving.len()];
    let mut found = Vec::new();
    // Between two instants the drive's control points are the weighted sum of those of its joints.
    for pair in cuts.windows(2) {
        let (start, end) = (pair[0], pair[1]);
        let mut control = vec![still];
        let mut cause: Option<(f64, CauseId)> = None;
        for ((track, joint, factor), next) in moving.iter().zip(&mut next) {
            while track.segments.get(*next).is_some_and(|s| s.end <= start) {
                *next += 1;
            }
            let within = track.segments.get(*next).filter(|s| s.start <= start);
            let piece = match within.and_then(|s| s.between(start, end)) {
                Some(piece) => {
                    let begun = within.map_or(start, |s| s.start);
                    if cause.is_none_or(|(t, _)| begun > t) {
                        cause = Some((begun, piece.cause));
                    }
                    piece.control
                }
                None => vec![track.position(tracks.start.joints[*joint], start)],
            };
            control = sum(&control, &piece, *factor);
        }
        if let Some((_, cause)) = cause {
            found.push(Piece { start, end, control, cause: Some(cause) });
        }
    }
    found
}

/// Returns the Bernstein control points of `a + factor · b`, after elevation to the greater of their degrees.
fn sum(a: &[f64], b: &[f64], factor: f64) -> Vec<f64> {
    let degree = a.len().max(b.len()) - 1;
    let (a, b) = (elevated(a, degree), elevated(b, degree));
    a.iter().zip(&b).map(|(a, b)| a + factor * b).collect()
}

/// Checks the position of a drive (rad or m) at the start and over all its pieces against its range, and reports the
/// greatest excess. An excess up to the tolerance `limit` of the range's length, or of 1 if that is more, is none.
fn range(tracks: &Tracks, drive: &Drive, pieces: &[Piece], tolerances: &Tolerances, ledger: &mut Ledger) {
    let Some((low, high)) = drive.limits.range else { return };
    let at_start: f64 = drive.terms.iter().map(|&(joint, factor)| factor * tracks.start.joints[joint]).sum();
    let slack = tolerances.limit * (high - low).max(1.0);
    let start = Piece { start: 0.0, end: 0.0, control: vec![at_start], cause: None };
    let mut worst: Option<(f64, f64, f64, &Piece)> = None;
    for piece in std::iter::once(&start).chain(pieces) {
        let (above, u) = greatest(&piece.control, NUMERICS.extremum);
        let negated: Vec<f64> = piece.control.iter().map(|c| -c).collect();
        let (below, v) = greatest(&negated, NUMERICS.extremum);
        for (position, limit, excess, u) in [(above, high, above - high, u), (-below, low, low + below, v)] {
            let t = piece.start + u * (piece.end - piece.start);
            if excess > slack && worst.is_none_or(|(p, l, ..)| excess > (p - l).abs()) {
                worst = Some((position, limit, t, piece));
            }
        }
    }
    if let Some((position, limit, time, piece)) = worst {
        let dimension = if drive.turns { Dimension::ANGLE } else { Dimension::LENGTH };
        let words = |v| quantity(v, dimension);
        let message = format!(
            "{} goes to {}; its range is {} to {}",
            drive.name,
            words(position),
            words(low),
            words(high)
        );
        ledger.fail(failure(CheckKind::JointRange, drive, time, message, (position, limit), piece));
    }
}

/// Returns the greatest speed of a drive, rad/s or m/s: under full dynamics that without load is one, too.
fn speed_limit(drive: &Drive, full: bool) -> Option<f64> {
    if full { drive.speed_limit() } else { drive.limits.speed }
}

/// Checks the greatest speed of a drive (rad/s or m/s) against its limit, and records the margin as a part of the
/// limit if it is the least so far.
fn speed(drive: &Drive, pieces: &[Piece], full: bool, tolerances: &Tolerances, ledger: &mut Ledger) {
    let Some(limit) = speed_limit(drive, full) else { return };
    let mut worst: Option<(f64, f64, &Piece)> = None;
    for piece in pieces {
        let (value, u) = greatest_size(&derivative(&piece.control), NUMERICS.extremum);
        let length = piece.end - piece.start;
        if worst.is_none_or(|(w, ..)| value / length > w) {
            worst = Some((value / length, piece.start + u * length, piece));
        }
    }
    let Some((value, time, piece)) = worst else { return };
    keep_least(&mut ledger.verdict.speed_margin, 1.0 - value / limit, time, || vec![drive.name.clone()]);
    if value > limit * (1.0 + tolerances.limit) {
        let dimension = if drive.turns { Dimension::ANGULAR_SPEED } else { Dimension::SPEED };
        let message = format!(
            "{} moves at {}; it can do {}",
            drive.name,
            quantity(value, dimension),
            quantity(limit, dimension)
        );
        ledger.fail(failure(CheckKind::Speed, drive, time, message, (value, limit), piece));
    }
}

/// Checks the acceleration of a drive (rad/s² or m/s²) against its limit, and reports the greatest excess that no
/// exemption covers; a jump of the velocity counts as infinite. Without a limit only jumps are checked, and these only
/// under full dynamics (`full`) and for a driven joint ([`Drive::driven`]).
fn acceleration(drive: &Drive, pieces: &[Piece], full: bool, tolerances: &Tolerances, ledger: &mut Ledger) {
    let is_excused = |time: f64, ledger: &mut Ledger| {
        ledger.excuses(CheckKind::Acceleration, time, |kind| *kind == ExemptionKind::Acceleration)
    };
    let jumps = jumps(pieces, tolerances);
    let Some(limit) = drive.limits.acceleration else {
        if full && drive.driven {
            let first = jumps.into_iter().find(|jump| !is_excused(jump.0, ledger));
            if let Some((time, change, piece)) = first {
                ledger.fail(unlimited(drive, time, change, piece));
            }
        }
        return;
    };
    let mut accelerations: Vec<(f64, f64, &Piece)> = Vec::new();
    for piece in pieces {
        let length = piece.end - piece.start;
        let (value, u) = greatest_size(&derivative(&derivative(&piece.control)), NUMERICS.extremum);
        accelerations.push((value / (length * length), piece.start + u * length, piece));
    }
    accelerations.extend(jumps.into_iter().map(|(time, _, piece)| (f64::INFINITY, time, piece)));
    let mut worst: Option<(f64, f64, &Piece)> = None;
    for (value, time, piece) in accelerations {
        let over = value > limit * (1.0 + tolerances.limit) && worst.is_none_or(|(w, ..)| value > w);
        if over && !is_excused(time, ledger) {
            worst = Some((value, time, piece));
        }
    }
    let Some((value, time, piece)) = worst else { return };
    let dimension = if drive.turns { Dimension::ANGULAR_ACCELERATION } else { Dimension::ACCELERATION };
    let found = if value.is_finite() {
        format!("accelerates by {}", quantity(value, dimension))
    } else {
        "changes its speed at once".to_owned()
    };
    let message = format!("{} {found}; it can do {}", drive.name, quantity(limit, dimension));
    let value = if value.is_finite() { value } else { f64::MAX };
    ledger.fail(failure(CheckKind::Acceleration, drive, time, message, (value, limit), piece));
}

/// Returns the failure of a drive that jumps in velocity, by `change` (rad/s or m/s), and states no acceleration limit.
fn unlimited(drive: &Drive, time: f64, change: f64, piece: &Piece) -> Failure {
    let dimension = if drive.turns { Dimension::ANGULAR_SPEED } else { Dimension::SPEED };
    let message = format!(
        "{} changes its speed at once, by {}, and states no acceleration limit: no torque would do",
        drive.name,
        quantity(change, dimension)
    );
    failure(CheckKind::Acceleration, drive, time, message, (change, 0.0), piece)
}

/// Returns the jumps in velocity of a drive that exceed the tolerance `speed_jump`, before, between and after its
/// pieces, in order of time: the time (s), the change (rad/s or m/s, not negative) and the piece that begins or ends
/// there.
fn jumps<'p>(pieces: &'p [Piece], tolerances: &Tolerances) -> Vec<(f64, f64, &'p Piece)> {
    let mut found = Vec::new();
    let mut before = (f64::NEG_INFINITY, 0.0);
    for (index, piece) in pieces.iter().enumerate() {
        let length = piece.end - piece.start;
        let rates = derivative(&piece.control);
        let (first, last) = (rates[0] / length, rates[rates.len() - 1] / length);
        let was = if before.0 == piece.start { before.1 } else { 0.0 };
        found.push((piece.start, (first - was).abs(), piece));
        // After the last piece, and before a pause, the drive is at rest.
        if pieces.get(index + 1).is_none_or(|next| next.start > piece.end) {
            found.push((piece.end, last.abs(), piece));
        }
        before = (piece.end, last);
    }
    found.retain(|(_, change, _)| *change > tolerances.speed_jump);
    found
}

fn failure(
    kind: CheckKind,
    drive: &Drive,
    time: f64,
    message: String,
    (value, limit): (f64, f64),
    piece: &Piece,
) -> Failure {
    Failure {
        kind,
        time,
        until: None,
        at: vec![drive.name.clone()],
        message,
        value,
        limit,
        blame: piece.cause.into_iter().collect(),
        blames_start: false,
    }
}
