//! Looking ahead: every manner of walking is tried for some steps, and the one that comes farthest in its
//! time is taken. Where all get stuck, what was second best a while ago is gone on with.

use super::locomote::{End, Manner, Walk};
use super::locomotion::Aim;
use std::collections::VecDeque;

/// Choices that are remembered, to go back to.
const CHOICES_KEPT: usize = 12;
/// How often it goes back in all.
const RETURNS_MAX: usize = 20;

/// A walk with how it ended, if it did.
type Tried<'a> = (Walk<'a>, Option<End>);

/// The walk to its end.
pub fn best<'a>(walk: Walk<'a>, going: &dyn Fn(usize) -> bool) -> Walk<'a> {
    let mut others: VecDeque<Vec<Tried<'a>>> = VecDeque::new();
    let mut returns = 0;
    // The one that came farthest of those that got stuck.
    let mut stuck: Option<Walk<'a>> = None;
    let mut now = walk;
    loop {
        let mut tried: Vec<Tried<'a>> = Vec::new();
        for manner in manners(&now) {
            let mut walk = now.clone();
            walk.manner = manner;
            let end = walk.go(now.wish.ahead, going);
            if matches!(end, Some(End::Cancelled | End::Steps)) {
                return ended(walk, end);
            }
            tried.push((walk, end));
        }
        // From the best to the worst; of equal ones the first.
        let worth = |(walk, _): &Tried| pace(&now, walk);
        tried.sort_by(|a, b| worth(b).total_cmp(&worth(a)));
        let (open, closed): (Vec<_>, Vec<_>) =
            tried.into_iter().partition(|(_, end)| matches!(end, None | Some(End::Arrived)));
        for (walk, end) in closed {
            if stuck.as_ref().is_none_or(|known| walk.left() < known.left()) {
                stuck = Some(ended(walk, end));
            }
        }
        others.push_back(open);
        if others.len() > CHOICES_KEPT {
            others.pop_front();
        }
        let next = loop {
            match others.back_mut() {
                None => return alone(stuck.unwrap_or(now), going),
                Some(open) if open.is_empty() => {
                    others.pop_back();
                    returns += 1;
                    if returns > RETURNS_MAX {
                        return alone(stuck.unwrap_or(now), going);
                    }
                }
                Some(open) => break open.remove(0),
            }
        };
        now = match next {
            (walk, None) => walk,
            (walk, end) => return ended(walk, end),
        };
    }
}

/// Where every choice got stuck, on with easier steps as without looking ahead.
fn alone<'a>(mut walk: Walk<'a>, going: &dyn Fn(usize) -> bool) -> Walk<'a> {
    walk.patient = true;
    let end = walk.go(usize::MAX, going);
    ended(walk, end)
}

fn ended(mut walk: Walk, end: Option<End>) -> Walk {
    walk.travel.end = end.unwrap_or(End::Steps);
    walk
}

/// How it goes now, with the other objectives, and with nodes put down before it rolls.
fn manners(walk: &Walk) -> Vec<Manner> {
    let Manner { aim, impact } = walk.manner;
    let own = walk.wish.aim;
    let aims = [aim, own, Aim::Springs, Aim::LENGTHS, Aim::RESTORING];
    let mut found: Vec<Manner> = Vec::new();
    let falls = aims.into_iter().map(|aim| Manner { aim, impact: walk.wish.impact });
    for manner in [Manner { aim, impact }].into_iter().chain(falls).chain([Manner { aim, impact: false }]) {
        if !found.contains(&manner) {
            found.push(manner);
        }
    }
    found
}

/// How much nearer to the end of its path a walk came, by the time that it took, m/s.
fn pace(from: &Walk, to: &Walk) -> f64 {
    (from.left() - to.left()) / (to.travel.lasts - from.travel.lasts).max(f64::MIN_POSITIVE)
}
