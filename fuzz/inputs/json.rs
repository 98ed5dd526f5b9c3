//! JSON altered at its places: numbers, names, lists and objects that are others.

use super::dice::Dice;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// A JSON text with its places by kind: a place's kind has stars for numbers.
pub struct Altered {
    /// The text as it is right.
    pub file: Value,
    kinds: Vec<(String, Vec<String>)>,
}

impl Altered {
    /// Returns the places of a file.
    pub fn new(file: Value) -> Altered {
        let mut places = BTreeMap::new();
        collect("", "", &file, &mut places);
        Altered { file, kinds: places.into_iter().collect() }
    }

    /// Alters a file once, and returns the alteration in words. `parts`: the beginnings of places, of which one is chosen.
    pub fn alter(&self, file: &mut Value, dice: &mut Dice, parts: &[&str]) -> String {
        let part = dice.of(parts);
        let kinds: Vec<_> = self.kinds.iter().filter(|(kind, _)| kind.starts_with(part)).collect();
        let kinds = if kinds.is_empty() { self.kinds.iter().collect() } else { kinds };
        let (_, places) = kinds[dice.below(kinds.len())];
        let place = &places[dice.below(places.len())];
        let other = &places[dice.below(places.len())];
        let twin = self.file.pointer(other).cloned().unwrap_or_default();
        let Some(value) = file.pointer_mut(place) else { return format!("{place} is gone") };
        let before = value.clone();
        match value {
            Value::Number(number) => *value = altered_number(number, twin, dice),
            Value::Bool(flag) => *value = json!(!*flag),
            Value::String(_) => *value = if dice.below(3) == 0 { json!("") } else { twin },
            Value::Null => {
                *value = [json!(0.0), json!(1), json!([]), json!([0.0, 1.0])][dice.below(4)].clone()
            }
            Value::Array(list) => alter_list(list, twin, dice),
            Value::Object(map) => {
                let keys: Vec<String> = map.keys().cloned().collect();
                match (dice.below(3), keys.is_empty()) {
                    (0, false) => drop(map.remove(&keys[dice.below(keys.len())])),
                    (1, false) => drop(map.insert(keys[dice.below(keys.len())].clone(), Value::Null)),
                    _ => *value = twin,
                }
            }
        }
        let short = |value: &Value| value.to_string().chars().take(60).collect::<String>();
        format!("{place}: {} -> {}", short(&before), file.pointer(place).map_or_else(String::new, short))
    }
}

fn collect(place: &str, kind: &str, value: &Value, places: &mut BTreeMap<String, Vec<String>>) {
    if !place.is_empty() {
        places.entry(kind.to_owned()).or_default().push(place.to_owned());
    }
    match value {
        Value::Object(map) => {
            map.iter().for_each(|(key, value)| {
                collect(&format!("{place}/{key}"), &format!("{kind}/{key}"), value, places)
            });
        }
        Value::Array(list) => {
            list.iter()
                .enumerate()
                .for_each(|(i, value)| collect(&format!("{place}/{i}"), &format!("{kind}/*"), value, places));
        }
        _ => {}
    }
}

fn altered_number(number: &serde_json::Number, twin: Value, dice: &mut Dice) -> Value {
    let x = number.as_f64().unwrap_or(0.0);
    if number.is_i64() || number.is_u64() {
        let n = number.as_i64().unwrap_or(i64::MAX);
        let near = [
            n.wrapping_add(1),
            n.wrapping_sub(1),
            -n.max(-i64::MAX),
            n.wrapping_mul(2),
            0,
            i64::MAX,
            i64::MIN,
            1 << 40,
        ];
        return match dice.below(10) {
            k @ 0..8 => json!(near[k]),
            8 => twin,
            _ => json!(x + 0.5),
        };
    }
    match dice.below(16) {
        0 => json!(-x),
        1 => json!(2.0 * x),
        2 => json!(x / 2.0),
        3 => json!(1.01 * x),
        4 => json!(0.99 * x),
        5 => json!(x * (1.0 + 1e-12)),
        6 => json!(0.0),
        7 => json!(1e308),
        8 => json!(-1e308),
        9 => json!(1e20),
        10 => json!(1e-300),
        11 => json!(x + 1.0),
        12 => json!(100.0 * x),
        13 => json!(1e3),
        14 => twin,
        _ => json!(x + 1e-3),
    }
}

fn alter_list(list: &mut Vec<Value>, twin: Value, dice: &mut Dice) {
    let (i, j) = (dice.below(list.len().max(1)), dice.below(list.len().max(1)));
    match dice.below(6) {
        _ if list.is_empty() => *list = twin.as_array().cloned().unwrap_or_default(),
        0 => drop(list.remove(i)),
        1 => list.insert(i, list[j].clone()),
        2 => list.swap(i, j),
        3 => list.reverse(),
        4 => list.clear(),
        _ => *list = twin.as_array().cloned().unwrap_or_default(),
    }
}
