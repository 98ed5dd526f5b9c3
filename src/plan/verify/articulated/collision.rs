//! Self-collision over a whole plan, at every instant and not only at samples.
//!
//! A interval of time is looked at in its middle, where everything is known exactly; what can happen
//! until its ends is bounded (`frame`). Pairs that are thereby told apart for the
//! whole interval are done with; with the others the interval is halved. Far modules are told apart
//! over long stretches, near bodies over short ones, and a pair between which nothing moves at once.
//! Stretches are visited in order of time, so that the first penetration that is met is the first.
//!
//! A proof that a pair is not nearer than the clearance found so far serves both questions, for
//! collisions and for the clearance.

use super::advancement::Advancement;
use super::bodies::{Bodies, UnsoundLink};
use crate::plan::{CheckKind, DockKind, Exemption, ExemptionKind, Failure, Settings, Status, Tracks, Worst};
use crate::robot::{Assembly, Kinematics};
use crate::units::{Dimension, quantity};

/// How exactly collisions are judged.
#[derive(Clone, Copy, Debug)]
pub struct Precision {
    /// Penetration is proved to be no deeper than `touch` and this, m. Default 1 µm: far below any
    /// `touch`, well above rounding.
    pub tol_depth: f64,
    /// The clearance, and the depth of a collision, are within this of the true ones, m. Default
    /// 20 µm: halving it costs √2 times as many stretches.
    pub tol_clearance: f64,
    /// A first penetration (by more than `touch` and `tol_depth`) is found no later than this after
    /// it began, s. Default 1 µs: below a tick of any controller.
    pub tol_time: f64,
}

impl Default for Precision {
    fn default() -> Precision {
        Precision { tol_depth: 1e-6, tol_clearance: 2e-5, tol_time: 1e-6 }
    }
}

/// What the judge found.
#[derive(Clone, Debug, PartialEq)]
pub struct Findings {
    pub status: Status,
    /// In order of time; one for each pair of modules, and one more where it was excused before.
    pub collisions: Vec<Collision>,
    /// Least signed distance of links that may not touch. `None` where there are no two such.
    pub clearance: Option<Worst>,
    /// Stretches looked at.
    pub samples: usize,
    /// Indices of the exemptions that excused something.
    pub used: Vec<usize>,
}

/// Two modules in each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Collision {
    pub modules: (usize, usize),
    /// The links that penetrate first, by their indices in their modules.
    pub links: (usize, usize),
    /// First instant of a penetration deeper than allowed, s.
    pub time: f64,
    /// Greatest depth of the two modules' links while it lasts, m, and when.
    pub depth: f64,
    pub deepest: f64,
    /// How deep they may be in each other, m.
    pub allowed: f64,
    /// Whether it is excused: it lies within an exemption.
    pub exempt: bool,
}

/// Judges all instants of a plan's body.
pub fn judge(
    tracks: &Tracks,
    settings: &Settings,
    exemptions: &[Exemption],
    precision: &Precision,
) -> Result<Findings, UnsoundLink> {
    let everything = Kinematics::new(&tracks.robot, &tracks.start.bonds, 0);
    let bodies = Bodies::new(&tracks.robot, &everything)?;
    let mut advancement = Advancement::new(tracks, bodies, *precision, settings.samples_max);
    let mut bonds = tracks.start.bonds.clone();
    let mut docks = tracks.docks.iter().peekable();
    for window in windows(tracks, exemptions) {
        while let Some(dock) = docks.next_if(|dock| dock.time <= window.0) {
            bonds[dock.bond] = dock.kind == DockKind::Dock;
        }
        let excused = excused(tracks, exemptions, window);
        advancement.window(&bonds, window, &excused);
    }
    Ok(advancement.findings(exemptions))
}

impl Collision {
    /// In words, for the report.
    pub fn failure(&self, robot: &Assembly) -> Failure {
        let module = |m: usize| robot.modules[m].name.clone();
        let link = |m: usize, l: usize| robot.module_type(m).links[l].name.as_str();
        let (a, b) = (module(self.modules.0), module(self.modules.1));
        let links = (link(self.modules.0, self.links.0), link(self.modules.1, self.links.1));
        let depth = quantity(self.depth, Dimension::LENGTH);
        // The depth is that of its worst instant, which comes later.
        let message = if self.modules.0 == self.modules.1 {
            format!("{} and {} of {a} meet, up to {depth} deep", links.0, links.1)
        } else {
            format!("{a} and {b} meet, up to {depth} deep ({} and {})", links.0, links.1)
        };
        Failure {
            kind: CheckKind::Collision,
            time: self.time,
            until: None,
            at: if a == b { vec![a] } else { vec![a, b] },
            message,
            value: self.depth,
            limit: self.allowed,
            blame: vec![],
            blames_start: false,
        }
    }
}

/// The plan cut where bonds change and where exemptions begin or end, and the instant of its end,
/// which is never excused and in which the last docks hold.
fn windows(tracks: &Tracks, exemptions: &[Exemption]) -> Vec<(f64, f64)> {
    let docks = tracks.docks.iter().map(|d| d.time);
    let excused = exemptions.iter().filter(|e| matches!(e.kind, ExemptionKind::Collision(_)));
    let mut cuts: Vec<f64> = docks
        .chain(excused.flat_map(|e| [e.from, e.to]))
        .filter(|t| *t > 0.0 && *t < tracks.duration)
        .chain([0.0, tracks.duration])
        .collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    let mut windows: Vec<(f64, f64)> = cuts.windows(2).map(|w| (w[0], w[1])).collect();
    windows.push((tracks.duration, tracks.duration));
    windows
}

/// The exemptions that hold all through a window.
fn excused(tracks: &Tracks, exemptions: &[Exemption], window: (f64, f64)) -> Vec<Excuse> {
    let end = window.0 == window.1 && window.0 == tracks.duration;
    let holding = exemptions.iter().enumerate().filter(|(_, e)| e.from <= window.0 && window.1 <= e.to);
    let of = |(index, e): (usize, &Exemption)| match e.kind {
        ExemptionKind::Collision(modules) if !end => Some(Excuse { index, modules }),
        _ => None,
    };
    holding.filter_map(of).collect()
}

/// An exemption from collisions that holds at the moment.
#[derive(Clone, Copy, Debug)]
pub struct Excuse {
    pub index: usize,
    /// `None`: of any modules.
    pub modules: Option<(usize, usize)>,
}

impl Excuse {
    pub fn covers(&self, a: usize, b: usize) -> bool {
        self.modules.is_none_or(|pair| pair == (a, b) || pair == (b, a))
    }
}
