"""Plays a plan file on its MuJoCo model (`save(plan, "x.mjcf.xml")`) and prints what happens, as JSON.

    mujoco_runner.py PLAN.plan.json MODEL.mjcf.xml [--kp N] [--kv N] [--friction-scale X] [--no-limits]
        [--ground-only] [--step S] [--dry]

Position servos follow the plan's joint trajectories, which are evaluated here from their control points. Bonds dock
and undock at their times. Lengths in m, angles in rad; torques of joints that slide are forces. `travel`, `yaw` and
`lean` are those of the base between the start, after 0.3 s of settling, and 0.3 s after the end; `sink` is the
greatest speed downwards of the centre of mass; `lag` the farthest that a joint is behind the plan; `torque` the
greatest mean over 50 ms in parts of the limit, and `needed` the same without limits; `lags`, `torques` and `needs` are
these of every joint. `ups` is the vertical in the axes of the base, every 0.1 s from the start on.

With `--dry` friction is not MuJoCo's, a convex relaxation of Coulomb's law, but that law itself, as an outer force at each
contact: against its slip, and proportional to it below 2 mm/s. That takes steps of 20 µs.
"""

import argparse
import json
import math

import mujoco
import numpy

SETTLE = 0.3  # s at the start posture before the plan begins
REST = 0.3  # s at the end posture after it has ended
WINDOW = 0.05  # s over which torque is averaged
LEVER = 0.1  # m at which the servo of a joint that slides is that of one that turns
ATTITUDES = 0.1  # s between two attitudes of the base
FALLS = 0.5  # m/s downwards at which the centre of mass falls and is not let down
OWN_IMPEDANCE = 0.9, 0.95  # MuJoCo's own `solimp`
DRY_STEP = 2e-5  # s between two forces of dry friction
DRY_SPEED = 2e-3  # m/s below which dry friction is proportional to slip


def bernstein(control, s):
    """The value of a polynomial by its control points, and its derivative by s (de Casteljau)."""
    points = list(control)
    rate = 0.0
    while len(points) > 1:
        if len(points) == 2:
            rate = (len(control) - 1) * (points[1] - points[0])
        points = [a + s * (b - a) for a, b in zip(points, points[1:])]
    return points[0], rate


class Tracks:
    """The joint trajectories of a plan file."""

    def __init__(self, plan):
        body = plan["body"]["tracks"]
        self.names = body["robot"]["joints"]
        self.duration = body["duration"]
        self.base = body["robot"]["base"]
        self.bonds = [bond["name"] for bond in body["robot"]["bonds"]]
        self.events = [(e["time"], e["kind"] == "dock", self.bonds[e["bond"]]) for e in body["events"]]
        self.start = dict(zip(self.names, body["start"]["joints"]))
        self.segments = {self.names[t["joint"]]: t["segments"] for t in body["tracks"]}

    def at(self, joint, times):
        """Positions and velocities of a joint at ascending times."""
        position = numpy.full(len(times), self.start[joint])
        velocity = numpy.zeros(len(times))
        for segment in self.segments.get(joint, []):
            begun = numpy.searchsorted(times, segment["start"])
            ended = numpy.searchsorted(times, segment["end"])
            length = segment["end"] - segment["start"]
            s = (times[begun:ended] - segment["start"]) / length
            position[begun:ended], rate = bernstein(segment["control"], s)
            velocity[begun:ended] = rate / length
            position[ended:], velocity[ended:] = segment["control"][-1], 0.0
        return position, velocity


def load(
    text,
    kp=None,
    kv=None,
    friction_scale=1.0,
    limits=True,
    ground_only=False,
    step=None,
    slope=0.0,
    impratio=None,
    softness=None,
    pyramidal=False,
    noslip=0,
    dry=False,
    plain=False,
):
    """The model with servo gains, friction, torque limits, contacts and time step changed, at the start of the plan.

    `impratio`, `noslip`: MuJoCo's options; `softness`: the time constant of contacts, s, which then have MuJoCo's own
    impedance; `pyramidal`: cones of friction are pyramids; `dry`: contacts are without MuJoCo's friction; `plain`: contacts with
    the floor are those that MuJoCo finds, three or four points of a disc that lies flat, as much damped along it as along its
    normal.
    """
    model = on_plain_floor(text) if plain else mujoco.MjModel.from_xml_string(text)
    if step is not None or dry:
        model.opt.timestep = DRY_STEP if dry else step
    if impratio is not None:
        model.opt.impratio = impratio
    if softness is not None:
        model.geom_solref[:] = model.pair_solref[:] = softness, 1.0
        model.pair_solreffriction[:] = 0.0
        model.geom_solimp[:, :2] = model.pair_solimp[:, :2] = OWN_IMPEDANCE
    if pyramidal:
        model.opt.cone = mujoco.mjtCone.mjCONE_PYRAMIDAL
    model.opt.noslip_iterations = noslip
    slides = model.jnt_type[model.actuator_trnid[:, 0]] == int(mujoco.mjtJoint.mjJNT_SLIDE)
    lever = numpy.where(slides, 1 / LEVER**2, 1.0)
    if kp is not None:
        model.actuator_gainprm[:, 0] = kp * lever
        model.actuator_biasprm[:, 1] = -kp * lever
    if kv is not None:
        model.actuator_biasprm[:, 2] = -kv * lever
    if not limits:
        model.actuator_forcelimited[:] = 0
    # A command leads by the velocity, so that damping acts on the error only; it may leave the joint's range.
    model.actuator_ctrllimited[:] = 0
    model.geom_friction[:, 0] *= friction_scale
    model.pair_friction[:, :2] *= friction_scale
    if dry:
        model.geom_condim[:] = model.pair_dim[:] = 1
    if ground_only:
        ground, touching = model.geom_bodyid == 0, (model.geom_conaffinity & 1) > 0
        model.geom_contype[:], model.geom_conaffinity[:] = ground, ~ground & touching
    # Level ground that leans with all that stands on it: x goes up, and so gravity draws back.
    gravity = -model.opt.gravity[2]
    model.opt.gravity[:] = -gravity * math.sin(slope), 0.0, -gravity * math.cos(slope)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    return model, data


def on_plain_floor(text):
    """The model without its pairs and points of rims: contacts with the floor are those that MuJoCo finds."""
    spec = mujoco.MjSpec.from_string(text)
    for pair in list(spec.pairs):
        spec.delete(pair)
    for body in list(spec.bodies)[1:]:
        for geom in list(body.geoms):
            if geom.contype == 0:
                spec.delete(geom)
            else:
                geom.contype = geom.conaffinity = 3
    return spec.compile()


def hold(model, data, holds, bond):
    """Lets the constraints of a bond hold or not: one, or two of a bond that turns."""
    for end in ("", ", low", ", high"):
        constraint = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_EQUALITY, bond + end)
        if constraint >= 0:
            data.eq_active[constraint] = holds


def rub(model, data):
    """Sets the outer forces on bodies to those of dry friction at the contacts of the step before."""
    data.xfrc_applied[:] = 0.0
    if data.ncon == 0 or data.nefc == 0:
        return
    contacts = data.contact
    first, second = contacts.geom[:, 0], contacts.geom[:, 1]
    row = contacts.efc_address
    pressing = numpy.where(row >= 0, data.efc_force[numpy.maximum(row, 0)], 0.0)
    friction = contacts.friction[:, 0]
    pushed, pushing = model.geom_bodyid[second], model.geom_bodyid[first]

    def velocity(body):
        about = data.subtree_com[model.body_rootid[body]]
        return data.cvel[body, 3:] + numpy.cross(data.cvel[body, :3], contacts.pos - about)

    normal = contacts.frame[:, :3]
    slip = velocity(pushed) - velocity(pushing)
    slip -= normal * (slip * normal).sum(1)[:, None]
    speed = numpy.maximum(numpy.linalg.norm(slip, axis=1), DRY_SPEED)
    force = -slip * (friction * pressing / speed)[:, None]
    for body, on_body in ((pushed, force), (pushing, -force)):
        numpy.add.at(data.xfrc_applied[:, :3], body, on_body)
        moment = numpy.cross(contacts.pos - data.xipos[body], on_body)
        numpy.add.at(data.xfrc_applied[:, 3:], body, moment)
    data.xfrc_applied[0] = 0.0


def play(plan, text, **options):
    """Plays a plan on the text of its model; returns what happened."""
    tracks = Tracks(plan)
    model, data = load(text, **options)
    servos = [model.actuator(a).name for a in range(model.nu)]
    joints = model.actuator_trnid[:, 0]
    qpos, lead = model.jnt_qposadr[joints], -model.actuator_biasprm[:, 2] / model.actuator_gainprm[:, 0]
    effort = model.actuator_forcerange[:, 1]
    step = model.opt.timestep
    window = max(1, round(WINDOW / step))
    history = numpy.zeros((window, model.nu))
    mean = numpy.zeros(model.nu)
    greatest, lag, peak = numpy.zeros(model.nu), numpy.zeros(model.nu), numpy.zeros(model.nu)
    lean, sink, events, ups = 0.0, 0.0, list(tracks.events), []
    start = None
    first, last = -round(SETTLE / step), round((tracks.duration + REST) / step)
    times = numpy.maximum(numpy.arange(first, last) * step, 0.0)
    plan_q, plan_v = numpy.empty((len(times), model.nu)), numpy.empty((len(times), model.nu))
    for a, servo in enumerate(servos):
        plan_q[:, a], plan_v[:, a] = tracks.at(servo, times)
    # At rest until the start.
    plan_v[:-first] = 0.0
    command = plan_q + lead * plan_v
    for i in range(first, last):
        t = i * step
        while events and events[0][0] <= t:
            hold(model, data, *events.pop(0)[1:])
        data.ctrl[:] = command[i - first]
        height = data.subtree_com[0, 2]
        if options.get("dry"):
            rub(model, data)
        mujoco.mj_step(model, data)
        if i == -1:
            # The base is the first body of the first tree.
            start = data.xpos[1].copy(), data.xmat[1].reshape(3, 3).copy()
        force = data.actuator_force
        mean += (force - history[i % window]) / window
        history[i % window] = force
        peak = numpy.maximum(peak, numpy.abs(force))
        if i < 0:
            continue
        if i % round(ATTITUDES / step) == 0:
            ups.append([float(x) for x in data.xmat[1].reshape(3, 3)[2]])
        greatest = numpy.maximum(greatest, numpy.abs(mean))
        lag = numpy.maximum(lag, numpy.abs(data.qpos[qpos] - plan_q[i - first]))
        turn = data.xmat[1].reshape(3, 3) @ start[1].T
        lean = max(lean, tilt(turn))
        sink = max(sink, (height - data.subtree_com[0, 2]) / step)
    travel = data.xpos[1] - start[0]
    turn = data.xmat[1].reshape(3, 3) @ start[1].T
    lags = {joint: float(l) for joint, l in zip(servos, lag)}
    torques = {joint: float(g / e) for joint, g, e in zip(servos, greatest, effort) if e > 0}
    return {
        "duration": tracks.duration,
        "travel": [float(x) for x in travel],
        "yaw": math.atan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1]),
        "lean_final": tilt(turn),
        "lean_greatest": lean,
        "sink": float(sink),
        "fell": bool(sink > FALLS),
        "lag": worst(lags),
        "torque": worst(torques),
        "lags": lags,
        "torques": torques,
        "saturates": bool((peak >= effort)[effort > 0].any()),
        "ups": ups,
        "warnings": int(sum(w.number for w in data.warning)),
    }


def tilt(turn):
    """The angle by which a rotation leans the vertical."""
    return math.acos(max(-1.0, min(1.0, turn[2, 2])))


def worst(values):
    """The greatest of the values by joint, with the joint; None without any."""
    return max(((value, joint) for joint, value in values.items()), default=None)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("plan")
    parser.add_argument("model")
    parser.add_argument("--kp", type=float, help="stiffness of servos, N·m/rad")
    parser.add_argument("--kv", type=float, help="damping of servos, N·m·s/rad")
    parser.add_argument("--friction-scale", type=float, default=1.0)
    parser.add_argument("--no-limits", action="store_true", help="only the run without limits of torque")
    parser.add_argument("--ground-only", action="store_true", help="links pass through each other")
    parser.add_argument("--step", type=float, help="time step, s")
    parser.add_argument("--dry", action="store_true", help="friction is Coulomb's law itself; slow")
    options = parser.parse_args()
    with open(options.plan, encoding="utf-8") as file:
        plan = json.load(file)
    settings = {name: getattr(options, name) for name in ("kp", "kv", "friction_scale", "ground_only", "step", "dry")}
    with open(options.model, encoding="utf-8") as file:
        model = file.read()
    print(json.dumps(both(plan, model, options.no_limits, **settings), indent=1))


def both(plan, model, no_limits=False, **settings):
    """What happens with limits of torque, and the torque that would be needed without, or only what happens then."""
    if no_limits:
        return play(plan, model, limits=False, **settings)
    within = play(plan, model, **settings)
    # Where no servo reaches its limit, nothing would change without.
    free = play(plan, model, limits=False, **settings) if within["saturates"] else within
    return {**within, "needed": free["torque"], "needs": free["torques"]}


if __name__ == "__main__":
    main()
