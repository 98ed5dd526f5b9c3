//! What the judge found: every check with its status, worst values, and failures with their causes.

use super::cause::CauseId;
use crate::units::number;
use crate::units::{Dimension, quantity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CheckKind {
    /// Whether the plan is well formed, and could be judged at all.
    Form,
    Conflict,
    Collision,
    JointRange,
    Speed,
    Acceleration,
    Torque,
    BondLoad,
    Docking,
    Connectedness,
    Closure,
    Ground,
    Stability,
    Slip,
    Rest,
    /// Of lattices: nothing outside pushes or turns the robot.
    Momentum,
}

impl CheckKind {
    /// As people are told.
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
        }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Status {
    /// Holds at every instant.
    Proved,
    /// Holds at this many samples; between them nothing is proved.
    Sampled(usize),
    NotChecked(String),
    /// The library states no limit to check against.
    NoLimit,
    /// Failures were excused by an exemption that stands in the source.
    Exempt,
    Failed,
}

impl std::fmt::Display for Status {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Status::Proved => f.write_str("proved"),
            Status::Sampled(n) => write!(f, "sampled({n})"),
            Status::NotChecked(why) => write!(f, "not checked: {why}"),
            Status::NoLimit => f.write_str("no limit stated"),
            Status::Exempt => f.write_str("exempt"),
            Status::Failed => f.write_str("failed"),
        }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Check {
    pub kind: CheckKind,
    pub status: Status,
}

/// A worst value with its time and the modules (or joints) it was found at.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Worst {
    /// SI; a margin is a fraction of the limit.
    pub value: f64,
    pub time: f64,
    /// Path names.
    pub at: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Failure {
    pub kind: CheckKind,
    /// Seconds.
    pub time: f64,
    /// Until when it lasts, where that was followed.
    pub until: Option<f64>,
    /// Path names of the modules, links or joints concerned.
    pub at: Vec<String>,
    /// The finding in words with units: `s[0].m[2] and s[1].m[0] meet, 3.1 mm deep`.
    pub message: String,
    /// Amount and limit in SI, where there is one of each.
    pub value: f64,
    pub limit: f64,
    /// The commands to blame, latest first, at most three: held still, each removes the failure.
    pub blame: Vec<CauseId>,
    /// Whether `blame` names the start pose (`set`, `connect`) instead of commands.
    pub blames_start: bool,
}

impl Failure {
    /// Of a plan that is not well formed, or that can't be judged as a whole.
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

/// What the cells of a lattice go through, by the forces that the judge found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dynamics {
    /// Greatest force over one contact along one axis, N.
    pub peak_force: f64,
    /// Greatest speed of a cell, m/s.
    pub peak_speed: f64,
    /// Greatest kinetic energy of all cells together, J.
    pub peak_energy: f64,
    /// Greatest angular momentum about the centre of mass, kg·m²/s.
    pub angular_momentum: f64,
    /// No motion between the same shapes under the same limits takes less, s.
    pub lower_bound: f64,
}

impl Dynamics {
    /// Names and words, for a plan that lasts so long, s.
    pub fn in_words(&self, duration: f64) -> [(&'static str, String); 5] {
        let ratio = if self.lower_bound > 0.0 { duration / self.lower_bound } else { 1.0 };
        let bound = quantity(self.lower_bound, Dimension::TIME);
        [
            (
                "lower bound",
                format!("{bound}; this takes {} times that", number(libm::round(ratio * 1e4) / 1e4)),
            ),
            ("peak force", quantity(self.peak_force, Dimension::FORCE)),
            ("peak speed", quantity(self.peak_speed, Dimension::SPEED)),
            ("peak energy", format!("{}J", number(self.peak_energy))),
            ("ang. momentum", quantity(self.angular_momentum, Dimension::ANGULAR_MOMENTUM)),
        ]
    }
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Verdict {
    pub checks: Vec<Check>,
    pub failures: Vec<Failure>,
    /// Things worth saying that are no failures: a large settling at the start, "needs friction".
    pub notes: Vec<String>,
    /// Indices of exemptions that nothing needed.
    pub unneeded_exemptions: Vec<usize>,
    /// Signed distance between links that may not touch, m.
    pub clearance: Option<Worst>,
    /// Distance of the centre of mass inside the support polygon, m.
    pub margin: Option<Worst>,
    /// 1 - load / limit, with the best contact forces there are.
    pub torque_margin: Option<Worst>,
    pub bond_margin: Option<Worst>,
    pub speed_margin: Option<Worst>,
    /// Of a truss: the least angle between struts that share a node, rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle: Option<Worst>,
    /// Of a truss: the least singular value of its rigidity matrix (rows of unit vectors).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rigidity: Option<Worst>,
    /// Displacement of the base over the plan, m.
    pub travel: [f64; 3],
    /// Change of the base's heading, rad.
    pub heading: f64,
    /// Greatest slip of a loaded link, summed over the plan, m.
    pub slip: Option<Worst>,
    pub duration: f64,
    /// Least mechanical work of the motors, quasi-static, J.
    pub energy: f64,
    /// Of a lattice.
    pub dynamics: Option<Dynamics>,
    /// Samples judged, refinements included.
    pub samples: usize,
    /// Tips and contacts, in order of time, in words.
    pub events: Vec<(f64, String)>,
}

impl Verdict {
    /// Whether nothing failed. What was not checked, or has no limit, is told apart in `checks`.
    pub fn ok(&self) -> bool {
        self.failures.is_empty()
    }
}
