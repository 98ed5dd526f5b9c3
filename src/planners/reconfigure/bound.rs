//! A lower bound on the changes of connections: whichever module becomes which, a bond that stays joins the same faces of
//! shoes with the same turn.

use crate::planners::tosnake::{Bond, Robot};
use std::collections::BTreeMap;

/// Returns the least number of bonds that have to be docked or undocked to make one configuration of the other. Faces of
/// shoes and turns tell sorts of bonds apart; of each sort, as many as both have may stay, and each other one of either
/// has to be undocked or docked.
pub fn fewest_changes(from: &Robot, to: &Robot) -> usize {
    let sort = |bond: &Bond| {
        let (a, b) = (bond.a.face(), bond.b.face());
        (a.min(b), a.max(b), bond.turn)
    };
    let mut excess: BTreeMap<(usize, usize, u32), i64> = BTreeMap::new();
    from.held().for_each(|(_, bond)| *excess.entry(sort(bond)).or_default() += 1);
    to.held().for_each(|(_, bond)| *excess.entry(sort(bond)).or_default() -= 1);
    excess.values().map(|count| count.unsigned_abs() as usize).sum()
}
