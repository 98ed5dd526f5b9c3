//! Values as `print` and `{...}` in a text show them: as they could be written, with units that suit
//! their size.

use super::pretty::quoted;
use crate::check::typed::DefKind;
use crate::geometry::Vec3;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::record::{DeclaredRecord, Record};
use crate::interpret::value::{Callable, Value};
use crate::interpret::verdicts;
use crate::units::{Dimension, number, quantity};

/// The greatest number of elements of a list that are shown; the rest are counted.
const ELEMENTS_SHOWN: usize = 1000;
/// The greatest number of records within each other that are shown.
const LEVELS_SHOWN: usize = 100;
/// Coordinates and angles below this are shown as 0, SI.
const COORDINATE_ROUNDING: f64 = 1e-12;

impl Interpreter<'_> {
    /// Returns a value as text, as `print` shows it: on one line, except for a text with line breaks and a report of
    /// the judge. Nothing is evaluated.
    pub(super) fn show_value(&self, value: &Value) -> String {
        match value {
            Value::Unknown => "?".into(),
            Value::Nothing => "nothing".into(),
            Value::Missing => "_".into(),
            Value::Bool(b) => b.to_string(),
            Value::Int(n) => n.to_string(),
            Value::Big(n) => n.to_string(),
            Value::Quantity(x, _) if x.is_infinite() => {
                if *x > 0.0 { "infinite" } else { "-infinite" }.into()
            }
            Value::Quantity(x, d) => quantity(*x, without_radians(*d)),
            Value::Text(text) => text.to_string(),
            Value::Word(word) => word.to_string(),
            Value::List(_) => self.show_nested(value),
            Value::Vec3(v, d) => show_vector(v, *d),
            Value::Pose(pose) => show_pose(pose),
            Value::Range(ends) => format!("{}..{}", self.show_value(&ends.0), self.show_value(&ends.1)),
            Value::Fn(callable) => match &**callable {
                Callable::Lambda { .. } => "a function".into(),
                Callable::Def(def) => format!("the function {}", self.name(*def)),
                Callable::Behavior { object, .. } => format!("a behaviour of {}", object.title()),
            },
            Value::Instance(instance) => instance.title().into(),
            Value::Joint(joint) => joint.name(),
            Value::Port(port) => port.name(),
            Value::Behavior(_) => "a behaviour".into(),
            Value::Signal(_) => "a signal".into(),
            Value::Condition(_) => "a condition".into(),
            Value::Shape(_) => "a shape".into(),
            Value::JointKind(_) => "a kind of joint".into(),
            Value::Cells(cells) => format!("{} cells", cells.positions.len()),
            Value::Mesh(mesh) => format!("a mesh of {} faces", mesh.faces.len()),
            Value::Terrain(field) => format!("a terrain of {} by {} heights", field.columns, field.rows()),
            Value::Cloud(points) => format!("a cloud of {} points", points.len()),
            Value::Record(record) => self.show_record(record),
            Value::Study(def) => format!("the study {}", self.name(*def)),
        }
    }

    fn show_nested(&self, value: &Value) -> String {
        let mut text = String::new();
        self.write_nested(value, 0, &mut text);
        text
    }

    /// Appends a value that is in `level` records, of a list or a record each element. They may share what they hold
    /// over and over, so writing stops beyond the limit of a text, which is then refused where it is printed.
    fn write_nested(&self, value: &Value, level: usize, text: &mut String) {
        match value {
            Value::List(elements) => self.write_list(elements, level, text),
            Value::Record(record) => match &**record {
                Record::Declared(record) => self.write_record(record, level, text),
                other => text.push_str(&self.show_record(other)),
            },
            // A record is shown as it is written, so that a text in it does not run into the next field.
            Value::Text(words) if level > 0 => text.push_str(&quoted(words)),
            _ => text.push_str(&self.show_value(value)),
        }
    }

    fn write_list(&self, elements: &[Value], level: usize, text: &mut String) {
        text.push('[');
        for (index, element) in elements.iter().take(ELEMENTS_SHOWN).enumerate() {
            if text.len() > self.limits().text {
                return;
            }
            text.push_str(if index > 0 { ", " } else { "" });
            self.write_nested(element, level, text);
        }
        if elements.len() > ELEMENTS_SHOWN {
            text.push_str(&format!(", and {} more", elements.len() - ELEMENTS_SHOWN));
        }
        text.push(']');
    }

    fn write_record(&self, record: &DeclaredRecord, level: usize, text: &mut String) {
        let DefKind::Record(declared) = &self.shared.program.def(record.def).kind else { return };
        text.push_str(self.name(record.def).as_str());
        if level >= LEVELS_SHOWN {
            return text.push_str("(...)");
        }
        text.push('(');
        for (index, (field, value)) in declared.fields.iter().zip(&record.fields).enumerate() {
            if text.len() > self.limits().text {
                return;
            }
            text.push_str(if index > 0 { ", " } else { "" });
            text.push_str(&format!("{}: ", field.name));
            self.write_nested(value, level + 1, text);
        }
        text.push(')');
    }

    /// Returns a record as `print` shows it.
    fn show_record(&self, record: &Record) -> String {
        match record {
            Record::Declared(record) => {
                let mut text = String::new();
                self.write_record(record, 0, &mut text);
                text
            }
            Record::Plan(planned) => format!(
                "a plan of {}, {} actions",
                quantity(planned.plan.body.duration(), Dimension::TIME),
                planned.actions()
            ),
            Record::Report(verdict, headline) => verdicts::in_words(verdict, headline),
            Record::State(state) => state.in_words(),
            Record::World(world) => format!(
                "ground {:?}{}, gravity {}, friction {}",
                world.ground,
                match world.is_sloped() {
                    true => format!(", slope {}", quantity(world.slope_angle(), Dimension::ANGLE)),
                    false => String::new(),
                },
                quantity(world.gravity, Dimension::ACCELERATION),
                number(world.friction)
            )
            .to_lowercase(),
            Record::Frame(nodes, struts) => {
                format!("a frame of {} nodes and {} struts", nodes.len(), struts.len())
            }
            Record::Native(record) => record.show(),
            Record::Rigidity(design) => match &design.kind {
                crate::interpret::design::DesignKind::Truss(truss) => {
                    let r = &truss.rigidity;
                    format!(
                        "rank {} of {}, {} self-stresses, weakest {}, {} redundant struts",
                        r.rank,
                        r.rank_rigid,
                        r.self_stresses,
                        number(r.weakest),
                        r.redundant.len()
                    )
                }
                _ => String::new(),
            },
        }
    }
}

/// Returns the dimension without radians where only that has a name (`2rad/s * 45mm` is a speed); else the dimension
/// itself.
pub(super) fn without_radians(dimension: Dimension) -> Dimension {
    let dropped = Dimension { angle: 0, ..dimension };
    let named = dimension.name().is_none() && dropped.name().is_some();
    if named && dimension.fits(dropped) { dropped } else { dimension }
}

/// Returns a vector, each coordinate with a unit of its own.
fn show_vector(v: &Vec3, dimension: Dimension) -> String {
    let coordinate = |x: f64| if x.abs() < COORDINATE_ROUNDING { 0.0 } else { x };
    let parts: Vec<String> = v.iter().map(|&x| quantity(coordinate(x), dimension)).collect();
    format!("[{}]", parts.join(", "))
}

/// Returns a pose: the position, and the turn about its axis.
fn show_pose(pose: &crate::geometry::Pose) -> String {
    let at = show_vector(&pose.translation.vector, Dimension::LENGTH);
    let (axis, angle) = axis_angle(pose);
    if angle < COORDINATE_ROUNDING {
        return format!("at {at}");
    }
    format!(
        "at {at} turned({}, {})",
        show_vector(&axis, Dimension::NUMBER),
        quantity(angle, Dimension::ANGLE)
    )
}

/// Returns the axis (a unit vector) and the angle of a rotation, 0 to π rad, by `libm`, so that they are the
/// same on every platform; the z axis for no rotation.
fn axis_angle(pose: &crate::geometry::Pose) -> (Vec3, f64) {
    let q = pose.rotation.quaternion();
    let v = if q.w < 0.0 { -q.vector().into_owned() } else { q.vector().into_owned() };
    let sine = v.norm();
    let angle = 2.0 * libm::atan2(sine, q.w.abs());
    (if sine > 0.0 { v / sine } else { Vec3::z() }, angle)
}
