//! The designs of a declaration that were elaborated, found by their arguments.

use super::design::Design;
use super::value::Value;
use std::collections::BTreeMap;
use std::rc::Rc;

/// The designs of one declaration: one for each list of arguments.
#[derive(Clone, Default)]
pub struct Designs(BTreeMap<u64, Vec<Rc<Design>>>);

impl Designs {
    /// Returns the design with these arguments, one value for every parameter; `None` if there is none.
    pub fn find(&self, args: &[Value]) -> Option<Rc<Design>> {
        let alike = self.0.get(&key(args))?;
        alike.iter().find(|design| same_args(&design.args, args)).cloned()
    }

    /// Returns the first design, in no order that means anything, for whose arguments `is_wanted` is true.
    pub fn find_by(&self, is_wanted: impl Fn(&[Value]) -> bool) -> Option<Rc<Design>> {
        self.0.values().flatten().find(|design| is_wanted(&design.args)).cloned()
    }

    /// Adds a design.
    pub fn push(&mut self, design: Rc<Design>) {
        self.0.entry(key(&design.args)).or_default().push(design);
    }

    /// Removes a design, the very same one.
    pub fn remove(&mut self, design: &Rc<Design>) {
        if let Some(alike) = self.0.get_mut(&key(&design.args)) {
            alike.retain(|known| !Rc::ptr_eq(known, design));
        }
    }

    /// Removes all.
    pub fn clear(&mut self) {
        self.0.clear();
    }
}

/// Returns a number that is the same for arguments that are equal: that of their numbers and texts. Designs of one
/// declaration, of which there may be thousands, mostly differ in these.
fn key(args: &[Value]) -> u64 {
    const PRIME: u64 = 0x0100_0000_01b3;
    let mixed = |key: u64, word: u64| (key ^ word).wrapping_mul(PRIME).rotate_left(29);
    args.iter().fold(0xcbf2_9ce4_8422_2325, |key, arg| match (arg, arg.as_number()) {
        // Zero has two signs and is one number.
        (_, Some(number)) => mixed(key, (number + 0.0).to_bits()),
        (Value::Text(text), _) => text.bytes().fold(key, |key, byte| mixed(key, u64::from(byte))),
        _ => mixed(key, 0),
    })
}

fn same_args(a: &[Value], b: &[Value]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(x, y)| x.same(y) == Some(true))
}
