//! The free ports of a robot, and the declarations that mate there.

use crate::check::Checked;
use crate::check::Meaning;
use crate::check::typed::{ConfigDef, DefId, DefKind, MemberId, MemberKind, Program};
use crate::interpret::design::{Design, Instance, port_ref};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::robot::Robot as Assembled;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;
use crate::robot::PortRef;
use serde::Serialize;
use std::rc::Rc;

/// The most declarations that are offered: each is elaborated.
const OFFERS_MAX: usize = 24;

/// The most free ports of one robot that are listed.
const PORTS_MAX: usize = 4000;

/// A port with nothing docked to it.
#[derive(Clone, Debug, Serialize)]
pub struct FreePort {
    /// The path of the port, as the text names it: `leg[2].m[0].top`.
    pub name: String,
    /// The number of its module.
    pub module: usize,
    /// The link that carries the port, by its index in the module's type.
    pub link: usize,
    /// The origin of the port in the frame of its link, m.
    pub at: [f64; 3],
    /// The direction out of the port, in the frame of its link.
    pub out: [f64; 3],
    /// The name of its connector.
    pub connector: String,
    /// The number of turns in which it mates, over a full turn.
    pub turns: u32,
    /// The ports that mate there, by indices into the robot's offers.
    pub offers: Vec<usize>,
}

/// A port of a declaration that is visible in the program, which a free port may mate with.
#[derive(Clone, Debug, Serialize)]
pub struct Offer {
    /// The name of the module or configuration, as the program names it.
    pub part: String,
    /// The name of its port.
    pub port: String,
    #[serde(skip)]
    connector: DefId,
}

/// Returns the free ports of a robot, and what mates there. `design`: the configuration that it is.
///
/// # Errors
/// `Stop::Halt` if a limit is reached or the user cancels.
pub(super) fn ports(
    interpreter: &mut Interpreter,
    checked: &Checked,
    design: &Rc<Design>,
    robot: &Assembled,
) -> Eval<(Vec<FreePort>, Vec<Offer>)> {
    let offers = offers(interpreter, checked, design.def)?;
    let Some(config) = design.config() else { return Ok((Vec::new(), offers)) };
    let taken = config.taken.borrow();
    let assembly = &robot.assembly;
    let mut free = Vec::new();
    for module in 0..assembly.modules.len() {
        let kind = assembly.module_type(module);
        let declared = design.module_at(module);
        let Some(connectors) = declared.module().map(|module| &module.module.ports) else { continue };
        for (index, port) in kind.ports.iter().enumerate() {
            if taken.contains_key(&(module, index)) || free.len() >= PORTS_MAX {
                continue;
            }
            let def = declared.module().map(|module| module.connectors[connectors[index].connector]);
            let mates = def.map_or(Vec::new(), |def| mates(&checked.program, def));
            let fits = |(_, offer): &(usize, &Offer)| mates.contains(&offer.connector);
            let connector = &assembly.library.connectors[port.connector];
            let at = port.pose.translation.vector;
            let out = port.pose.rotation * crate::geometry::Vec3::x();
            free.push(FreePort {
                name: format!("{}.{}", assembly.modules[module].name, port.name),
                module,
                link: port.link,
                at: [at.x, at.y, at.z],
                out: [out.x, out.y, out.z],
                connector: connector.name.clone(),
                turns: connector.turns,
                offers: offers.iter().enumerate().filter(fits).map(|(index, _)| index).collect(),
            });
        }
    }
    Ok((free, offers))
}

/// Returns the connectors that mate with one.
fn mates(program: &Program, def: DefId) -> Vec<DefId> {
    match &program.def(def).kind {
        DefKind::Connector(connector) => connector.mates.iter().map(|(mate, _)| *mate).collect(),
        _ => Vec::new(),
    }
}

/// Returns the ports of all modules and configurations that a program can name and that need no arguments, but for those that
/// have the configuration `host` in them.
fn offers(interpreter: &mut Interpreter, checked: &Checked, host: DefId) -> Eval<Vec<Offer>> {
    let mut offers = Vec::new();
    let mut count = 0;
    for (name, def) in visible(checked) {
        if count >= OFFERS_MAX || holds(&checked.program, def, host, 0) {
            continue;
        }
        let Some(design) = interpreter.attempt(|this| this.default_design(def))?.flatten() else { continue };
        if design.broken.get() {
            continue;
        }
        count += 1;
        if let Some(module) = design.module() {
            offers.extend(module.module.ports.iter().map(|port| Offer {
                part: name.clone(),
                port: port.name.clone(),
                connector: module.connectors[port.connector],
            }));
        } else if let DefKind::Config(config) = &checked.program.def(def).kind {
            let whole = interpreter.whole(&design);
            for (port, found) in named_ports(interpreter, config, &whole)? {
                let design = whole.design.module_at(found.module);
                let Some(module) = design.module() else { continue };
                let connector = module.connectors[module.module.ports[found.port].connector];
                offers.push(Offer { part: name.clone(), port, connector });
            }
        }
    }
    Ok(offers)
}

/// Returns the ports that a configuration gives names to.
fn named_ports(
    interpreter: &mut Interpreter,
    config: &ConfigDef,
    whole: &Rc<Instance>,
) -> Eval<Vec<(String, PortRef)>> {
    let mut found = Vec::new();
    for (index, member) in config.members.iter().enumerate() {
        if !matches!(member.kind, MemberKind::Port { .. }) {
            continue;
        }
        let id = MemberId(u32::try_from(index).expect("members are few"));
        let value = interpreter.member(whole, id, member.span);
        match interpreter.recover(value)? {
            Value::Port(port) => found.push((member.name.to_string(), port_ref(&port))),
            Value::List(list) => {
                let ports = list.iter().enumerate().filter_map(|(i, value)| match value {
                    Value::Port(port) => Some((format!("{}[{i}]", member.name), port_ref(port))),
                    _ => None,
                });
                found.extend(ports);
            }
            _ => {}
        }
    }
    Ok(found)
}

/// Returns the modules and configurations that the program can name, as it names them.
fn visible(checked: &Checked) -> Vec<(String, DefId)> {
    let mut found = Vec::new();
    for (name, meaning) in &checked.names {
        match meaning {
            Meaning::Def(def) => found.push((name.to_string(), *def)),
            Meaning::File(inside) => {
                found.extend(inside.iter().map(|(own, def)| (format!("{name}.{own}"), *def)));
            }
        }
    }
    found.retain(|(_, def)| match &checked.program.def(*def).kind {
        DefKind::Module(_) => true,
        DefKind::Config(config) => !config.scene,
        _ => false,
    });
    found
}

/// Returns true if a declaration is `host`, or has it among its parts.
fn holds(program: &Program, def: DefId, host: DefId, depth: usize) -> bool {
    const DEPTH_MAX: usize = 32;
    if def == host || depth > DEPTH_MAX {
        return true;
    }
    match &program.def(def).kind {
        DefKind::Config(config) => config.parts.iter().any(|part| holds(program, part.of, host, depth + 1)),
        _ => false,
    }
}
