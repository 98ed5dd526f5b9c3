//! The motion of a robot whose servos yield more than their stated stiffness says.

use super::super::polyline::Polyline;
use super::tolerances::PARAMETERS;

/// The motion of the joints as soft servos yield under their loads, at the instants of full dynamics.
#[derive(Default)]
pub(in super::super) struct DeflectedMotion {
    /// The positions of the joints at all instants; as planned, where no loads were found or a joint gives way.
    pub along: Polyline,
    /// The number of instants at which the positions are deflected, and not as planned.
    pub instants: usize,
}

/// Returns these positions of the joints with their deflections (rad or m) as great as they are with soft servos;
/// `None` where one gives way.
pub(super) fn deflected(joints: &[f64], deflections: &[f64]) -> Option<Vec<f64>> {
    let softer = PARAMETERS.servo_softer.recip();
    let yields =
        deflections.iter().all(|deflection| (softer * deflection).abs() <= PARAMETERS.deflection_max);
    let deflected =
        || joints.iter().zip(deflections).map(|(at, deflection)| at + softer * deflection).collect();
    yields.then(deflected)
}
