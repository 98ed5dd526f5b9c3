//! `.gait` files, also named `Commands`: what each module does, and what it waits for.
//!
//! `MODULE FRONT LEFT RIGHT CENTRE [MS] {LABEL} (WAITS) ;` commands a module: `p1.2` a position, `s1.2` a speed, `i` nothing;
//! `t` a torque, which is refused. `$ + &A &B #1 #2 ... ;` docks, `$ - &A &B ... ;` lets go. Each module executes its
//! commands in the order of the file, one when the one before is over; one that waits begins when all commands with that
//! label are over. A command with a time is over then, one without when its joints are there; a speed without a time lasts
//! 10 s. `//` begins a comment.

use super::super::import_fault::ImportFault;
use super::COMMANDS_MAX;
use super::order::{Arranged, Graph, Order, arrange};
use super::parts::{Action, Face, Place, Robot, tilt_fault};
use std::collections::BTreeMap;

/// The time for which a speed lasts that states none, s.
const SPEED_TIME: f64 = 10.0;
/// The distance within which a setpoint is where its joint stands, rad: files state seven digits.
const SAME: f64 = 1e-6;
/// The label for which the tools' files wait at the start, and which no command has.
const START: &str = "START";

/// A command as it stands in the file.
struct Command {
    place: Place,
    /// The module that executes it.
    module: usize,
    what: What,
    time: Option<f64>,
    label: Option<String>,
    waits: Option<String>,
}

/// The purpose of a command.
enum What {
    /// A position (`true`) or a speed for joints.
    Joints([Option<(bool, f64)>; 4]),
    Dock([(usize, Face); 2]),
    Undock([usize; 2]),
}

/// Returns the actions of a gait, in their order.
pub(super) fn read(text: &str, robot: &mut Robot) -> Result<Graph<Action>, ImportFault> {
    let commands = commands(text, robot)?;
    let order = order(&commands, robot);
    let Arranged { graph, layered } = arrange(commands.len(), order).map_err(|command| {
        let command = &commands[command];
        let name = &robot.members[command.module].name;
        fault(command.place, format!("this command of `{name}` waits for commands that wait for it"))
    })?;
    if layered {
        robot.notes.push(
            "some commands wait for each other in a way that series and parallel parts can't say: a part of them waits longer \
             than the file asks"
                .to_owned(),
        );
    }
    let actions = actions(&commands, robot)?;
    Ok(filled(&graph, &actions))
}

fn fault(place: Place, message: impl Into<String>) -> ImportFault {
    ImportFault { message: message.into(), line: place.0, column: place.1 }
}

/// Returns a graph with the actions of each command in its place.
fn filled(graph: &Graph<usize>, actions: &[Vec<Action>]) -> Graph<Action> {
    match graph {
        Graph::One(command) => Graph::Parallel(actions[*command].iter().cloned().map(Graph::One).collect()),
        Graph::Series(parts) => Graph::Series(parts.iter().map(|part| filled(part, actions)).collect()),
        Graph::Parallel(parts) => Graph::Parallel(parts.iter().map(|part| filled(part, actions)).collect()),
    }
}

/// Reads the commands of a file.
fn commands(text: &str, robot: &Robot) -> Result<Vec<Command>, ImportFault> {
    let names = robot.index();
    let mut commands = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let line = line.split("//").next().unwrap_or("");
        let (mut from, mut column) = (0, 1);
        for (at, _) in line.match_indices(';') {
            let words = words(&line[from..at], number + 1, column)?;
            column += line[from..=at].chars().count();
            from = at + 1;
            if !words.is_empty() {
                commands.push(command(&words, &names)?);
            }
            if commands.len() > COMMANDS_MAX {
                return Err(fault((number + 1, 1), format!("more than {COMMANDS_MAX} commands")));
            }
        }
        if let Some(first) = words(&line[from..], number + 1, column)?.first() {
            return Err(fault(first.place, "a command ends with `;`"));
        }
    }
    match commands.is_empty() {
        true => Err(ImportFault::of_file("there are no commands")),
        false => Ok(commands),
    }
}

/// A word of a command with its bracket, if it stands in one.
struct Word<'t> {
    bracket: Option<char>,
    text: &'t str,
    place: Place,
}

/// Returns the words of a command. `line`: its line, from 1; `column`: where it begins there, in characters, from 1.
fn words(text: &str, line: usize, mut column: usize) -> Result<Vec<Word<'_>>, ImportFault> {
    let mut words = Vec::new();
    let mut at = 0;
    while let Some(begin) = text[at..].find(|c: char| !c.is_whitespace()).map(|more| at + more) {
        column += text[at..begin].chars().count();
        let place = (line, column);
        let rest = &text[begin..];
        let first = rest.chars().next().unwrap_or(' ');
        let closing = [('[', ']'), ('{', '}'), ('(', ')')].into_iter().find(|(open, _)| *open == first);
        let (word, length) = match closing {
            Some((open, close)) => {
                let Some(end) = rest.find(close) else {
                    return Err(fault(place, format!("`{open}` without `{close}`")));
                };
                (Word { bracket: Some(open), text: rest[1..end].trim(), place }, end + 1)
            }
            None => {
                let end = rest.find(|c: char| c.is_whitespace() || "[{(".contains(c)).unwrap_or(rest.len());
                (Word { bracket: None, text: &rest[..end], place }, end)
            }
        };
        words.push(word);
        at = begin + length;
        column += text[begin..at].chars().count();
    }
    Ok(words)
}

fn command(words: &[Word], names: &BTreeMap<&str, usize>) -> Result<Command, ImportFault> {
    let place = words[0].place;
    let bracket = |open: char| {
        let mut found = words.iter().filter(|word| word.bracket == Some(open));
        let first = found.next();
        match found.next() {
            Some(second) => Err(fault(second.place, format!("a second `{open}` in one command"))),
            None => Ok(first),
        }
    };
    let time = match bracket('[')? {
        None => None,
        Some(word) => Some(milliseconds(word)?),
    };
    let named = |word: &Word| {
        if word.text.is_empty() {
            Err(fault(word.place, "a name is wanted"))
        } else {
            Ok(word.text.to_owned())
        }
    };
    let label = bracket('{')?.map(named).transpose()?;
    let waits = bracket('(')?.map(named).transpose()?;
    let plain: Vec<&Word> = words.iter().filter(|word| word.bracket.is_none()).collect();
    let Some(first) = plain.first() else { return Err(fault(place, "a command without a module")) };
    let (module, what) = match first.text.starts_with('$') {
        true => bond(&plain, names)?,
        false => joints(&plain, names)?,
    };
    Ok(Command { place, module, what, time, label, waits })
}

/// Returns a time in seconds.
fn milliseconds(word: &Word) -> Result<f64, ImportFault> {
    let time = word.text.parse::<u32>().ok().filter(|time| *time <= 86_400_000);
    let time = time.ok_or_else(|| {
        fault(word.place, format!("`[{}]`: whole milliseconds of at most a day are wanted", word.text))
    })?;
    Ok(f64::from(time) / 1000.0)
}

fn module(word: &Word, name: &str, names: &BTreeMap<&str, usize>) -> Result<usize, ImportFault> {
    names
        .get(name)
        .copied()
        .ok_or_else(|| fault(word.place, format!("the configuration has no module `{name}`")))
}

fn joints(words: &[&Word], names: &BTreeMap<&str, usize>) -> Result<(usize, What), ImportFault> {
    let module = module(words[0], words[0].text, names)?;
    let [_, front, left, right, centre] = words[..] else {
        let found = words.len() - 1;
        let message = format!("{found} joints: 4 are wanted, those of front, left, right and centre");
        return Err(fault(words[0].place, message));
    };
    let mut stated = [None; 4];
    for (joint, word) in stated.iter_mut().zip([front, left, right, centre]) {
        *joint = joint_command(word)?;
    }
    if let Some((true, tilt)) = stated[3]
        && let Some(message) = tilt_fault(tilt)
    {
        return Err(fault(centre.place, message));
    }
    Ok((module, What::Joints(stated)))
}

fn joint_command(word: &Word) -> Result<Option<(bool, f64)>, ImportFault> {
    let mut letters = word.text.chars();
    let kind = letters.next().unwrap_or(' ');
    let value = || {
        let value =
            letters.as_str().parse::<f64>().ok().filter(|value| value.is_finite() && value.abs() < 1e6);
        value.ok_or_else(|| fault(word.place, format!("`{}`: a number is wanted behind `{kind}`", word.text)))
    };
    match kind {
        'p' => Ok(Some((true, value()?))),
        's' => Ok(Some((false, value()?))),
        'i' if word.text == "i" => Ok(None),
        't' => Err(fault(
            word.place,
            format!(
                "`{}` commands a torque: a joint of modl takes positions and speeds, and a plan proves their torques",
                word.text
            ),
        )),
        'c' | 'd' => Err(fault(
            word.place,
            format!(
                "`{}` docks by the joint, which the tools never did; `$ + &A &B ;` and `$ - &A &B ;` do",
                word.text
            ),
        )),
        _ => Err(fault(
            word.place,
            format!("`{}` is no command of a joint: `p`, `s` or `i` is wanted", word.text),
        )),
    }
}

/// Returns a command that docks or lets go.
fn bond(words: &[&Word], names: &BTreeMap<&str, usize>) -> Result<(usize, What), ImportFault> {
    let first = words[0];
    let mut sign = None;
    let (mut modules, mut faces) = (Vec::new(), Vec::new());
    for (index, word) in words.iter().enumerate() {
        let text = if index == 0 { &word.text[1..] } else { word.text };
        match text.chars().next() {
            None => {}
            Some('+' | '-') if text.len() == 1 && sign.is_none() => sign = Some(text == "+"),
            Some('&') => modules.push(module(word, &text[1..], names)?),
            Some('#') => {
                let face = text[1..].parse::<usize>().ok().and_then(|number| Face::ALL.get(number).copied());
                faces
                    .push(face.ok_or_else(|| fault(word.place, format!("`{text}` is no face of a module")))?);
            }
            Some(_) => {
                return Err(fault(word.place, format!("`{text}` is no part of a command for docking")));
            }
        }
    }
    let [a, b] = modules[..] else {
        return Err(fault(first.place, "two modules are wanted: `$ - &A &B ;`"));
    };
    if a == b {
        return Err(fault(first.place, "both ends are of one module"));
    }
    let what = match (sign, &faces[..]) {
        (Some(true), [of_a, of_b]) => What::Dock([(a, *of_a), (b, *of_b)]),
        (Some(true), _) => return Err(fault(first.place, "two faces are wanted: `$ + &A &B #0 #3 ;`")),
        (Some(false), _) => What::Undock([a, b]),
        (None, _) => return Err(fault(first.place, "`+` or `-` is wanted behind `$`")),
    };
    Ok((a, what))
}

/// Returns the order of commands; tells of those that wait for nothing.
fn order(commands: &[Command], robot: &mut Robot) -> Order {
    let mut order = Order::default();
    let mut last: BTreeMap<usize, usize> = BTreeMap::new();
    let mut labels: BTreeMap<&str, (Vec<usize>, Vec<usize>)> = BTreeMap::new();
    for (index, command) in commands.iter().enumerate() {
        if let Some(before) = last.insert(command.module, index) {
            order.queues.push((before, index));
        }
        if let Some(label) = &command.label {
            labels.entry(label).or_default().0.push(index);
        }
        if let Some(label) = &command.waits {
            labels.entry(label).or_default().1.push(index);
        }
    }
    for (label, (carry, wait)) in &labels {
        if let (true, Some(first), true) = (carry.is_empty(), wait.first(), *label != START) {
            let line = commands[*first].place.0;
            robot.notes.push(format!(
                "no command has the label `{label}`: what waits for it, first at line {line}, begins at once"
            ));
        }
    }
    order.labels = labels.into_values().collect();
    order
}

/// Returns the actions of each command. Setpoints that repeat where a joint stands are left out, and told.
fn actions(commands: &[Command], robot: &mut Robot) -> Result<Vec<Vec<Action>>, ImportFault> {
    let mut states: Vec<[f64; 4]> = robot.members.iter().map(|member| member.state).collect();
    let mut bonds: Vec<[(usize, Face); 2]> = robot.bonds.iter().map(|bond| bond.ends).collect();
    let mut repeated = 0;
    let mut all = Vec::new();
    for command in commands {
        let mut own = Vec::new();
        match &command.what {
            What::Joints(joints) => {
                let state = &mut states[command.module];
                for (joint, stated) in joints.iter().enumerate() {
                    match *stated {
                        Some((true, to)) if (to - state[joint]).abs() < SAME => repeated += 1,
                        Some((true, to)) => {
                            let time = command.time.filter(|time| *time > 0.0);
                            own.push(Action::Move { module: command.module, joint, to, time });
                            state[joint] = to;
                        }
                        // A speed that lasts no time moves nothing.
                        Some((false, _)) if command.time == Some(0.0) => {}
                        Some((false, speed)) => {
                            let time = command.time.unwrap_or(SPEED_TIME);
                            own.push(Action::Spin { module: command.module, joint, speed, time });
                            state[joint] += speed * time;
                        }
                        None => {}
                    }
                }
            }
            What::Dock(ends) => {
                bonds.push(*ends);
                own.push(Action::Dock(*ends));
            }
            What::Undock(modules) => {
                let between = |ends: &[(usize, Face); 2]| {
                    let own = ends.map(|(module, _)| module);
                    own == *modules || own == [modules[1], modules[0]]
                };
                let Some(found) = bonds.iter().position(between) else {
                    let [a, b] = modules.map(|module| &robot.members[module].name);
                    return Err(fault(command.place, format!("`{a}` and `{b}` are not connected")));
                };
                own.push(Action::Undock(bonds.remove(found)[0]));
            }
        }
        if let (Some(time), false) = (command.time.filter(|time| *time > 0.0), own.iter().any(timed)) {
            own.push(Action::Wait(time));
        }
        all.push(own);
    }
    if repeated > 0 {
        robot.notes.push(format!("{repeated} commands that repeat where a joint stands are left out"));
    }
    Ok(all)
}

/// Returns true if an action lasts for the time of its command.
fn timed(action: &Action) -> bool {
    match action {
        Action::Move { .. } | Action::Spin { .. } | Action::Wait(_) => true,
        Action::Dock(_) | Action::Undock(_) => false,
    }
}
