//! The conditions of a connection: free ports, connectors that mate, an allowed turn, no loop.

use super::tolerances::TOLERANCES;
use crate::check::typed::{ConfigDef, Expr};
use crate::interpret::design::ConnectorDesign;
use crate::interpret::design::shorten;
use crate::interpret::design::{BondRecord, ConfigDesign, Design};
use crate::interpret::frame::Frame;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::{PortValue, Value};
use crate::source::{Diagnostic, Span, code};
use crate::units::quantity;
use std::collections::VecDeque;
use std::rc::Rc;

impl Interpreter<'_> {
    /// Adds the connection `connect a -- b turn t` to the configuration; none where one of the three is unknown.
    /// `turn`: `None` for turn 0; `span`: the clause.
    ///
    /// # Errors
    /// A fault where a port is taken, the two are one, the connectors do not mate, the turn is not allowed, or the
    /// connection closes a loop in a configuration that is not `closed`.
    pub(super) fn connect(
        &mut self,
        config: &ConfigDesign,
        a: &Expr,
        b: &Expr,
        turn: Option<&Expr>,
        span: Span,
        frame: &mut Frame,
    ) -> Eval<()> {
        let ends = (self.eval(a, frame)?, self.eval(b, frame)?);
        let turned = self.eval_optional(turn, frame)?;
        let (Value::Port(p), Value::Port(q)) = ends else { return Ok(()) };
        self.check_free(config, &p, a.span)?;
        self.check_free(config, &q, b.span)?;
        if (p.module, p.port) == (q.module, q.port) {
            return Err(fault(
                code::PORT_TAKEN,
                b.span,
                "a port can't be connected to itself",
                "the same port",
            ));
        }
        let (Some(x), Some(y)) = (self.connector_at(&p)?, self.connector_at(&q)?) else { return Ok(()) };
        if !x.mates.contains(&y.def) {
            return Err(self.no_mate(config, (&p, &x, a.span), (&q, &y, b.span)));
        }
        let turn = match (turn, turned) {
            (Some(expr), Some(value)) => match value.as_number() {
                Some(angle) => allowed_turn(&x, angle, expr.span)?,
                None => return Ok(()),
            },
            _ => 0,
        };
        if !config.closed && config.groups.borrow_mut().together(p.module, q.module) {
            let path = path_between(config, p.module, q.module).unwrap_or_default();
            return Err(self.loop_closed(&path, &p.robot, a.span, b.span));
        }
        let instance = self.binder_notes();
        let bond = BondRecord {
            a: (p.module, p.port),
            b: (q.module, q.port),
            turn,
            span,
            ends: (a.span, b.span),
            instance: instance.as_str().into(),
        };
        config.add_bond(bond);
        Ok(())
    }

    /// Refuses a port that a connection has already.
    ///
    /// # Errors
    /// A fault at `span` where it is taken.
    fn check_free(&self, config: &ConfigDesign, port: &PortValue, span: Span) -> Eval<()> {
        let key = (port.module, port.port);
        let Some(&index) = config.taken.borrow().get(&key) else { return Ok(()) };
        let bonds = config.bonds.borrow();
        let bond = &bonds[index];
        let (by, other) = if bond.a == key { (bond.ends.0, bond.b) } else { (bond.ends.1, bond.a) };
        let partner = PortValue { robot: port.robot.clone(), module: other.0, port: other.1 };
        let mut diagnostic =
            Diagnostic::error(code::PORT_TAKEN, format!("the port {} is taken", port.name()))
                .label(span, "this port is taken");
        if by != span {
            diagnostic = diagnostic.label(by, format!("here it was connected to {}", partner.name()));
        }
        let free = free_ports(config, &port.robot, port.module).collect::<Vec<_>>();
        if !free.is_empty() {
            let module = port.robot.module_name(port.module);
            diagnostic = diagnostic.hint(format!("free ports of {module}: {}", shorten(&free)));
        }
        Err(diagnostic.into())
    }

    /// Returns the connector at a port; `None` where it is broken, which has been reported.
    ///
    /// # Errors
    /// `Stop::Halt` if a limit is reached or the user cancels while the connector is elaborated.
    pub(super) fn connector_at(&mut self, port: &PortValue) -> Eval<Option<Rc<ConnectorDesign>>> {
        let design = port.robot.module_at(port.module);
        let module = design.module().expect("only modules have ports of their own");
        let def = module.connectors[module.module.ports[port.port].connector];
        self.connector(def)
    }

    /// Returns the fault of connectors that do not mate, with the free ports of either module that would.
    fn no_mate(
        &mut self,
        config: &ConfigDesign,
        (p, x, a): (&PortValue, &ConnectorDesign, Span),
        (q, y, b): (&PortValue, &ConnectorDesign, Span),
    ) -> Stop {
        let (this, that) = (&x.connector.name, &y.connector.name);
        let message = format!("{} {this} does not mate with {} {that}", article(this), article(that));
        let mut diagnostic = Diagnostic::error(code::NO_MATE, message)
            .label(a, format!("{} {this}", article(this)))
            .label(b, format!("{} {that}", article(that)));
        for (to, wanted) in [(q, x), (p, y)] {
            let mates: Vec<String> = (wanted.mates.iter())
                .map(|&mate| self.shared.program.def(mate).name)
                .map(|name| format!("{} {name}", article(name.as_str())))
                .collect();
            let name = &wanted.connector.name;
            let module = to.robot.module_name(to.module);
            let free = self.mating_ports(config, to, wanted);
            let ports = match free.is_empty() {
                true => format!("{module} has no free port with one"),
                false => format!("free ports of {module} that have one: {}", shorten(&free)),
            };
            diagnostic = diagnostic.hint(format!(
                "{} {name} mates with {}; {ports}",
                article(name),
                mates.join(" or ")
            ));
        }
        diagnostic.into()
    }

    /// Returns the names of the free ports of the module of `port` whose connectors mate with `wanted`.
    fn mating_ports(
        &mut self,
        config: &ConfigDesign,
        port: &PortValue,
        wanted: &ConnectorDesign,
    ) -> Vec<String> {
        let design = port.robot.module_at(port.module);
        let module = design.module().expect("only modules have ports of their own");
        let mates =
            |index: usize| wanted.mates.contains(&module.connectors[module.module.ports[index].connector]);
        let taken = config.taken.borrow();
        let free = |index: usize| !taken.contains_key(&(port.module, index));
        let ports = module.module.ports.iter().enumerate();
        ports.filter(|(i, _)| mates(*i) && free(*i)).map(|(_, p)| p.name.clone()).collect()
    }

    fn loop_closed(&self, path: &[usize], robot: &Rc<Design>, a: Span, b: Span) -> Stop {
        let names: Vec<String> = path.iter().map(|&m| robot.module_name(m).to_string()).collect();
        let message = format!("this connection closes a loop: {}", shorten(&names));
        Diagnostic::error(code::LOOP, message)
            .label(a, "already connected to the other end, through other modules")
            .label(b, "the other end")
            .hint("write `closed` after the configuration's name if the loop is meant")
            .into()
    }

    /// Reports modules that bonds do not connect with the first module of a configuration, grouped by its parts.
    ///
    /// # Errors
    /// None: the result is always `Ok`.
    pub(super) fn check_connected(
        &mut self,
        def: &ConfigDef,
        design: &Rc<Design>,
        config: &ConfigDesign,
    ) -> Eval<()> {
        let count = design.module_count();
        if count == 0 {
            return Ok(());
        }
        let reached: Vec<bool> = (0..count).map(|m| config.groups.borrow_mut().together(0, m)).collect();
        if reached.iter().all(|r| *r) {
            return Ok(());
        }
        let groups = config.parts.get().expect("the parts are known");
        let is_loose = |offset: usize, count: usize| (offset..offset + count).any(|m| !reached[m]);
        let mut diagnostic = None;
        for (part, group) in def.parts.iter().zip(groups) {
            let loose = group.elements.iter().filter(|e| is_loose(e.offset, e.design.module_count()));
            let names: Vec<String> = loose.map(|e| e.name.to_string()).collect();
            if names.is_empty() {
                continue;
            }
            let first = design.module_name(0);
            let found = diagnostic.take().unwrap_or_else(|| {
                let message = format!("nothing connects {} with {first}", shorten(&names));
                Diagnostic::error(code::NOT_CONNECTED, message)
            });
            diagnostic = Some(found.label(part.span, format!("not connected: {}", shorten(&names))));
        }
        if let Some(diagnostic) = diagnostic {
            self.report(
                diagnostic.hint("`connect` them: a configuration is one robot, and several are a `scene`"),
            );
        }
        Ok(())
    }

    /// Reports connections whose ports do not meet in the start state, in a configuration that is `closed`; others are
    /// not checked.
    ///
    /// # Errors
    /// A fault or `Stop::Halt` while the robot is assembled.
    pub(super) fn check_closure(&mut self, def: &ConfigDef, design: &Rc<Design>) -> Eval<()> {
        let Some(closed) = def.closed else { return Ok(()) };
        if design.broken.get() || design.module_count() == 0 {
            return Ok(());
        }
        let Some(robot) = self.robot_of(design, closed)? else { return Ok(()) };
        for residual in robot.residuals() {
            if residual.distance <= TOLERANCES.closure_distance && residual.angle <= TOLERANCES.closure_angle
            {
                continue;
            }
            let bond = &design.bonds()[residual.bond];
            let message = format!(
                "the loop does not meet: at this connection {} and {} are missing",
                quantity(residual.distance, crate::units::Dimension::LENGTH),
                quantity(residual.angle, crate::units::Dimension::ANGLE),
            );
            self.report(
                Diagnostic::error(code::LOOP_RESIDUAL, message)
                    .label(bond.span, "the two ports do not meet here")
                    .label(closed, "declared closed")
                    .hint("`set` joints, or give connections another `turn`, so that the loop closes"),
            );
        }
        Ok(())
    }
}

/// Returns the number of steps of 360° divided by `turns` that an angle (rad) is, below `turns`.
///
/// # Errors
/// A fault at `span` where it is not a whole number of steps.
fn allowed_turn(connector: &ConnectorDesign, angle: f64, span: Span) -> Eval<u32> {
    let turns = f64::from(connector.connector.turns);
    let steps = angle / std::f64::consts::TAU * turns;
    let nearest = steps.round();
    if (steps - nearest).abs() <= TOLERANCES.turn * turns {
        return Ok(nearest.rem_euclid(turns) as u32);
    }
    let allowed: Vec<String> =
        (0..connector.connector.turns).map(|k| format!("{}", f64::from(k) * 360.0 / turns)).collect();
    let allowed = match allowed.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last} degrees", rest.join(", ")),
        _ => "0 degrees only".to_string(),
    };
    let name = &connector.connector.name;
    let message =
        format!("{name} allows turns of {allowed}, not {}", quantity(angle, crate::units::Dimension::ANGLE));
    Err(fault(code::BAD_TURN, span, message, format!("{name} allows {allowed}")))
}

fn neighbours(config: &ConfigDesign, count: usize) -> Vec<Vec<usize>> {
    let mut lists = vec![Vec::new(); count];
    for bond in config.bonds.borrow().iter() {
        lists[bond.a.0].push(bond.b.0);
        lists[bond.b.0].push(bond.a.0);
    }
    lists
}

/// Returns the modules on a shortest path of connections from `from` to `to`, both included, in order of index;
/// `None` where none leads there. Breadth-first search.
fn path_between(config: &ConfigDesign, from: usize, to: usize) -> Option<Vec<usize>> {
    let count = config.modules.get().map_or(0, Vec::len);
    if from == to {
        return Some(vec![from]);
    }
    let lists = neighbours(config, count);
    let mut came: Vec<Option<usize>> = vec![None; count];
    let mut frontier = VecDeque::from([from]);
    while let Some(module) = frontier.pop_front() {
        for &next in &lists[module] {
            if next != from && came[next].is_none() {
                came[next] = Some(module);
                frontier.push_back(next);
            }
        }
    }
    came[to]?;
    let mut path: Vec<usize> = std::iter::successors(Some(to), |&m| came[m]).collect();
    path.sort_unstable();
    Some(path)
}

/// Returns the names of the ports of a module that no bond takes, in the order of the module's ports. `module`: its
/// index in the robot, from 0.
pub(crate) fn free_ports<'c>(
    config: &'c ConfigDesign,
    robot: &Rc<Design>,
    module: usize,
) -> impl Iterator<Item = String> + 'c {
    let kind = robot.module_type(module);
    let taken = config.taken.borrow();
    let free: Vec<String> = (0..kind.ports.len())
        .filter(|&port| !taken.contains_key(&(module, port)))
        .map(|port| kind.ports[port].name.clone())
        .collect();
    free.into_iter()
}

fn article(name: &str) -> &'static str {
    if name.starts_with(['A', 'E', 'I', 'O', 'U']) { "an" } else { "a" }
}
