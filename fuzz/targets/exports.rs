//! Plans in the formats of other programs, and as pictures.

use crate::fuzz::inputs::dice::Dice;
use crate::fuzz::inputs::plans::{ARTICULATED, LATTICE, TRUSS, nearly_right};
use modl::exchange::{Export, ExportFile, ImportFile, PLAN_FORMATS, import, trajectories};
use modl::plan::{Plan, file, sliced, validation};

/// The formats that are pictures.
const PICTURES: &[&str] = &["gif", "frames"];

/// Returns a plan file that can be read more often than not.
pub fn input(dice: &mut Dice) -> Vec<u8> {
    let family = match dice.below(8) {
        0 => &LATTICE,
        1 => &TRUSS,
        _ => &ARTICULATED,
    };
    nearly_right(family, dice)
}

/// Returns the files of a plan in the formats of a kind.
fn written(plan: &Plan, pictures: bool) -> Vec<ExportFile> {
    let export = Export { picture_size: DRAWN_SIZE, ..Export::new(plan, "a <title> & \"more\"", "plan") };
    let formats = PLAN_FORMATS.iter().filter(|format| PICTURES.contains(&format.name) == pictures);
    formats.flat_map(|format| format.write(&export).unwrap_or_default()).collect()
}

/// Writes a plan in all formats but pictures; what is written is well formed.
pub fn check(input: &[u8]) {
    let Ok(plan) = file::read(&String::from_utf8_lossy(input)) else { return };
    let files = written(&plan, false);
    for file in &files {
        let text = || std::str::from_utf8(&file.bytes).expect("it is text");
        let ending = file.name.rsplit('.').next().unwrap_or("");
        match ending {
            "xml" | "urdf" => {
                if let Err(error) = roxmltree::Document::parse(text()) {
                    panic!("{}: {error}\n{}", file.name, text());
                }
            }
            "json" => drop(serde_json::from_str::<serde_json::Value>(text()).expect("it is JSON")),
            "csv" => is_table(&file.name, text()),
            "glb" => is_scene(&file.bytes),
            "mcap" => is_recording(&file.bytes),
            _ => {}
        }
        if ending == "urdf" {
            comes_in(file, &files);
        }
    }
    if let Ok(all) = trajectories(&plan) {
        for trajectory in all {
            let times: Vec<u64> = trajectory.points.iter().map(|point| point.nanoseconds).collect();
            assert!(
                times.windows(2).all(|pair| pair[0] < pair[1]),
                "times of a trajectory increase: {times:?}"
            );
            let count = trajectory.joints.len();
            assert!(trajectory.points.iter().all(|point| point.positions.len() == count));
        }
    }
}

/// The part of a plan that is drawn, s: a picture takes longer than everything else.
const DRAWN: f64 = 0.1;

/// The width and height of pictures, pixels: small ones have as many ways to go wrong.
const DRAWN_SIZE: (u16, u16) = (24, 16);

/// Draws the beginning of a plan as moving pictures.
pub fn pictures(input: &[u8]) {
    let Ok(plan) = file::read(&String::from_utf8_lossy(input)) else { return };
    // A lattice is not cut within a stage.
    let Ok(plan) = sliced(&plan, 0.0, DRAWN) else { return };
    if validation::check(&plan).is_err() {
        return;
    }
    for file in written(&plan, true) {
        let begins: &[&[u8]] = &[b"GIF89a", b"\x89PNG\r\n"];
        assert!(begins.iter().any(|begin| file.bytes.starts_with(begin)), "{} is no picture", file.name);
    }
}

/// Checks that all lines of a table have as many fields, and that numbers are finite.
fn is_table(name: &str, text: &str) {
    let fields = |line: &str| {
        // Commas within quotes part nothing.
        let mut quoted = false;
        line.chars()
            .filter(|c| {
                *c == '"' && {
                    quoted = !quoted;
                    false
                } || *c == ',' && !quoted
            })
            .count()
    };
    let wide: Vec<usize> = text.lines().map(fields).collect();
    assert!(wide.windows(2).all(|pair| pair[0] == pair[1]), "{name}: lines of different lengths\n{text}");
    let mut words = text.lines().skip(1).flat_map(|line| line.split(','));
    assert!(words.all(|word| !["NaN", "inf", "-inf"].contains(&word)), "{name}: a number that is not finite");
}

/// Checks the frame of a scene in glTF, and that its buffer is as long as it says.
fn is_scene(bytes: &[u8]) {
    let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes")) as usize;
    assert!(bytes.starts_with(b"glTF") && number(4) == 2 && number(8) == bytes.len());
    let long = number(12);
    let json: serde_json::Value = serde_json::from_slice(&bytes[20..20 + long]).expect("the scene is JSON");
    let buffer = json["buffers"][0]["byteLength"].as_u64().unwrap_or(0) as usize;
    let rest = bytes.len() - 20 - long;
    assert!(rest == 0 && buffer == 0 || rest >= 8 + buffer, "the buffer is shorter than it says");
    for view in json["bufferViews"].as_array().into_iter().flatten() {
        let end = view["byteOffset"].as_u64().unwrap_or(0) + view["byteLength"].as_u64().unwrap_or(0);
        assert!(end as usize <= buffer, "a view is longer than its buffer");
    }
    for accessor in json["accessors"].as_array().into_iter().flatten() {
        let ends = [&accessor["min"], &accessor["max"]];
        assert!(
            ends.iter()
                .flat_map(|list| list.as_array().into_iter().flatten())
                .all(serde_json::Value::is_number)
        );
    }
}

/// Checks that all messages of a recording are read, and that their times do not decrease.
fn is_recording(bytes: &[u8]) {
    let stream = mcap::MessageStream::new(bytes).expect("it is a recording");
    let mut before = 0;
    for message in stream {
        let message = message.expect("a message is read");
        assert!(before <= message.log_time, "times do not decrease");
        before = message.log_time;
    }
}

/// Checks that a description that was written comes in again.
fn comes_in(file: &ExportFile, files: &[ExportFile]) {
    let text = String::from_utf8_lossy(&file.bytes);
    let mut beside = |name: &str| {
        let found = files.iter().find(|file| name.ends_with(&file.name));
        found.map(|file| file.bytes.clone())
    };
    if let Err((_, fault)) = import(&[ImportFile { name: "plan.urdf", text: &text }], &mut beside) {
        panic!("a description that was written does not come in: {fault}\n{text}");
    }
}
