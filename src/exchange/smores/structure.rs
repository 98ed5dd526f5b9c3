//! `.struct` files: configurations that links join to a larger one.

use super::super::import_fault::{ImportFault, document};
use super::configuration::{self, PITCH, place, turn};
use super::parts::{Face, Robot};
use super::{Document, MODULES_MAX, Node, xml};
use std::collections::BTreeMap;

/// The files that components come from, by the paths in the structure.
type Files<'o> = &'o mut dyn FnMut(&str) -> Option<Vec<u8>>;

/// Reads a structure. `open` returns the bytes of a file by a path beside it.
pub(super) fn read(document: &Document, open: Files) -> Result<Robot, ImportFault> {
    let root = document.root_element();
    let mut robot = Robot::new(PITCH);
    // The modules of a component are a range of those of the robot.
    let mut ranges = BTreeMap::new();
    let mut names = BTreeMap::new();
    let mut read = BTreeMap::new();
    for node in xml::children(xml::child(root, "Components")?, "Component")? {
        let id = xml::text(node, "component_id")?;
        let path = xml::text(node, "file_path")?;
        if !read.contains_key(path) {
            read.insert(path, component(node, path, open)?);
        }
        let component: &Robot = &read[path];
        let first = robot.members.len();
        if first + component.members.len() > MODULES_MAX {
            return Err(ImportFault::at_node(node, format!("the robot has more than {MODULES_MAX} modules")));
        }
        if ranges.insert(id, first..first + component.members.len()).is_some() {
            return Err(ImportFault::at_node(node, format!("the component `{id}` is there twice")));
        }
        for member in &component.members {
            let mut member = member.clone();
            member.name = format!("{id}:{}", member.name);
            names.insert(member.name.clone(), robot.members.len());
            robot.members.push(member);
        }
        for bond in &component.bonds {
            let mut bond = bond.clone();
            bond.ends = bond.ends.map(|(module, face)| (module + first, face));
            robot.bonds.push(bond);
        }
        robot.notes.extend(component.notes.iter().map(|note| format!("`{path}`: {note}")));
    }
    let links = root.children().find(|node| node.has_tag_name("Links"));
    let links = links.map_or(Ok(Vec::new()), |links| xml::children(links, "Link"))?;
    join(&mut robot, &links, &names, &ranges)?;
    Ok(robot)
}

fn component(node: Node, path: &str, open: Files) -> Result<Robot, ImportFault> {
    // The paths are those of the author's computer: the file is looked for beside the structure.
    let parts: Vec<&str> = path.split(['/', '\\']).filter(|part| !part.is_empty() && *part != "..").collect();
    let beside = parts.last().copied().unwrap_or(path);
    let below = parts[parts.len().saturating_sub(2)..].join("/");
    let bytes = open(beside).or_else(|| open(&below));
    let Some(bytes) = bytes else {
        return Err(ImportFault::at_node(
            node,
            format!("there is no file `{beside}` or `{below}` beside the structure"),
        ));
    };
    let text = String::from_utf8(bytes)
        .map_err(|_| ImportFault::at_node(node, format!("`{beside}` is not UTF-8 text")))?;
    let within = |inner: ImportFault| {
        ImportFault::at_node(node, format!("in `{beside}`, line {}: {}", inner.line.max(1), inner.message))
    };
    let document = document(&text).map_err(within)?;
    if !document.root_element().has_tag_name("configuration") {
        return Err(ImportFault::at_node(node, format!("`{beside}` is no configuration")));
    }
    configuration::read(&document).map_err(within)
}

/// Joins the components by the links: a component is moved to the place where its first link wants it.
fn join(
    robot: &mut Robot,
    links: &[Node],
    names: &BTreeMap<String, usize>,
    ranges: &BTreeMap<&str, std::ops::Range<usize>>,
) -> Result<(), ImportFault> {
    let mut waiting = Vec::new();
    for node in links {
        let mut ends = [(0, Face::Top); 2];
        for (end, number) in ends.iter_mut().zip(1..) {
            let component = xml::child(xml::child(*node, &format!("component{number}"))?, "Component")?;
            let id = xml::text(component, "component_id")?;
            let module = format!("{id}:{}", xml::text(*node, &format!("module{number}"))?);
            let found = names.get(&module).copied();
            end.0 =
                found.ok_or_else(|| ImportFault::at_node(*node, format!("there is no module `{module}`")))?;
            let text = xml::text(*node, &format!("node{number}"))?;
            let face = text.parse::<usize>().ok().and_then(|number| Face::ALL.get(number).copied());
            end.1 =
                face.ok_or_else(|| ImportFault::at_node(*node, format!("`{text}` is no face of a module")))?;
        }
        waiting.push((*node, ends, turn(*node)?));
    }
    let range =
        |module: usize| ranges.values().find(|range| range.contains(&module)).cloned().unwrap_or(0..0);
    let mut placed = vec![false; robot.members.len()];
    if let Some((_, ends, _)) = waiting.first() {
        placed[range(ends[0].0)].fill(true);
    }
    loop {
        let before = waiting.len();
        let mut left = Vec::new();
        for (node, ends, turn) in waiting {
            match ends.map(|(module, _)| placed[module]) {
                [false, false] => {
                    left.push((node, ends, turn));
                    continue;
                }
                [true, true] => {}
                [known, _] => {
                    let [fixed, moved] = if known { ends } else { [ends[1], ends[0]] };
                    let X = robot.members[fixed.0].X * robot.mate([fixed, moved], turn);
                    let shift = X * robot.members[moved.0].X.inverse();
                    for module in range(moved.0) {
                        robot.members[module].X = shift * robot.members[module].X;
                        placed[module] = true;
                    }
                }
            }
            robot.connect(ends, turn, place(node))?;
        }
        waiting = left;
        if waiting.is_empty() || waiting.len() == before {
            break;
        }
    }
    match waiting.first() {
        Some((node, ..)) => Err(ImportFault::at_node(*node, "no link joins this component to the first one")),
        None => Ok(()),
    }
}
