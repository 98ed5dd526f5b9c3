//! Pairs that are judged once, where a window of time begins: those whose distance no joint changes, and links inside
//! others' meshes.

use super::advancement::{Advancement, Instant, Region, inner_pair};
use super::bodies::Body;
use super::separation::BodyPair;
use crate::geometry::Vec3;
use crate::interrupt;

impl Advancement<'_> {
    /// Judges, at the time (s) at which a window begins, the pairs within a module whose distance no joint changes:
    /// it is known from the module type.
    pub(super) fn fixed_pairs(&mut self, region: &Region, time: f64) {
        self.state.interval.middle = time;
        for &(module, _) in &region.kinematics.tree.order {
            let first = self.bodies.of(module).start;
            for index in 0..self.bodies.inner(module).len() {
                let inner = self.bodies.inner(module)[index];
                let Some(distance) = inner.fixed else { continue };
                let pair = inner_pair(&inner, first, 0);
                self.count(&pair, distance, time);
                if distance < -inner.allowed {
                    self.collide(region, &pair, distance, Some(Instant::default()));
                }
            }
        }
    }

    /// Judges the links that rigid bonds join, which stay at the nominal pose: a collision is recorded if their
    /// overlap there is deeper than allowed.
    pub(super) fn rigid_bonds(&mut self, region: &Region) {
        for ((x, y), bonded) in region.bonded.iter().filter(|(_, bonded)| bonded.rigid) {
            let bodies = self.bodies.first_of_link(x).zip(self.bodies.first_of_link(y));
            let Some((a, b)) = bodies.filter(|_| bonded.overlap > 0.0) else { continue };
            let (one, other) = (&self.bodies.bodies[a], &self.bodies.bodies[b]);
            let touch = self.bodies.allowed_depth(one.module, other.module);
            let allowed = bonded.allowed(one, other, touch);
            if bonded.overlap > allowed {
                let (a, b) = (a as u32, b as u32);
                let pair = BodyPair { a, b, level: 0, counts: false, allowed, normal: Vec3::zeros() };
                self.collide(region, &pair, -bonded.overlap, Some(Instant { bond: Some(bonded.bond) }));
            }
        }
    }

    /// Judges if a link is inside another's mesh that is not convex, of which only the surface has bodies. It is
    /// judged at the instant `time` (s) at which the window begins, whose state must be set: later no link gets there
    /// but through the surface.
    pub(super) fn enclosed(&mut self, region: &Region, time: f64) {
        let modules = || region.kinematics.tree.order.iter().map(|(module, _)| *module);
        let enclosing: Vec<usize> = modules().filter(|module| self.bodies.may_enclose(*module)).collect();
        if !enclosing.is_empty() {
            let links = modules().flat_map(|module| region.kinematics.links_of(module));
            links.for_each(|link| self.state.require(&region.kinematics, link));
        }
        for &m in &enclosing {
            let mut pairs: Vec<BodyPair> = Vec::new();
            let first = self.bodies.of(m).start;
            let inner = self.bodies.inner_enclosing(m).iter();
            pairs.extend(inner.map(|inner| inner_pair(inner, first, 0)));
            self.work.spend(region.kinematics.tree.order.len());
            // Of two modules that may both enclose links each pair is examined once.
            for n in modules().filter(|n| *n > m || (*n < m && !self.bodies.may_enclose(*n))) {
                let [a, b] = [m, n].map(|module| self.state.links[region.kinematics.link(module, 0)].p);
                if (a - b).norm() < self.bodies.reach[m] + self.bodies.reach[n] {
                    self.expand_links(region, m.min(n), m.max(n), &mut pairs);
                }
            }
            for pair in pairs {
                interrupt::checkpoint();
                let depth = self.enclosed_depth(region, &pair);
                if depth > pair.allowed {
                    self.count(&pair, -depth, time);
                    self.collide(region, &pair, -depth, Some(Instant::default()));
                }
            }
        }
    }

    /// Appends one pair of bodies for each pair of links of two modules that no rigid bond joins.
    fn expand_links(&self, region: &Region, m: usize, n: usize, out: &mut Vec<BodyPair>) {
        for a in self.bodies.first_of_links(m) {
            for b in self.bodies.first_of_links(n) {
                out.extend(self.pair_of_modules(region, 0, (a, b)));
            }
        }
    }

    /// Returns how deep one of the links of a pair of bodies is inside the other's mesh that is not convex, m.
    fn enclosed_depth(&self, region: &Region, pair: &BodyPair) -> f64 {
        let [a, b] = [pair.a, pair.b].map(|body| &self.bodies.bodies[body as usize]);
        let local = |body: &Body| (body.module, body.link - region.kinematics.link(body.module, 0));
        self.bodies.enclosed_depth(local(a), local(b), &self.state.relative(a.link, b.link))
    }
}
