//! Self-collision over a whole plan: at every instant and not only at samples. The method is exact collision checking
//! by bisection with motion bounds (Schwarzer, Saha and Latombe 2005), a conservative advancement (Mirtich 1996) from
//! the middle of each interval.
//!
//! An interval of time is examined in its middle, where everything is known exactly; the motion until its ends is
//! bounded by motion bounds. Pairs that are thereby proved to be separated for the whole interval are discarded;
//! with the others the interval is halved. Far modules are separated over long intervals, near bodies over short
//! ones, and a pair between which nothing moves at once; whole clusters of modules are separated together. Intervals
//! are visited in order of time, so that the first penetration that is found is the first.
//!
//! A proof that a pair is not nearer than the clearance found so far serves both purposes, for
//! collisions and for the clearance.
//!
//! An interval in which the joints move as in an earlier one is not examined: the cycle of a gait is proved once.

use super::advancement::Advancement;
use super::bodies::{Bodies, UnsoundLink};
use super::docking;
use super::polyline::Polyline;
use super::repetition::Repetition;
use super::tolerances::{Precision, Tolerances};
use crate::geometry::Solid;
use crate::interrupt;
use crate::plan::tolerances::TOLERANCES;
use crate::plan::{
    CheckKind, DockingKind, Exemption, ExemptionKind, Failure, Settings, Status, Tracks, Worst,
};
use crate::robot::{Assembly, Bond, PortRef};
use crate::units::{Dimension, quantity};

/// The collisions and the clearance of a plan, as [`judge`] finds them.
#[derive(Clone, Debug, PartialEq)]
pub struct Findings {
    /// The status of the check: proved; within tolerance, if links penetrate by no more than `touch`; exempt, if
    /// every collision is excused; failed; or, where the judge gave up, the number of intervals examined.
    pub status: Status,
    /// The collisions, in order of time; one for each pair of modules, and one more if an earlier or later one of
    /// the pair is excused.
    pub collisions: Vec<Collision>,
    /// The least signed distance of links that may not touch, m; `None` if there are no two such, or no such
    /// distance was measured.
    pub clearance: Option<Worst>,
    /// The number of intervals examined.
    pub samples: usize,
    /// Indices in the plan's list of the exemptions that excused something, ascending.
    pub used: Vec<usize>,
}

/// A collision: a penetration of two modules, or of two links of one, deeper than is allowed.
#[derive(Clone, Debug, PartialEq)]
pub struct Collision {
    /// The modules, by their indices in the assembly; the same twice for two links of one module.
    pub modules: (usize, usize),
    /// The links that penetrate first, one of each of `modules`, by their indices in their modules.
    pub links: (usize, usize),
    /// The first instant of a penetration deeper than allowed, s.
    pub time: f64,
    /// The greatest penetration depth of the two modules' links that was found, m.
    pub depth: f64,
    /// The time of the greatest depth, s.
    pub deepest: f64,
    /// The allowed penetration depth of the two links, m.
    pub allowed: f64,
    /// True if an exemption of the plan excuses the collision.
    pub exempt: bool,
    /// The index in the assembly of the bond at whose nominal pose the links penetrate each other; `None` if a motion
    /// brings them there.
    pub bond: Option<usize>,
}

/// Returns the collisions and the clearance of a plan's body over all instants, by exact collision checking with
/// motion bounds (Schwarzer, Saha and Latombe 2005), a form of conservative advancement (Mirtich 1996). `tracks` must
/// be valid, or it panics; `exemptions`: those of the plan. `settings`: the settings of the judge; `precision`: how
/// deep and how early penetrations are found.
///
/// # Errors
/// [`UnsoundLink`] for the first link whose shape is not sound.
pub fn judge(
    tracks: &Tracks,
    settings: &Settings,
    exemptions: &[Exemption],
    precision: &Precision,
) -> Result<Findings, UnsoundLink> {
    Ok(planned(tracks, &Bodies::of_plan(tracks)?, settings, exemptions, (precision, Span::of(tracks))))
}

/// Returns the collisions and the clearance as [`judge`] does, with the robot's bodies already compiled. `tracks`
/// must be valid, or it panics.
pub(super) fn planned(
    tracks: &Tracks,
    bodies: &Bodies,
    settings: &Settings,
    exemptions: &[Exemption],
    (precision, span): (&Precision, Span),
) -> Findings {
    let mut advancement = Advancement::new(tracks, bodies, *precision, settings.samples_max);
    advancement.repetition = Repetition::new(tracks, span.from);
    search(tracks, exemptions, span, advancement)
}

/// Returns the collisions, without a clearance, of a robot whose joints follow `along` instead of the plan, at the
/// instants of `along` and not between. Collisions that do not depend on joints are among them. `tracks` must be
/// valid, or it panics; `exemptions`: those of the plan. The two halves of the time are searched beside each other,
/// each with half of the work that is allowed.
pub(super) fn deflected(
    tracks: &Tracks,
    bodies: &Bodies,
    settings: &Settings,
    exemptions: &[Exemption],
    (along, span): (&Polyline, Span),
) -> Findings {
    let middle = span.from + (span.to - span.from) / 2.0;
    let half = |span: Span| {
        let along = along.clone();
        let samples_max = settings.samples_max / 2;
        search(tracks, exemptions, span, Advancement::deflected(tracks, bodies, along, samples_max))
    };
    let (before, after) =
        interrupt::join(|| half(Span { to: middle, ..span }), || half(Span { from: middle, ..span }));
    before.and(after)
}

fn search(tracks: &Tracks, exemptions: &[Exemption], span: Span, mut advancement: Advancement) -> Findings {
    let mut bonds = tracks.start.bonds.clone();
    let mut docks = tracks.events.iter().peekable();
    for window in windows(tracks, exemptions, span) {
        while let Some(dock) = docks.next_if(|dock| dock.time <= window.0) {
            bonds[dock.bond] = dock.kind == DockingKind::Dock;
        }
        let excused = excused(exemptions, span, window);
        advancement.window(&bonds, window, &excused);
    }
    advancement.findings(exemptions)
}

/// Returns the status of the check of collisions. `gave_up`: the number of intervals examined where a search gave up;
/// `clearance`: the least signed distance found, m; `None` where none was.
pub(super) fn status(gave_up: Option<usize>, collisions: &[Collision], clearance: Option<f64>) -> Status {
    match gave_up {
        Some(samples) => Status::Sampled(samples),
        None if collisions.iter().any(|c| !c.exempt) => Status::Failed,
        None if !collisions.is_empty() => Status::Exempt,
        None if clearance.is_some_and(|distance| distance <= -TOLERANCES.reported_zero) => {
            Status::WithinTolerance
        }
        None => Status::Proved,
    }
}

impl Findings {
    /// Returns these findings, of which none is a clearance, with those of a search in later time.
    fn and(mut self, later: Findings) -> Findings {
        for collision in later.collisions {
            let is_known = |known: &&mut Collision| {
                (known.modules, known.exempt) == (collision.modules, collision.exempt)
            };
            match self.collisions.iter_mut().find(is_known) {
                Some(known) if collision.depth > known.depth => {
                    (known.depth, known.deepest) = (collision.depth, collision.deepest);
                }
                Some(_) => {}
                None => self.collisions.push(collision),
            }
        }
        self.used.extend(later.used);
        self.used.sort_unstable();
        self.used.dedup();
        self.samples += later.samples;
        let gave_up = [&self.status, &later.status].into_iter().any(|s| matches!(s, Status::Sampled(_)));
        self.status = status(gave_up.then_some(self.samples), &self.collisions, None);
        self
    }
}

impl Collision {
    /// Returns the failure of the check of collisions that this collision is, with a message and without blame;
    /// `robot`: the one that was judged. Panics if it has no such modules, links or bond.
    pub fn failure(&self, robot: &Assembly) -> Failure {
        let module = |m: usize| robot.modules[m].name.clone();
        let link = |m: usize, l: usize| robot.module_type(m).links[l].name.as_str();
        let (a, b) = (module(self.modules.0), module(self.modules.1));
        let links = (link(self.modules.0, self.links.0), link(self.modules.1, self.links.1));
        let depth = quantity(self.depth, Dimension::LENGTH);
        // The depth is that of its worst instant, which comes later.
        let message = match self.bond {
            _ if self.modules.0 == self.modules.1 => {
                format!("{} and {} of {a} meet, up to {depth} deep", links.0, links.1)
            }
            None => format!("{a} and {b} meet, up to {depth} deep ({} and {})", links.0, links.1),
            Some(bond) => {
                let (name, why) = (robot.bond_name(bond), reason(robot, bond));
                format!(
                    "{a} and {b} meet, {depth} deep ({} and {}), as {name} docks them{why}",
                    links.0, links.1
                )
            }
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

/// Returns in words why the links of a bond overlap more than they may: the depth of its ports beneath the surfaces
/// of their links, if one is deeper than `touch`; else that a shape reaches in deeper than the connector explains, and
/// how to say that it is meant. A port on the surface of a part is not beneath the pin that stands there.
fn reason(robot: &Assembly, bond: usize) -> String {
    let port_depth = |at: PortRef| {
        let kind = robot.module_type(at.module);
        let port = &kind.ports[at.port];
        let solid = Solid::new(&kind.links[port.link].collides).ok()?;
        let origin = port.pose.translation.vector;
        let depth = solid.depth_of(&origin);
        let words = quantity(depth, Dimension::LENGTH);
        (depth > kind.touch && !solid.has_on_surface(&origin, kind.touch))
            .then(|| format!("{} lies {words} beneath the surface of its link", robot.port_name(at)))
    };
    let Bond { a, b, .. } = robot.bonds[bond];
    let found: Vec<String> = [a, b].into_iter().filter_map(port_depth).collect();
    if !found.is_empty() {
        return format!("; {}", found.join(", "));
    }
    let explained = docking::tolerated(robot, bond, &Tolerances::default()).distance;
    let explained = quantity(explained, Dimension::LENGTH);
    format!(
        "; the connector explains {explained} of that (`capture`): leave a pin that reaches in out of `collides`, or \
         state `touch` as deep as it is"
    )
}

/// The interval of time over which a robot is judged, in s from the start of the plan.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    /// The time from which the robot is judged.
    pub from: f64,
    /// The time up to which the robot is judged.
    pub to: f64,
    /// The end of the plan, which is never excused.
    pub end: f64,
}

impl Span {
    /// Returns the whole plan of a body.
    fn of(tracks: &Tracks) -> Span {
        Span { from: 0.0, to: tracks.duration, end: tracks.duration }
    }
}

/// Returns the interval cut where bonds change and where exemptions begin or end, and the instant of the plan's end,
/// which is never excused and in which the last docks hold.
fn windows(tracks: &Tracks, exemptions: &[Exemption], span: Span) -> Vec<(f64, f64)> {
    let docks = tracks.events.iter().map(|d| d.time);
    let excused = exemptions.iter().filter(|e| matches!(e.kind, ExemptionKind::Collision(_)));
    let mut cuts: Vec<f64> = docks
        .chain(excused.flat_map(|e| [e.from, e.to]))
        .filter(|t| *t > span.from && *t < span.to)
        .chain([span.from, span.to])
        .collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    let mut windows: Vec<(f64, f64)> = cuts.windows(2).map(|w| (w[0], w[1])).collect();
    windows.push((span.to, span.to));
    windows
}

/// Returns the exemptions that hold all through a window.
fn excused(exemptions: &[Exemption], span: Span, window: (f64, f64)) -> Vec<Excuse> {
    let end = window.0 == window.1 && window.0 == span.end;
    let holding = exemptions.iter().enumerate().filter(|(_, e)| e.from <= window.0 && window.1 <= e.to);
    let of = |(index, e): (usize, &Exemption)| match e.kind {
        ExemptionKind::Collision(modules) if !end => Some(Excuse { index, modules }),
        _ => None,
    };
    holding.filter_map(of).collect()
}

/// An exemption from collisions that holds all through a window of time.
#[derive(Clone, Copy, Debug)]
pub struct Excuse {
    /// The index of the exemption in the plan's list.
    pub index: usize,
    /// The two modules that the exemption is about, by their indices in the assembly; `None`: any.
    pub modules: Option<(usize, usize)>,
}

impl Excuse {
    /// Returns true if the exemption excuses a collision of these two modules, given by index in any order.
    pub fn covers(&self, a: usize, b: usize) -> bool {
        self.modules.is_none_or(|pair| pair == (a, b) || pair == (b, a))
    }
}
