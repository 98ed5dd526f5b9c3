//! A thousand random changes: text and picture stay one, and each is undone to the byte.

use super::edits::{document, model};
use crate::support::numbers::Numbers;
use modl::interrupt::CancelState;
use modl::live::{Document, Edit, Model, Refusal, Robot, Setting};

/// Changes that are made in all.
const CHANGES: usize = 1000;

/// Changes of one text before the next one is taken: robots grow by them.
const CHANGES_OF_ONE: usize = 20;

/// A joint is set to whole hundredths of a degree or a millimetre, which are written exactly.
const STEPS: f64 = 100.0;

const TEXTS: [(&str, &str); 4] = [
    ("Walker", include_str!("texts/walker.mod")),
    ("Arm", include_str!("texts/arm.mod")),
    ("Sheet", include_str!("texts/sheet.mod")),
    ("Comb", include_str!("texts/comb.mod")),
];

/// A random change of what is shown; `None` where there is nothing of its kind.
fn any(robot: &Robot, numbers: &mut Numbers) -> Option<Edit> {
    let name = robot.name.clone();
    match numbers.below(3) {
        0 if !robot.parameters.is_empty() => {
            let parameter = &robot.parameters[numbers.below(robot.parameters.len())];
            let steps = ((parameter.high - parameter.low) / parameter.step).round();
            let number = parameter.low + (numbers.next() * steps).round() * parameter.step;
            let value = match parameter.truth {
                true => Setting::Bool(numbers.below(2) == 1),
                false => Setting::Number((number * 1e6).round() / 1e6),
            };
            let (behavior, own) = (parameter.behavior.clone(), parameter.name.clone());
            Some(Edit::Parameter { robot: name, behavior, name: own, value })
        }
        1 if !robot.joints.is_empty() => {
            let joint = &robot.joints[numbers.below(robot.joints.len())];
            let unit = if joint.turns { std::f64::consts::PI / 180.0 } else { 1e-3 };
            let (low, high) = joint.range.unwrap_or((-200.0 * unit, 200.0 * unit));
            let value = (numbers.between(low, high) / unit * STEPS).trunc() / STEPS * unit;
            Some(Edit::Joint { robot: name, joint: joint.name.clone(), value })
        }
        2 if !robot.ports.is_empty() => {
            let port = &robot.ports[numbers.below(robot.ports.len())];
            let offer = &robot.offers[*port.offers.get(numbers.below(port.offers.len().max(1)))?];
            let (part, at) = (offer.part.clone(), offer.port.clone());
            let turn = numbers.below(port.turns as usize) as u32;
            Some(Edit::Dock { robot: name, port: port.name.clone(), part, at, turn })
        }
        _ => None,
    }
}

/// The bytes that two texts have in common at the begin and at the end.
fn common(a: &str, b: &str) -> (usize, usize) {
    let same = |a: &mut dyn Iterator<Item = u8>, b: &mut dyn Iterator<Item = u8>| {
        a.zip(b).take_while(|(x, y)| x == y).count()
    };
    let first = same(&mut a.bytes(), &mut b.bytes());
    let shorter = a.len().min(b.len()) - first;
    let last = same(&mut a.bytes().rev().take(shorter), &mut b.bytes().rev().take(shorter));
    (first, last)
}

/// Asserts that a change touched the bytes of its node alone.
fn touches_its_node(before: &str, after: &str, robot: &Robot, edit: &Edit) {
    let (first, last) = common(before, after);
    let gone = first..before.len() - last;
    let within = |start: usize, end: usize| start <= gone.start && gone.end <= end;
    match edit {
        Edit::Parameter { behavior, name, .. } => {
            let own = robot.parameters.iter().find(|p| p.name == *name && p.behavior == *behavior);
            let place = own.expect("it was shown").place;
            assert!(before == after || within(place.start, place.end), "{edit:?}\n{after}");
        }
        Edit::Joint { joint, .. } => {
            match robot.joints.iter().find(|known| known.name == *joint).and_then(|joint| joint.place) {
                Some(place) => {
                    assert!(before == after || within(place.start, place.end), "{edit:?}\n{after}")
                }
                None => assert!(gone.is_empty(), "{edit:?}\n{after}"),
            }
        }
        Edit::Dock { port, .. } => {
            // Two clauses more, and all bytes that were there in their order.
            let mut left = after.bytes();
            assert!(before.bytes().all(|byte| left.any(|other| other == byte)), "{edit:?}\n{after}");
            let count = |text: &str, word: &str| text.matches(word).count();
            for word in ["part ", "connect ", &format!("connect {port} -- ")] {
                assert_eq!(count(after, word), count(before, word) + 1, "{edit:?}\n{after}");
            }
            assert_eq!(count(after, " set "), count(before, " set "));
        }
    }
}

/// Asserts that what is shown after a change is what was asked for.
fn shows(before: &Robot, after: &Robot, edit: &Edit) {
    assert_eq!(after.picture["body"]["modules"].as_array().map(Vec::len), Some(after.modules.len()));
    match edit {
        Edit::Parameter { behavior, name, value, .. } => {
            let own = after.parameters.iter().find(|p| p.name == *name && p.behavior == *behavior);
            let shown = own.expect("it is still there").value;
            let wanted = match value {
                Setting::Bool(value) => f64::from(u8::from(*value)),
                Setting::Number(value) => *value,
            };
            assert_eq!(shown, Some(wanted), "{edit:?}");
        }
        Edit::Joint { joint, value, .. } => {
            let own = after.joints.iter().find(|known| known.name == *joint).expect("it is still there");
            assert!((own.value - value).abs() < 1e-9, "{edit:?}: {}", own.value);
            let drawn = after.picture["body"]["start"][own.index].as_f64().expect("a number");
            assert!((drawn - value).abs() < 1e-5, "{edit:?}: {drawn}");
            assert_eq!(after.modules, moved(&before.modules, &after.modules), "no module came or went");
        }
        Edit::Dock { port, at, .. } => {
            assert!(after.modules.len() > before.modules.len());
            assert!(before.ports.iter().any(|free| free.name == *port));
            assert!(after.ports.iter().all(|free| free.name != *port), "`{port}` and `{at}` are docked");
            let bonds = |robot: &Robot| robot.picture["body"]["bonds"].as_array().map_or(0, Vec::len);
            assert!(bonds(after) > bonds(before));
        }
    }
}

/// The modules as they were, with the places of those that they are now.
fn moved(before: &[modl::live::Module], after: &[modl::live::Module]) -> Vec<modl::live::Module> {
    let with = |(old, new): (&modl::live::Module, &modl::live::Module)| modl::live::Module {
        name: old.name.clone(),
        parts: new.parts.clone(),
    };
    before.iter().zip(after).map(with).collect()
}

/// Makes a change, undoes it and makes it again; returns what is shown then, or `None` if it was refused.
fn change(document: &mut Document, before: &Model, edit: &Edit) -> Option<Model> {
    let cancel = CancelState::default();
    let robot = before.robot.as_ref().expect("the text is sound");
    let text = document.text().to_owned();
    let (next, after) = match document.edited(document.version(), edit, before, &cancel) {
        Ok(found) => found,
        Err(Refusal::Refused(why)) => {
            assert!(!why.is_empty() && document.text() == text);
            return None;
        }
        Err(Refusal::Outdated) => panic!("nothing else changes the text"),
    };
    touches_its_node(&text, &next, robot, edit);
    assert!(after.error().is_none());
    shows(robot, after.robot.as_ref().expect("the changed text is sound"), edit);
    document.accept(next.clone());
    let undone = document.moved(document.version(), false).expect("it was just made");
    assert_eq!(undone, text, "{edit:?}");
    document.accept_move(undone, false);
    let again = document.moved(document.version(), true).expect("it was just undone");
    assert_eq!(again, next, "{edit:?}");
    document.accept_move(again, true);
    Some(after)
}

#[test]
fn a_thousand_random_changes_keep_text_and_picture_one() {
    let mut numbers = Numbers(27);
    let (mut made, mut refused, mut kinds) = (0, 0, [0; 3]);
    while made < CHANGES {
        let (name, text) = TEXTS[(made / CHANGES_OF_ONE) % TEXTS.len()];
        let mut document = document(text);
        let mut shown = model(&document, name);
        assert_eq!(shown.error(), None, "{name}");
        let first = made;
        let mut done = 0;
        while made < first + CHANGES_OF_ONE {
            let Some(edit) = any(shown.robot.as_ref().expect("sound"), &mut numbers) else { continue };
            match change(&mut document, &shown, &edit) {
                None => refused += 1,
                Some(after) => {
                    shown = after;
                    made += 1;
                    done += 1;
                    kinds[match edit {
                        Edit::Parameter { .. } => 0,
                        Edit::Joint { .. } => 1,
                        Edit::Dock { .. } => 2,
                    }] += 1;
                }
            }
            assert!(refused < 4 * CHANGES, "{refused} changes were refused");
        }
        // The page shows in the end what the text says, read afresh; and all of it is undone.
        let fresh = serde_json::to_value(model(&document, name)).expect("it is data");
        assert_eq!(serde_json::to_value(&shown).expect("it is data"), fresh);
        for _ in 0..done {
            let undone = document.moved(document.version(), false).expect("it can be undone");
            document.accept_move(undone, false);
        }
        assert_eq!(document.text(), text);
    }
    println!("{made} changes (defaults, joints, docked parts: {kinds:?}), {refused} refused");
    assert!(kinds.iter().all(|count| *count > CHANGES / 10), "{kinds:?}");
}
