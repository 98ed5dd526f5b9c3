//! The direct way of a robot that rests on a floor: of all that are found, the shortest that the judge accepts.

use super::{NoStandingWay, Refusal, Report, Search, Way, common_part, direct};
use crate::geometry::Vec3;
use crate::optimize::random::SplitMix64;
use crate::plan;
use crate::planners::Solution;
use crate::planners::tosnake::stance::{Hindrances, Stance};
use crate::planners::tosnake::{SearchStatus, Task};
use std::sync::Arc;

/// Greatest number of rests of the goal from which the way is looked for backwards.
const STARTS_MAX: usize = 2;

impl Search<'_> {
    /// Plans the direct way of a robot that rests on the floor at the start and at the goal of the problem. `drawn`: the goal
    /// as it was drawn.
    pub(super) fn standing(&mut self, drawn: &Task) -> Result<Solution<Report>, Refusal> {
        let problem = self.problem;
        let ends = [problem.from.unwinding(problem.world), problem.to.unwinding(problem.world)];
        let first = Task::new(&ends[0], &self.settings.search).map_err(Refusal::From)?;
        let second = Task::new(&ends[1], &self.settings.search).map_err(Refusal::To)?;
        let start_rests = first.gravity.iter().map(|gravity| gravity.down).collect::<Vec<_>>();
        let goal_rests = second.rests(drawn);
        let name = &problem.from.robot.name;
        self.progress.task_started(&|| format!("a way on the floor for {name}"));
        let (mut status, mut hindrances) = (SearchStatus::default(), Hindrances::default());
        let mut ways = Vec::new();
        for backwards in [false, true] {
            let (start, goal) = ((&first, &start_rests[..]), (&second, &goal_rests[..]));
            let (from, to) = if backwards { (goal, start) } else { (start, goal) };
            let (found, noted) = self.ways_on_floor(from, to, &mut status);
            ways.extend(found.into_iter().map(|found| (found, backwards)));
            hindrances.falls += noted.falls;
            hindrances.overloads += noted.overloads;
            // The other modules have other names.
            if !backwards {
                hindrances.least_overload = noted.least_overload;
            }
        }
        ways.sort_by(|p, q| p.0.duration.total_cmp(&q.0.duration));
        let rejected = ways.len();
        for (found, backwards) in ways {
            let ends = if backwards { (&second, &first) } else { (&first, &second) };
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

    /// Returns a way on the floor for each correspondence and rest at the start for which one is found, and what hindered
    /// others. `from`, `to`: the ends with the rests that they may have, as unit vectors of gravity in the frame of the shoe that their gravity models name.
    fn ways_on_floor(
        &mut self,
        (from, from_rests): (&Task, &[Vec3]),
        (to, to_rests): (&Task, &[Vec3]),
        status: &mut SearchStatus,
    ) -> (Vec<direct::Found>, Hindrances) {
        let settings = &self.settings.standing;
        let own = from.gravity.as_ref().expect("what stands has a weight");
        let held = to.gravity.as_ref().expect("what stands has a weight").held;
        let stance = Stance::new(Arc::new(own.clone()), own.held, own.down);
        let all = common_part::correspondences(from.start(), to.start(), settings.correspondences_max);
        let all = all.iter().filter(|all| all.exchanges <= settings.exchanges_max);
        let mut found = Vec::new();
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
            found.extend(search.run(self.progress));
            (status.work, status.tried) = (status.work + search.work, status.tried + search.tried);
        }
        let hindrances = stance.hindrances.lock().expect("no search panicked").clone();
        (found, hindrances)
    }
}
