//! The direct way of a robot that rests on a floor: of all that are found, the shortest that the judge accepts.

use super::{Configuration, NoStandingWay, Refusal, Report, Search, Way, common_part, direct};
use crate::geometry::Vec3;
use crate::optimize::random::SplitMix64;
use crate::plan;
use crate::planners::Solution;
use crate::planners::tosnake::stance::{Hindrances, Stance};
use crate::planners::tosnake::state::State;
use crate::planners::tosnake::{SearchStatus, Task};
use std::sync::Arc;

/// Greatest number of rests of a robot from which the way is looked for.
const STARTS_MAX: usize = 2;

/// A way on the floor.
struct StandingWay {
    found: direct::Found,
    /// True if it was looked for from the goal to the start.
    backwards: bool,
    /// The rest in which the way begins: the unit vector of gravity in the frame of the shoe that the gravity model of
    /// the problem's start names.
    rest: Vec3,
}

impl Search<'_> {
    /// Plans the direct way of a robot that rests on the floor. `first`, `second`: the start and the goal of the
    /// problem.
    pub(super) fn standing(&mut self, first: &Task, second: &Task) -> Result<Solution<Report>, Refusal> {
        let first_rests = first.rests().map_err(Refusal::From)?;
        let second_rests = second.rests().map_err(Refusal::To)?;
        let name = &self.problem.from.robot.name;
        self.progress.task_started(&|| format!("a way on the floor for {name}"));
        let (mut status, mut hindrances) = (SearchStatus::default(), Hindrances::default());
        let mut ways = Vec::new();
        for backwards in [false, true] {
            let (start, goal) = ((first, &first_rests[..]), (second, &second_rests[..]));
            let (from, to) = if backwards { (goal, start) } else { (start, goal) };
            let (found, noted) = self.ways_on_floor(from, to, &mut status);
            ways.extend(found.into_iter().map(|(found, from_rest, to_rest)| {
                let rest = if backwards { to_rest } else { from_rest };
                StandingWay { found, backwards, rest }
            }));
            hindrances.falls += noted.falls;
            hindrances.overloads += noted.overloads;
            // The other modules have other names.
            if !backwards {
                hindrances.least_overload = noted.least_overload;
            }
        }
        ways.sort_by(|p, q| p.found.duration.total_cmp(&q.found.duration));
        let rejected = ways.len();
        for StandingWay { found, backwards, rest } in ways {
            let laid = first.laid(rest);
            let start = Configuration { state: &laid, ..self.problem.from }.unwinding(self.problem.world);
            let first = &Task::new(&start, &self.settings.search).map_err(Refusal::From)?;
            let ends = if backwards { (second, first) } else { (first, second) };
            let (plan, halves, kept) = self.direct_plan(ends, found, (status, backwards))?;
            let verdict = plan::verify::verify(&plan);
            if verdict.ok() {
                let way = kept.map_or(Way::Turning, |kept| Way::Standing { kept });
                return Ok(self.solution(plan, (&halves[0], &halves[1]), way, Some(verdict)));
            }
        }
        let stopped = !self.progress.should_continue();
        Err(Refusal::NoStandingWay(NoStandingWay { hindrances, status, rejected, stopped }))
    }

    /// Returns a way on the floor for each correspondence and rest at the start for which one is found, with the rests
    /// in which it begins and ends, and what hindered others. `from`, `to`: the ends with the rests that they may have,
    /// as by [`Task::rests`].
    fn ways_on_floor(
        &mut self,
        (from, from_rests): (&Task, &[Vec3]),
        (to, to_rests): (&Task, &[Vec3]),
        status: &mut SearchStatus,
    ) -> (Vec<(direct::Found, Vec3, Vec3)>, Hindrances) {
        let settings = &self.settings.standing;
        let own = from.gravity.as_ref().expect("what stands has a weight");
        let held = to.gravity.as_ref().expect("what stands has a weight").held;
        let stance = Stance::new(Arc::new(own.clone()), own.held, own.down);
        let all = common_part::correspondences(from.start(), to.start(), settings.correspondences_max);
        let all = all.iter().filter(|all| all.exchanges <= settings.exchanges_max);
        let mut ways = Vec::new();
        for (correspondence, &down) in
            all.flat_map(|all| from_rests.iter().take(STARTS_MAX).map(move |down| (all, down)))
        {
            let shoe = correspondence.shoe(held);
            let end = |&down: &Vec3| Stance { shoe, down, ..stance.clone() };
            let ends: Vec<Stance> = to_rests.iter().map(end).collect();
            let mut search = direct::Search {
                start: from.start(),
                correspondence,
                stance: Some(&Stance { down, ..stance.clone() }),
                ends: &ends,
                pace: &|module, joint, turn| from.turn_duration(module, joint, turn),
                settings,
                ik: settings.inverse_kinematics,
                rng: SplitMix64(self.settings.search.seed),
                limit: f64::INFINITY,
                work: 0,
                tried: 0,
            };
            if let Some(found) = search.run(self.progress) {
                let end = found.end.as_ref().expect("it stands at the end");
                let to_rest = end.down_at(&State::new(correspondence.goal.clone()), shoe);
                ways.push((found, down, to_rest));
            }
            (status.work, status.tried) = (status.work + search.work, status.tried + search.tried);
        }
        let hindrances = stance.hindrances.lock().expect("no search panicked").clone();
        (ways, hindrances)
    }
}
