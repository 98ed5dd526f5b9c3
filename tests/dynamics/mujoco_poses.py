"""Answers with the poses that MuJoCo gives to the links of a model along a plan, as JSON from stdin to stdout.

The positions of joints are evaluated here, from the control points of the plan file.
"""

import json
import sys

import mujoco
import numpy
from mujoco_runner import Tracks, hold


def follow(model, data):
    """Moves joints that follow others to where their constraints want them."""
    position = lambda joint: data.qpos[model.jnt_qposadr[joint]]
    for _ in range(model.njnt):
        for equality in range(model.neq):
            first, second = model.eq_obj1id[equality], model.eq_obj2id[equality]
            if int(model.eq_type[equality]) == mujoco.mjtEq.mjEQ_JOINT:
                data.qpos[model.jnt_qposadr[first]] = model.eq_data[equality][1] * position(second)
            if int(model.eq_type[equality]) == mujoco.mjtEq.mjEQ_TENDON:
                begin = model.tendon_adr[first]
                terms = range(begin, begin + model.tendon_num[first])
                others = sum(model.wrap_prm[w] * position(model.wrap_objid[w]) for w in terms[1:])
                data.qpos[model.jnt_qposadr[model.wrap_objid[begin]]] = -others


def gaps(model, data):
    """For each constraint of a bond that is active: the distance of its sites, and of their axes where it is rigid."""
    found = {}
    for equality in numpy.flatnonzero(data.eq_active):
        kind = int(model.eq_type[equality])
        if kind not in (mujoco.mjtEq.mjEQ_CONNECT, mujoco.mjtEq.mjEQ_WELD):
            continue
        a, b = model.eq_obj1id[equality], model.eq_obj2id[equality]
        gap = numpy.abs(data.site_xpos[a] - data.site_xpos[b]).max()
        if kind == mujoco.mjtEq.mjEQ_WELD:
            gap = max(gap, numpy.abs(data.site_xmat[a] - data.site_xmat[b]).max())
        found[mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_EQUALITY, equality)] = float(gap)
    return found


def masses(model):
    """For each body its mass, its centre of mass and its inertia about that, in its own frame: xx yy zz xy xz yz."""
    found = {}
    for body in range(1, model.nbody):
        turn = numpy.zeros(9)
        mujoco.mju_quat2Mat(turn, model.body_iquat[body])
        turn = turn.reshape(3, 3)
        inertia = turn @ numpy.diag(model.body_inertia[body]) @ turn.T
        entries = [inertia[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
        found[model.body(body).name] = [model.body_mass[body], *model.body_ipos[body], *entries]
    return found


def frictions(model, data):
    """The friction of the contacts with the floor, by body, with all trees 1 mm lower than they are."""
    for joint in range(model.njnt):
        if int(model.jnt_type[joint]) == mujoco.mjtJoint.mjJNT_FREE:
            data.qpos[model.jnt_qposadr[joint] + 2] -= 1e-3
    mujoco.mj_forward(model, data)
    found = {}
    for contact in data.contact[: data.ncon]:
        floor, body = sorted(int(model.geom_bodyid[geom]) for geom in contact.geom)
        if floor == 0:
            found[model.body(body).name] = contact.friction[0]
    return found


def answer(task):
    model = mujoco.MjModel.from_xml_string(task["model"])
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    out = {"mass": model.body_subtreemass[0], "centre": data.subtree_com[0].tolist(), "moments": []}
    out["masses"], out["frictions"] = masses(model), frictions(model, data)
    tracks = Tracks(task["plan"])
    events = list(tracks.events)
    for moment in task["moments"]:
        while events and events[0][0] <= moment["time"]:
            hold(model, data, *events.pop(0)[1:])
        for joint in range(model.njnt):
            name = model.joint(joint).name
            at = model.jnt_qposadr[joint]
            if int(model.jnt_type[joint]) == mujoco.mjtJoint.mjJNT_FREE:
                data.qpos[at : at + 7] = moment["roots"][model.body(model.jnt_bodyid[joint]).name]
            elif name in tracks.start:
                data.qpos[at] = tracks.at(name, numpy.array([moment["time"]]))[0][0]
        follow(model, data)
        mujoco.mj_kinematics(model, data)
        poses = {
            model.body(b).name: data.xpos[b].tolist() + data.xmat[b].tolist() for b in range(1, model.nbody)
        }
        out["moments"].append({"poses": poses, "gaps": gaps(model, data)})
    return out


json.dump([answer(task) for task in json.load(sys.stdin)], sys.stdout)
