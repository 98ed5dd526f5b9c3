//! Files of the SMORES tools: configurations, structures of them, gaits, and the XML of VSPARC; then damaged.

use super::damage::{damaged, damaged_lines, damaged_numbers};
use super::dice::Dice;
use std::fmt::Write;

const QUATERNIONS: &[&str] =
    &["1 0 0 0", "0 0 0 1", "0.7071067811865476 0 0 0.7071067811865476", "0.6 0 0.8 0"];

/// Returns the files of an import, each behind its name.
pub fn files(dice: &mut Dice) -> Vec<u8> {
    let many = 1 + dice.below(4);
    let harm = |dice: &mut Dice, text: String| match dice.below(8) {
        0..4 => text,
        4 => damaged_lines(dice, &text),
        5 | 6 => damaged_numbers(dice, &text),
        _ => damaged(dice, &text),
    };
    let mut files: Vec<(String, String)> = Vec::new();
    match dice.below(3) {
        0 => {
            let text = configuration(dice, many);
            files.push(("my row.conf".to_owned(), harm(dice, text)));
        }
        1 => {
            let text = structure(dice, many);
            files.push(("walker.struct".to_owned(), harm(dice, text)));
            let text = configuration(dice, many);
            files.push(("row.conf".to_owned(), harm(dice, text)));
        }
        _ => {
            let text = vsparc(dice, many);
            files.push(("state.xml".to_owned(), harm(dice, text)));
        }
    }
    if dice.below(2) == 1 {
        let of_vsparc = files[0].0 == "state.xml";
        let text = if of_vsparc { vsparc_behavior(dice, many) } else { gait(dice, many) };
        let name = if of_vsparc { "nod.xml" } else { "wave 2.gait" };
        files.push((name.to_owned(), harm(dice, text)));
    }
    let all: Vec<(&str, &[u8])> = files.iter().map(|(name, text)| (name.as_str(), text.as_bytes())).collect();
    super::files::joined(&all)
}

fn angle(dice: &mut Dice) -> String {
    match dice.below(12) {
        0 => "0".to_owned(),
        1 => "1.5707963".to_owned(),
        2 => "-1.5707963".to_owned(),
        _ => format!("{}", dice.below(3001) as f64 / 1000.0 - 1.5),
    }
}

/// Returns a row of modules, each with its top at the bottom of the one before.
fn configuration(dice: &mut Dice, many: usize) -> String {
    let mut text = "<?xml version=\"1.0\" ?>\n<configuration>\n<modules>\n".to_owned();
    let straight = dice.below(3) > 0;
    for module in 0..many {
        let tilt = if straight { "0".to_owned() } else { angle(dice) };
        let turn = if straight { QUATERNIONS[0] } else { dice.of(QUATERNIONS) };
        let _ = writeln!(
            text,
            "<module>\n<name>Module_{module}</name>\n<position>0 {} 0 {turn}</position>\n<joints>{} {} {} {tilt}</joints>\n\
             <path>SMORE.sdf</path>\n</module>",
            0.1 * module as f64,
            angle(dice),
            angle(dice),
            angle(dice)
        );
    }
    text.push_str("</modules>\n<connections>\n");
    for module in 1..many {
        let (node1, node2) = if straight { (3, 0) } else { (dice.below(4), dice.below(4)) };
        let _ = writeln!(
            text,
            "<connection><module1>Module_{}</module1><module2>Module_{module}</module2><node1>{node1}</node1><node2>{node2}\
             </node2><distance>0.0</distance><angle>{}</angle></connection>",
            module - 1,
            dice.of(&["0", "90", "-180", "270"])
        );
    }
    text + "</connections>\n</configuration>\n"
}

/// Returns a structure of rows, whose modules are joined by links.
fn structure(dice: &mut Dice, many: usize) -> String {
    let component = |id: usize| {
        format!(
            "<Component><component_id>leg {id}</component_id><file_path>/robots/parts/row.conf</file_path></Component>"
        )
    };
    let parts = 1 + dice.below(3);
    let mut text = "<Structure>\n<Components>\n".to_owned();
    (0..parts).for_each(|id| text.push_str(&format!("{}\n", component(id))));
    text.push_str("</Components>\n<Links>\n");
    for id in 1..parts {
        let _ = writeln!(
            text,
            "<Link><link_id>{id}</link_id><component1>{}</component1><component2>{}</component2><module1>Module_{}</module1>\
             <module2>Module_{}</module2><node1>{}</node1><node2>{}</node2><distance>0.0</distance><angle>{}</angle></Link>",
            component(dice.below(id)),
            component(id),
            dice.below(many),
            dice.below(many),
            dice.below(4),
            dice.below(4),
            dice.of(&["0", "90"])
        );
    }
    text + "</Links>\n</Structure>\n"
}

fn gait(dice: &mut Dice, many: usize) -> String {
    let command = |dice: &mut Dice| match dice.below(4) {
        0 => "i".to_owned(),
        1 => format!("s{}", angle(dice)),
        _ => format!("p{}", angle(dice)),
    };
    let mut text = String::new();
    for _ in 0..dice.below(8) {
        if dice.below(6) == 0 {
            let (a, b) = (dice.below(many), dice.below(many));
            let _ = write!(text, "$ {} &Module_{a} &Module_{b} ", dice.of(&["+", "-"]));
            if dice.below(2) == 1 {
                let _ = write!(text, "#{} #{} ", dice.below(4), dice.below(4));
            }
        } else {
            let all = [0; 4].map(|_| command(dice)).join(" ");
            let _ = write!(text, "Module_{} {all} ", dice.below(many));
        }
        if dice.below(2) == 1 {
            let _ = write!(text, "[{}] ", 100 * dice.below(40));
        }
        if dice.below(2) == 1 {
            let _ = write!(text, "{{{}}} ", dice.of(&["a", "b", "c"]));
        }
        if dice.below(3) == 1 {
            let _ = write!(text, "({}) ", dice.of(&["a", "b", "c", "START"]));
        }
        text.push_str(dice.of(&[";\n", "; // so\n", "; "]));
    }
    text
}

fn state(dice: &mut Dice, many: usize, rest: bool) -> String {
    let mut text = "<period>3</period>\n<ModuleStates>\n".to_owned();
    for module in 0..many {
        let _ = writeln!(
            text,
            "<ModuleState name=\"S_{module}\"><position><x>{module}</x><y>0</y><z>0</z></position>\n\
             <rotation><x>0.7071068</x><y>0</y><z>0</z><w>-0.7071068</w></rotation><period>3</period><JointCommands>"
        );
        for name in ["FrontWheel", "LeftWheel", "RightWheel", "Body"] {
            if dice.below(3) == 0 {
                continue;
            }
            let kind = if rest { "Position" } else { dice.of(&["Position", "Velocity", "Position"]) };
            let _ = writeln!(
                text,
                "<JointCommand name=\"{name}\"><commandType>{kind}</commandType><targetValue>{}</targetValue><period>{}</period>\
                 <parametricValue>{}</parametricValue></JointCommand>",
                if rest && name == "Body" { 0 } else { dice.below(161) as i64 - 80 },
                dice.below(5),
                dice.of(&["0", "speed", "1e9"])
            );
        }
        text.push_str("</JointCommands><PartStates/></ModuleState>\n");
    }
    text + "</ModuleStates>\n"
}

/// Returns a row of modules of VSPARC, the back of each at the front of the next.
fn vsparc(dice: &mut Dice, many: usize) -> String {
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"Windows-1252\"?>\n<RobotStateObject name=\"\">\n<anchorModuleName>S_0</anchorModuleName>\n{}\
         <Connections>\n",
        state(dice, many, true)
    );
    for module in 1..many {
        let _ = writeln!(
            text,
            "<Connection><moduleName1>S_{module}</moduleName1><moduleName2>S_{}</moduleName2><nodeName1>{}</nodeName1>\
             <nodeName2>{}</nodeName2><distance>0</distance><angle>{}</angle></Connection>",
            module - 1,
            dice.of(&["BackPlate", "BackPlate", "LeftWheel"]),
            dice.of(&["FrontWheel", "FrontWheel", "RightWheel"]),
            dice.of(&["0", "0", "90"])
        );
    }
    text + "</Connections>\n</RobotStateObject>\n"
}

fn vsparc_behavior(dice: &mut Dice, many: usize) -> String {
    let mut text = "<Behavior name=\"\">\n<RobotStates>\n".to_owned();
    for _ in 0..1 + dice.below(4) {
        text.push_str("<RobotState name=\"x\">\n");
        text.push_str(&state(dice, many, false));
        text.push_str("<Connections/></RobotState>\n");
    }
    text + "</RobotStates>\n</Behavior>\n"
}
