//! Records as files: CSV that others read, numbers that come back, JSON with types.

use crate::support::desk::run_clean;
use serde_json::Value;

const LEGS: &str = r#"
record Leg { name: Text, bend: Angle, reach: Length?, load: Torque, n: Int }
let legs = [
  Leg(name: "a, \"b\"", bend: 30deg, reach: 250mm, load: 1N*m / 3, n: 3),
  Leg(name: "two\nlines", bend: 1rad / 7, reach: _, load: 2N*m, n: -4),
]
"#;

/// Reads CSV as RFC 4180 says: records of fields.
fn read(csv: &str) -> Vec<Vec<String>> {
    let (mut records, mut fields, mut field) = (vec![], vec![], String::new());
    let mut letters = csv.chars().peekable();
    let mut quoted = false;
    while let Some(letter) = letters.next() {
        match letter {
            '"' if quoted && letters.peek() == Some(&'"') => field.extend(letters.next()),
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(std::mem::take(&mut field)),
            '\r' if !quoted => {
                assert_eq!(letters.next(), Some('\n'), "lines end in CR LF");
                fields.push(std::mem::take(&mut field));
                records.push(std::mem::take(&mut fields));
            }
            letter => field.push(letter),
        }
    }
    assert!(!quoted && field.is_empty() && fields.is_empty(), "the last line ends");
    records
}

#[test]
fn a_table_has_units_in_its_head_and_reads_back() {
    let desk = run_clean(&format!("{LEGS}save(legs, \"legs.csv\")"));
    let records = read(desk.text("legs.csv"));
    // The second angle is no number of degrees exactly, or it is: the head says which.
    let (angle, factor) = match records[0][1].as_str() {
        "bend [rad]" => ("bend [rad]", 1.0),
        other => (other, std::f64::consts::PI / 180.0),
    };
    assert_eq!(records[0], ["name", angle, "reach [mm]", "load [N*m]", "n"]);
    assert_eq!((records[1][0].as_str(), records[2][0].as_str()), ("a, \"b\"", "two\nlines"));
    let bend = |row: usize| records[row][1].parse::<f64>().expect("a number") * factor;
    assert_eq!([bend(1), bend(2)], [30.0 * (std::f64::consts::PI / 180.0), 1.0 / 7.0]);
    assert_eq!((records[1][2].as_str(), records[2][2].as_str()), ("250", ""));
    assert_eq!(records[1][3].parse::<f64>(), Ok(1.0 / 3.0));
    assert_eq!((records[1][4].as_str(), records[2][4].as_str()), ("3", "-4"));
}

#[test]
fn heads_tell_energies_from_torques() {
    let text = "record A { work: Energy, load: Torque }\nlet as = [A(work: 3N*m, load: 4J)]\n\
                save(as, \"a.csv\")\nsave(as, \"a.json\")";
    let desk = run_clean(text);
    assert_eq!(desk.text("a.csv"), "work [J],load [N*m]\r\n3,4\r\n");
    let saved: Value = serde_json::from_str(desk.text("a.json")).expect("JSON");
    let dimension = |column: usize| saved["columns"][column]["dimension"].clone();
    assert_eq!([dimension(0), dimension(1)], ["Energy", "Torque"]);
}

#[test]
fn what_has_a_round_number_in_a_unit_is_saved_so() {
    let text = "record A { a: Angle, b: Length, t: Time }\n\
                save([A(a: 30deg, b: 76mm, t: 20ms), A(a: 45.5deg, b: 0.1mm, t: 0.5ms)], \"a.csv\")";
    assert_eq!(run_clean(text).text("a.csv"), "a [deg],b [mm],t [ms]\r\n30,76,20\r\n45.5,0.1,0.5\r\n");
}

#[test]
fn json_has_names_units_dimensions_and_values_in_si() {
    let desk = run_clean(&format!("{LEGS}save(legs, \"legs.json\")"));
    let table: Value = serde_json::from_str(desk.text("legs.json")).expect("JSON");
    assert_eq!(table["rows"], 2);
    let column = |i: usize| &table["columns"][i];
    assert_eq!((&column(0)["name"], &column(0)["unit"]), (&"name".into(), &Value::Null));
    assert_eq!(column(1)["dimension"], "Angle");
    assert_eq!(column(1)["unit"], "rad");
    assert_eq!(column(1)["values"][1], 1.0 / 7.0);
    assert_eq!((&column(2)["unit"], &column(2)["values"][0]), (&"m".into(), &0.25.into()));
    assert!(column(2)["values"][1].is_null());
    assert_eq!(column(4)["values"][1], -4);
}
