//! Robot descriptions as modules of the language: a text to read, to give ports to, and to build robots of.

use super::import_fault::ImportFault;
use super::urdf_masses::{LinkMass, masses};
use super::urdf_reader::{Urdf, UrdfJoint, UrdfKind, UrdfShape, read};
use crate::formats::masses::MASS_MIN;
use crate::geometry::pose::{shifted, turned};
use crate::geometry::{Pose, Vec3, hull};
use std::collections::BTreeSet;

/// A file to be imported.
#[derive(Clone, Debug)]
pub struct ImportFile<'f> {
    /// Its name, without folders.
    pub name: &'f str,
    /// Its text.
    pub text: &'f str,
}

/// A module or configuration made of a file of another program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Imported {
    /// The word of the language for what it is: `module` or `config`.
    pub what: &'static str,
    /// The name of the module or configuration.
    pub module: String,
    /// The text of the program that declares it.
    pub text: String,
    /// The parts that were left out, and what was assumed, in words.
    pub notes: Vec<String>,
}

/// The greatest number of corners of a hull: of more, those are taken that stick out farthest, so that the hull shrinks a
/// little.
const CORNERS_MAX: usize = 48;
/// The radius of the ball that stands for a link without shape, m.
const POINT_RADIUS: f64 = 1e-3;
/// Words that are no names in the module: keywords and units.
const TAKEN: &[&str] = &[
    "and", "or", "not", "if", "else", "for", "in", "let", "fn", "use", "true", "false", "expect", "require",
    "m", "s", "g", "h", "kg", "mm", "cm", "km", "rad", "deg", "turn", "min", "ms", "us", "link", "joint",
    "port", "motor", "mass", "part", "alias", "touching", "contact", "touch", "self", "rpm", "t",
];

/// Returns the module that a robot description in URDF makes. `open` returns the bytes of a mesh by the name that stands in
/// the description, if there is such a file; `source`: the name of the description's file.
///
/// # Errors
/// The first [`ImportFault`] of the description.
pub(super) fn import_urdf(
    text: &str,
    source: &str,
    open: &mut dyn FnMut(&str) -> Option<Vec<u8>>,
) -> Result<Imported, ImportFault> {
    let urdf = read(text, open)?;
    let mut writer = Writer::new(&urdf);
    let text = writer.text(source);
    Ok(Imported { what: "module", module: writer.module, text, notes: writer.notes })
}

/// The writer of a module.
struct Writer<'u> {
    urdf: &'u Urdf,
    module: String,
    links: Vec<String>,
    joints: Vec<String>,
    /// The pose of each link in the module's frame, all joints at zero; joints that follow others at their offsets.
    poses: Vec<Pose>,
    order: Vec<(usize, Option<usize>)>,
    /// The mass of each link.
    masses: Vec<LinkMass>,
    notes: Vec<String>,
}

impl<'u> Writer<'u> {
    fn new(urdf: &'u Urdf) -> Writer<'u> {
        let mut taken = BTreeSet::new();
        let links = urdf.links.iter().map(|link| name_of(&link.name, "link", &mut taken)).collect();
        let joints = urdf.joints.iter().map(|joint| name_of(&joint.name, "link", &mut taken)).collect();
        let order = urdf.in_order();
        let mut poses = vec![Pose::identity(); urdf.links.len()];
        for &(link, joint) in &order {
            if let Some(joint) = joint {
                let joint = &urdf.joints[joint];
                let offset = joint.mimic.map_or(0.0, |(_, _, offset)| offset);
                let moved = match joint.kind {
                    UrdfKind::Prismatic => shifted(joint.axis * offset),
                    UrdfKind::Fixed => Pose::identity(),
                    UrdfKind::Revolute | UrdfKind::Continuous => turned(joint.axis, offset),
                };
                poses[link] = poses[joint.parent] * joint.origin * moved;
            }
        }
        let module = type_name(&urdf.name);
        let (masses, of_masses) = masses(urdf, &poses);
        let notes = urdf.notes.iter().cloned().chain(of_masses).collect();
        Writer { urdf, module, links, joints, poses, order, masses, notes }
    }

    fn text(&mut self, source: &str) -> String {
        let plain = |text: &str| text.replace(char::is_control, " ");
        let mut text = format!("//! {}: the robot of `{}`.\n\n", self.module, plain(source));
        let name = plain(&self.urdf.name);
        text.push_str(&format!("/// The robot `{name}` as one module.\nmodule {} {{\n", self.module));
        let massless = self.urdf.links.iter().all(|link| link.mass.unwrap_or(0.0) < MASS_MIN);
        if massless {
            self.notes.push("no link states a mass: the module has 1 kg".to_owned());
            text.push_str("  mass 1kg  // none is stated\n");
        }
        for (link, _) in self.order.clone() {
            text.push_str(&self.link(link, massless));
        }
        text.push('\n');
        for (_, joint) in self.order.clone() {
            if let Some(joint) = joint {
                text.push_str(&self.joint(joint));
            }
        }
        let body = &self.links[self.order[0].0];
        text.push_str(&format!(
            "\n  // A place for ports, where other modules dock:\n  // port front : Face on {body} at [50mm, 0mm, 0mm] \
             facing +X up +Z\n}}\n"
        ));
        text
    }

    fn link(&mut self, link: usize, massless: bool) -> String {
        let declared = &self.urdf.links[link];
        let X = self.poses[link];
        let mass = &self.masses[link];
        let mut facts = Vec::new();
        if !massless {
            facts.push(format!("mass: {}", quantity(mass.mass, "kg")));
            facts.extend(mass.centre.map(|centre| format!("com: {}", place(&centre))));
            facts.extend(mass.moments.map(|moments| {
                let moments = moments.map(|x| quantity(x, "kg*m^2"));
                format!("inertia: [{}]", moments.join(", "))
            }));
        }
        let mut shapes: Vec<(Pose, String)> = Vec::new();
        for (X_LS, shape) in &declared.shapes {
            match shape_text(shape) {
                Some(text) => shapes.push((*X_LS, text)),
                None => {
                    self.notes.push(format!("a mesh of `{}` is left out: its points are flat", declared.name))
                }
            }
        }
        if shapes.is_empty() || mass.needs_room {
            let centre = shifted(mass.centre.filter(|_| !massless).unwrap_or_default());
            shapes.push((centre, format!("sphere(radius: {}", length(POINT_RADIUS))));
        }
        let solid = match &shapes[..] {
            [(X_LS, only)] if *X_LS == Pose::identity() => joined(only, facts),
            all => {
                let parts = all.iter().map(|(X_LS, shape)| {
                    let turn = turn_of(X_LS).map(|(axis, angle)| {
                        format!(", axis: {}, turn: {}", direction(&axis), quantity(angle, "rad"))
                    });
                    let at = place(&X_LS.translation.vector);
                    format!("placed({shape}), at: {at}{})", turn.unwrap_or_default())
                });
                let parts: Vec<String> = parts.collect();
                joined(&format!("union(\n    {},\n    ", parts.join(",\n    ")), facts)
            }
        };
        let mut line = format!("  link {} = {solid}", self.links[link]);
        let turn = turn_of(&X);
        if X.translation.vector != Vec3::zeros() || turn.is_some() {
            line.push_str(&format!(" at {}", place(&X.translation.vector)));
        }
        if let Some((axis, angle)) = turn {
            line.push_str(&format!(" turned({}, {})", direction(&axis), quantity(angle, "rad")));
        }
        line.push_str(&renamed(&self.links[link], &declared.name));
        line.push('\n');
        line
    }

    fn joint(&mut self, index: usize) -> String {
        let joint = &self.urdf.joints[index];
        let (parent, child) = (&self.links[joint.parent], &self.links[joint.child]);
        let name = &self.joints[index];
        let X = self.poses[joint.child];
        let mut line = format!("  joint {name} : {parent} -> {child} = {}", kind_text(joint, &X));
        if joint.kind != UrdfKind::Fixed && X.translation.vector != Vec3::zeros() {
            line.push_str(&format!(" at {}", place(&X.translation.vector)));
        }
        line.push_str(&renamed(name, &joint.name));
        line.push('\n');
        if let Some((followed, factor, offset)) = joint.mimic {
            line.push_str(&format!("  joint {name} = {} * {}\n", number(factor), self.joints[followed]));
            if offset != 0.0 {
                self.notes.push(format!("`{}` counts from its offset {}", joint.name, number(offset)));
            }
        }
        line
    }
}

/// Returns a joint's kind; `X`: the pose of its frame in the module's.
fn kind_text(joint: &UrdfJoint, X: &Pose) -> String {
    let (kind, angle, effort, force) = match joint.kind {
        UrdfKind::Fixed => return "fixed()".to_owned(),
        UrdfKind::Prismatic => ("prismatic", "m", "N", "max_force"),
        UrdfKind::Revolute | UrdfKind::Continuous => ("revolute", "rad", "N*m", "max_torque"),
    };
    let mut facts = vec![format!("axis: {}", direction(&(X.rotation * joint.axis)))];
    if joint.mimic.is_none() {
        if let Some((low, high)) = joint.range {
            facts.push(format!("range: {}..{}", quantity(low, angle), quantity(high, angle)));
        }
        facts.extend(
            joint.speed.map(|speed| format!("max_speed: {}", quantity(speed, &format!("{angle}/s")))),
        );
        facts.extend(joint.effort.map(|most| format!("{force}: {}", quantity(most, effort))));
        let unit = if angle == "m" { "N*s/m" } else { "N*m*s/rad" };
        facts.extend(joint.damping.map(|damping| format!("damping: {}", quantity(damping, unit))));
    }
    format!("{kind}({})", facts.join(", "))
}

/// Returns a shape without its last bracket; `None` for points that are flat.
fn shape_text(shape: &UrdfShape) -> Option<String> {
    Some(match shape {
        UrdfShape::Box(size) => {
            format!("box({}, {}, {}", length(size.x), length(size.y), length(size.z))
        }
        UrdfShape::Cylinder { radius, length: long } => {
            format!("cylinder(radius: {}, length: {}", length(*radius), length(*long))
        }
        UrdfShape::Capsule { radius, length: long } => {
            format!("capsule(radius: {}, length: {}", length(*radius), length(*long))
        }
        UrdfShape::Sphere(radius) => format!("sphere(radius: {}", length(*radius)),
        UrdfShape::Points(points) => {
            let corners: Vec<String> = corners(&hull::faces(points)?.points).iter().map(place).collect();
            format!("hull([{}]", corners.join(", "))
        }
    })
}

/// Returns the corners of a hull; of many those that stick out farthest in directions all around (a spiral from pole to
/// pole).
fn corners(points: &[Vec3]) -> Vec<Vec3> {
    if points.len() <= CORNERS_MAX {
        return points.to_vec();
    }
    let golden = std::f64::consts::PI * (3.0 - libm::sqrt(5.0));
    let mut kept = BTreeSet::new();
    for k in 0..CORNERS_MAX {
        let z = 1.0 - 2.0 * (k as f64 + 0.5) / CORNERS_MAX as f64;
        let (s, c) = libm::sincos(golden * k as f64);
        let flat = libm::sqrt(1.0 - z * z);
        let along = Vec3::new(flat * c, flat * s, z);
        let farthest =
            (0..points.len()).max_by(|a, b| points[*a].dot(&along).total_cmp(&points[*b].dot(&along)));
        kept.extend(farthest);
    }
    kept.into_iter().map(|index| points[index]).collect()
}

/// Returns a call that lacks its last bracket with more arguments, and closed.
fn joined(call: &str, facts: Vec<String>) -> String {
    // Parts on lines of their own end with a comma already.
    if facts.is_empty() && call.ends_with(' ') {
        return format!("{}\n  )", call.trim_end());
    }
    let between = if call.ends_with([' ', '(']) || facts.is_empty() { "" } else { ", " };
    let end = if call.contains('\n') { ",\n  )" } else { ")" };
    format!("{call}{between}{}{end}", facts.join(", "))
}

/// Returns the axis and the angle (rad) of a pose's rotation; `None` for none.
fn turn_of(X: &Pose) -> Option<(Vec3, f64)> {
    X.rotation.axis_angle().map(|(axis, angle)| (axis.into_inner(), angle)).filter(|(_, angle)| *angle > 0.0)
}

/// Returns a comment with the name in the description, where it is another.
fn renamed(name: &str, original: &str) -> String {
    if name == original {
        String::new()
    } else {
        format!("  // `{}`", original.replace(char::is_control, " "))
    }
}

/// Returns a number with the fewest digits that read back to it.
pub(super) fn number(x: f64) -> String {
    let x = x + 0.0;
    let plain = format!("{x}");
    if plain.len() > 24 { format!("{x:e}") } else { plain }
}

fn quantity(x: f64, unit: &str) -> String {
    format!("{}{unit}", number(x))
}

fn length(x: f64) -> String {
    quantity(x, "m")
}

/// Returns a position, m.
fn place(v: &Vec3) -> String {
    format!("[{}, {}, {}]", length(v.x), length(v.y), length(v.z))
}

/// Returns a direction: an axis by its name, others by their components.
fn direction(v: &Vec3) -> String {
    for (axis, name) in [(Vec3::x(), "X"), (Vec3::y(), "Y"), (Vec3::z(), "Z")] {
        if *v == axis {
            return name.to_owned();
        }
        if *v == -axis {
            return format!("-{name}");
        }
    }
    format!("[{}, {}, {}]", number(v.x), number(v.y), number(v.z))
}

/// Returns a name of the language for a name of a description, in lower case with `_`, which no other has.
/// `kind` stands before a name that could not begin so.
pub(super) fn name_of(original: &str, kind: &str, taken: &mut BTreeSet<String>) -> String {
    let mut name = String::new();
    let mut lower_before = false;
    for c in original.chars() {
        if c.is_ascii_uppercase() && lower_before {
            name.push('_');
        }
        lower_before = c.is_ascii_lowercase() || c.is_ascii_digit();
        name.push(if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' });
    }
    let mut name = name.trim_matches('_').to_owned();
    while name.contains("__") {
        name = name.replace("__", "_");
    }
    if name.is_empty() || name.starts_with(|c: char| c.is_ascii_digit()) || TAKEN.contains(&name.as_str()) {
        name = format!("{kind}_{name}").trim_end_matches('_').to_owned();
    }
    let numbered = (2..).map(|number| format!("{name}_{number}"));
    let free = std::iter::once(name.clone()).chain(numbered).find(|name| !taken.contains(name));
    let free = free.expect("numbers do not end");
    taken.insert(free.clone());
    free
}

/// Returns a name of the language for a module: words that begin in upper case, without anything between.
pub(super) fn type_name(original: &str) -> String {
    let words = original.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    let upper = |word: &str| {
        let mut letters = word.chars();
        letters
            .next()
            .map_or(String::new(), |first| first.to_ascii_uppercase().to_string() + letters.as_str())
    };
    let name: String = words.map(upper).collect();
    match name.chars().next() {
        Some(first) if first.is_ascii_uppercase() && name.len() > 1 => name,
        _ => format!("Robot{name}"),
    }
}
