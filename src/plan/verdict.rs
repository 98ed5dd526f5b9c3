//! The verdict of the judge: every check with its status, worst values, and failures with their causes.

use super::cause::CauseId;
use crate::units::{Dimension, number, quantity, rounded, rounded_up};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A check of the judge: the statement about a plan that is checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CheckKind {
    /// The plan is well formed, and could be judged at all.
    Form,
    /// No two actions command a joint at the same time.
    Conflict,
    /// Links, cells or struts stay apart from each other and from obstacles.
    Collision,
    /// Joint positions, cell sizes and strut lengths stay in their ranges.
    JointRange,
    /// Joints, cells and struts stay below their greatest speeds.
    Speed,
    /// Joints and cells stay below their greatest accelerations.
    Acceleration,
    /// Quasi-static efforts of joints and motors stay below their limits.
    Torque,
    /// Quasi-static forces and moments across bonds stay below what their connectors hold.
    BondLoad,
    /// Ports are within capture of each other when they dock.
    Docking,
    /// All modules or cells are connected with each other, so that nothing falls off.
    Connectedness,
    /// Kinematic loops that bonds close stay closed.
    Closure,
    /// No link or node penetrates the ground.
    Ground,
    /// The robot is statically stable: its centre of mass stays above the support polygon.
    Stability,
    /// Loaded links do not slip over the ground.
    Slip,
    /// Joints or cells are at rest at the start and at the end, and trusses where nodes merge or split.
    Rest,
    /// A lattice needs no external force or moment.
    Momentum,
    /// Forces of the ground exist that hold the robot in its motion, in balance with gravity and inertia.
    Balance,
    /// Friction determines the robot's travel: no part of it is left open by the contacts.
    Traction,
    /// Links that are apart as planned do not meet as servos yield under their loads.
    Deflection,
    /// A truss stays rigid: no singular value of its rigidity matrix that belongs to no rigid motion gets too small.
    Rigidity,
    /// The struts of a truss bear its weight.
    StrutLoad,
    /// Ports keep to the lines and arcs that the plan states of them.
    Path,
    /// Behaviours begin as they require, and end as they ensure. A plan file states no contracts: whoever makes the plan adds
    /// this check to those of the judge.
    Contract,
}

impl CheckKind {
    /// Returns the name that reports, pages and messages show.
    pub fn name(self) -> &'static str {
        match self {
            CheckKind::Form => "form",
            CheckKind::Conflict => "conflict",
            CheckKind::Collision => "collision",
            CheckKind::JointRange => "joint range",
            CheckKind::Speed => "speed",
            CheckKind::Acceleration => "acceleration",
            CheckKind::Torque => "torque",
            CheckKind::BondLoad => "bond load",
            CheckKind::Docking => "docking",
            CheckKind::Connectedness => "connectedness",
            CheckKind::Closure => "closure",
            CheckKind::Ground => "ground",
            CheckKind::Stability => "stability",
            CheckKind::Slip => "slip",
            CheckKind::Rest => "rest",
            CheckKind::Momentum => "momentum",
            CheckKind::Balance => "balance",
            CheckKind::Traction => "traction",
            CheckKind::Deflection => "deflection",
            CheckKind::Rigidity => "rigidity",
            CheckKind::StrutLoad => "strut load",
            CheckKind::Path => "path",
            CheckKind::Contract => "contract",
        }
    }
}

/// The kind of quantity of a worst value, which decides its unit in texts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// A length in m, which texts show in a unit that suits it.
    Length,
    /// A fraction of a limit, without unit.
    Fraction,
    /// An angle in rad, which texts show in degrees.
    Angle,
    /// A speed in m/s, which texts show in a unit that suits it.
    Speed,
    /// A number without unit.
    Number,
}

/// A kind of worst value that a verdict may hold: one row of [`WORST_VALUES`].
#[derive(Clone, Copy, Debug)]
pub struct WorstKind {
    /// The name of the value in reports.
    pub name: &'static str,
    /// The name on a page, after "least"; `None` for a value that a page does not show.
    pub title: Option<&'static str>,
    /// The kind of quantity that the value is, which sets its unit.
    pub measure: Measure,
    /// True if the greatest value is the worst, false if the least is.
    pub greatest: bool,
    /// The function that returns the value in a verdict, `None` if the verdict has none.
    pub of: fn(&Verdict) -> &Option<Worst>,
    /// The function that returns the value in a verdict for writing, `None` if the verdict has none.
    pub of_mut: fn(&mut Verdict) -> &mut Option<Worst>,
}

/// Makes a row of [`WORST_VALUES`] for a field of [`Verdict`].
macro_rules! worst_value {
    ($field:ident, $name:literal, $title:expr, $measure:ident, $greatest:literal) => {
        WorstKind {
            name: $name,
            title: $title,
            measure: Measure::$measure,
            greatest: $greatest,
            of: |verdict| &verdict.$field,
            of_mut: |verdict| &mut verdict.$field,
        }
    };
}

/// Every worst value of a verdict, in the order in which it is shown. All that prints, compares or rounds worst
/// values goes through this table.
pub const WORST_VALUES: [WorstKind; 11] = [
    worst_value!(clearance, "clearance", Some("clearance"), Length, false),
    worst_value!(margin, "margin", Some("margin of stability"), Length, false),
    worst_value!(torque_margin, "torque margin", Some("torque margin"), Fraction, false),
    worst_value!(bond_margin, "bond margin", Some("bond margin"), Fraction, false),
    worst_value!(speed_margin, "speed margin", Some("speed margin"), Fraction, false),
    worst_value!(impact, "impact", None, Speed, true),
    worst_value!(angle, "angle", Some("angle"), Angle, false),
    worst_value!(rigidity, "rigidity", Some("rigidity"), Number, false),
    worst_value!(force_margin, "force margin", Some("force margin"), Fraction, false),
    worst_value!(elastic_margin, "elastic margin", None, Fraction, false),
    worst_value!(slip, "slip", None, Length, true),
];

/// The outcome of a check, and how strong the evidence for it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Status {
    /// The check holds at every instant.
    Proved,
    /// The check holds at every instant up to a stated tolerance, which was needed: links penetrate by no more than
    /// `touch`.
    WithinTolerance,
    /// The check holds at this many samples; between them nothing is proved.
    Sampled(usize),
    /// The check was not made, for the reason in words.
    NotChecked(String),
    /// The library states no limit to check against.
    NoLimit,
    /// Failures of the check were excused by an exemption that stands in the source.
    Exempt,
    /// There is a failure of the check.
    Failed,
}

impl std::fmt::Display for Status {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Status::Proved => f.write_str("proved"),
            Status::WithinTolerance => f.write_str("within tolerance"),
            Status::Sampled(n) => write!(f, "sampled({n})"),
            Status::NotChecked(why) => write!(f, "not checked: {why}"),
            Status::NoLimit => f.write_str("no limit stated"),
            Status::Exempt => f.write_str("exempt"),
            Status::Failed => f.write_str("failed"),
        }
    }
}

/// A check of the judge with its outcome.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Check {
    /// The kind of the check: the statement that was checked.
    pub kind: CheckKind,
    /// The outcome, with the strength of its evidence.
    pub status: Status,
}

/// A worst value with its time and the modules, joints, bonds or struts that it was found at.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Worst {
    /// The value in SI units; a margin of torque, bond or speed is the fraction of the limit that is left, negative
    /// beyond it.
    pub value: f64,
    /// The time at which the value occurs, from the start of the plan, s.
    pub time: f64,
    /// The path names of the modules, joints, bonds or struts that the value was found at.
    pub at: Vec<String>,
}

/// A failure of a check: a violation of a limit, or of what a plan must be.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Failure {
    /// The check of which this is a failure.
    pub kind: CheckKind,
    /// The time at which the failure begins, from the start of the plan, s.
    pub time: f64,
    /// The time at which the failure ends, s; `None` if that was not followed.
    pub until: Option<f64>,
    /// The path names of the modules, links or joints concerned.
    pub at: Vec<String>,
    /// The finding in words with units: `s[0].m[2] and s[1].m[0] meet, 3.1 mm deep`.
    pub message: String,
    /// The amount found, in SI units; 0 where there is none.
    pub value: f64,
    /// The limit that the amount violates, in SI units; 0 where there is none.
    pub limit: f64,
    /// The commands to blame, at most three, as indices in the plan's causes: each of them held still removes the
    /// failure; if none does alone, those that move at its time. Empty if none was found or sought.
    pub blame: Vec<CauseId>,
    /// True if `blame` names the start pose (`set`, `connect`) instead of commands.
    pub blames_start: bool,
}

impl Failure {
    /// Returns true for the failure of a robot that slides down a slope: one of traction that begins at its time. That of
    /// a travel which friction does not determine lasts as long as the plan.
    pub fn is_slide(&self) -> bool {
        self.kind == CheckKind::Traction && self.until.is_none()
    }

    /// Returns the failure of a plan that is not well formed, or whose judgement could not be completed, with `message`
    /// as the finding: at 0 s, without an end, subjects, amounts (0) or blame.
    pub fn form(message: String) -> Failure {
        Failure {
            kind: CheckKind::Form,
            time: 0.0,
            until: None,
            at: vec![],
            message,
            value: 0.0,
            limit: 0.0,
            blame: vec![],
            blames_start: false,
        }
    }
}

/// The greatest dynamic quantities of a lattice plan, from the contact forces that the judge found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dynamics {
    /// The greatest force over one contact along one axis, N.
    pub peak_force: f64,
    /// The greatest speed of a cell, m/s.
    pub peak_speed: f64,
    /// The greatest kinetic energy of all cells together, J.
    pub peak_energy: f64,
    /// The greatest angular momentum about the centre of mass, kg·m²/s.
    pub angular_momentum: f64,
    /// A lower bound on the duration of any motion between the same shapes under the same limits, s.
    pub lower_bound: f64,
}

impl Dynamics {
    /// Returns the lower bound on the duration and the four peak values, the bound first, each as (name, text with
    /// unit). `duration`: that of the plan, s; the text of the bound says how many times the bound it is.
    pub fn in_words(&self, duration: f64) -> [(&'static str, String); 5] {
        let ratio = if self.lower_bound > 0.0 { duration / self.lower_bound } else { 1.0 };
        let bound = quantity(self.lower_bound, Dimension::TIME);
        [
            ("lower bound", format!("{bound}; this takes {} times that", rounded(ratio, 4))),
            ("peak force", quantity(self.peak_force, Dimension::FORCE)),
            ("peak speed", quantity(self.peak_speed, Dimension::SPEED)),
            ("peak energy", format!("{}J", number(self.peak_energy))),
            ("ang. momentum", quantity(self.angular_momentum, Dimension::ANGULAR_MOMENTUM)),
        ]
    }
}

/// The verdict of the judge about a plan: checks with their outcomes, failures and worst values.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Verdict {
    /// All checks of the judge with their outcomes, in order of kind.
    pub checks: Vec<Check>,
    /// All failures, in order of time, at most 100; a note counts the others.
    pub failures: Vec<Failure>,
    /// The findings that are no failures, as messages: a large settling at the start, "needs friction".
    pub notes: Vec<String>,
    /// The indices in [`Plan::exemptions`](super::Plan::exemptions) of those that nothing needed, ascending.
    pub unneeded_exemptions: Vec<usize>,
    /// The least signed distance between links that may not touch, cells or struts, and of these from obstacles, m;
    /// `None` if none was measured, as for the other worst values.
    pub clearance: Option<Worst>,
    /// The least static stability margin (McGhee and Frank 1968), m: the distance of the centre of mass inside the
    /// support polygon, negative outside; `None` if none was measured.
    pub margin: Option<Worst>,
    /// The least 1 - effort / limit of joints and motors, with the best contact forces there are; `None` if none was
    /// measured.
    pub torque_margin: Option<Worst>,
    /// The least 1 - load / limit of bonds, with the best contact forces there are; `None` if none was measured.
    pub bond_margin: Option<Worst>,
    /// The least 1 - speed / limit of joints, cells or struts; `None` if none was measured.
    pub speed_margin: Option<Worst>,
    /// The greatest speed with which a link of a robot comes down on the ground, m/s, as a mean over 10 ms, or as the
    /// end of a rod that falls over where the robot tips over; `None` if none does, and where none was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub impact: Option<Worst>,
    /// The least angle between struts of a truss that share a node, rad; `None` if none was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle: Option<Worst>,
    /// The least singular value of the rigidity matrix of a truss (rows of unit vectors), without unit; `None` if none
    /// was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rigidity: Option<Worst>,
    /// The least 1 - force / limit of the struts of a truss, with the best distribution of forces that there is; `None` if
    /// none was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_margin: Option<Worst>,
    /// The least 1 - force / limit of the struts of a truss, with the forces of elastic struts that carry none where
    /// nothing loads them; `None` if none was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elastic_margin: Option<Worst>,
    /// The displacement of the base over the plan, x, y, z in the world, m; 0 for families without a base.
    pub travel: [f64; 3],
    /// The change of the base's heading, rad, counter-clockwise from above.
    pub heading: f64,
    /// The distance over the ground within which the end of `travel` is known, m; `None` where nothing is said of it, as
    /// under statics and without a ground.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub travel_within: Option<f64>,
    /// The angle within which `heading` is known, rad; `None` as for `travel_within`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heading_within: Option<f64>,
    /// The greatest slip of a loaded link over the ground, summed over the plan, m; `None` if none was measured.
    pub slip: Option<Worst>,
    /// The duration of the plan, s.
    pub duration: f64,
    /// The least mechanical work of the motors, quasi-static, J.
    pub energy: f64,
    /// The dynamic quantities of a lattice plan; `None` for other plans, and for one that was not judged to its end.
    pub dynamics: Option<Dynamics>,
    /// The number of samples judged, refinements included.
    pub samples: usize,
    /// The tip-overs and rolls, each as (time in s, event in words), in order of time.
    pub events: Vec<(f64, String)>,
    /// The verdicts on the robots of a plan that begins with several, one for each, in order of their first modules: what
    /// the others do to a robot is in its own. No part of a plan file, whose verdict is recomputed.
    #[serde(skip)]
    pub robots: Vec<RobotVerdict>,
}

/// The verdict on one of the robots of a plan, alone and docked with others.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotVerdict {
    /// The path name of the module that stands for the robot: it is the robot's for the whole plan.
    pub reference: String,
    /// The verdict on the clusters to which that module belongs. Travel and heading are those of the module.
    pub verdict: Verdict,
}

impl Verdict {
    /// Returns the bounds on `travel` and `heading` in words that follow these, as ` within 12mm`; lengths are rounded up to a
    /// millimetre and angles to a degree. Empty where nothing is said of them.
    pub fn bounds_in_words(&self) -> [String; 2] {
        [(self.travel_within, "mm"), (self.heading_within, "deg")].map(|(bound, name)| {
            bound.map_or_else(String::new, |bound| format!(" within {}", rounded_up(bound, name)))
        })
    }

    /// Returns true if nothing failed. Checks that were not made, or have no limit, do not count as failures; they
    /// are listed in `checks`.
    pub fn ok(&self) -> bool {
        self.failures.is_empty()
    }

    /// Returns the least margin in words: `least margin 12 % (torque)`, the least part of a limit that the loads of joints,
    /// bonds or struts leave. Without a measured load it is the least margin of stability, or else the least clearance; `None`
    /// if there is none of these. Speeds do not count: a motion takes the least time that they allow.
    pub fn least_margin(&self) -> Option<String> {
        let loads =
            [("torque", &self.torque_margin), ("bond", &self.bond_margin), ("force", &self.force_margin)];
        let measured = loads.into_iter().filter_map(|(name, worst)| Some((name, worst.as_ref()?.value)));
        if let Some((name, margin)) = measured.min_by(|(_, a), (_, b)| a.total_cmp(b)) {
            return Some(format!("least margin {} % ({name})", rounded(100.0 * margin, 1)));
        }
        let least = |name: &str, worst: &Option<Worst>| {
            let value = worst.as_ref()?.value;
            Some(format!("least {name} {}", quantity(value, Dimension::LENGTH)))
        };
        least("margin of stability", &self.margin).or_else(|| least("clearance", &self.clearance))
    }

    /// Returns the worst values that the verdict has, each with its row of [`WORST_VALUES`], in the order of the
    /// table.
    pub fn worst_values(&self) -> impl Iterator<Item = (WorstKind, &Worst)> {
        WORST_VALUES.into_iter().filter_map(|kind| (kind.of)(self).as_ref().map(|worst| (kind, worst)))
    }
}
