//! Facts of servos and contacts that a module need not state: what is assumed of them then, and why.
//!
//! A module that states a fact as it stands here is simulated as one that leaves it out. The judge counts an armature only
//! where it is stated.

/// The stiffness of a servo of which neither that nor a greatest torque is known: that of small servos with gears, which yield
/// by a degree under some 2.6 N*m.
let usual_stiffness: Quantity<N*m/rad> = 150N*m/rad

/// The stiffness of a servo that yields by 1 degree under its greatest torque.
///
/// Example:
/// ```modl
/// use std.servos.stiffness
/// print(stiffness(2.5N*m))
/// ```
fn stiffness(max_torque: Torque) -> Quantity<N*m/rad> = max_torque / 1deg

/// The same of a joint that slides: it yields by as much at a lever of 100 mm.
///
/// Example:
/// ```modl
/// use std.servos.sliding_stiffness
/// print(sliding_stiffness(25N))
/// ```
fn sliding_stiffness(max_force: Force) -> Quantity<N/m> = max_force / (100mm * (1deg / 1rad))

/// The damping of a servo: 1/25 s of its stiffness, 6 N*m*s/rad for 150 N*m/rad, which damps well under a load of some kg at
/// 100 mm.
///
/// Example:
/// ```modl
/// use std.servos.damping
/// print(damping(150N*m/rad))
/// ```
fn damping(stiffness: Quantity<N*m/rad>) -> Quantity<N*m*s/rad> = stiffness * 40ms

/// The inertia of rotor and gears as the joint feels it: 2e-3 kg*m^2 for 150 N*m/rad, a rotor of 1e-7 kg*m^2 behind a gear of
/// 140.
///
/// Example:
/// ```modl
/// use std.servos.armature
/// print(armature(150N*m/rad))
/// ```
fn armature(stiffness: Quantity<N*m/rad>) -> Quantity<kg*m^2> = stiffness / usual_stiffness * 2e-3kg*m^2

/// The coefficient of friction of a link: that of plastic on a floor.
let friction: Number = 0.5

/// The stiffness of a contact of a link: stiffer than servos are at a lever of 100 mm.
let contact_stiffness: Quantity<N/m> = 1e5N/m
