"""Exported files, read by programs that know nothing of modl: pinocchio, yourdfpy and MuJoCo read URDF, PyYAML reads
trajectories, mcap and mcap-ros2-support read recordings. The task is a JSON file; faults are printed, a line each."""

import json
import sys

import mujoco
import numpy as np
import pinocchio
import yaml
import yourdfpy
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

TOL = 1e-9


def far(a, b):
    return np.abs(np.asarray(a) - np.asarray(b)).max() > TOL


def pinocchio_poses(path, joints):
    """The rotation of every frame and a function from points of a frame to the world."""
    model = pinocchio.buildModelFromUrdf(path)
    data = model.createData()
    q = pinocchio.neutral(model)
    for index, name in enumerate(model.names):
        if index > 0:
            joint = model.joints[index]
            value = joints[name]
            turn = [np.cos(value), np.sin(value)] if joint.nq == 2 else [value]
            q[joint.idx_q : joint.idx_q + joint.nq] = turn
    pinocchio.framesForwardKinematics(model, data, q)
    names = [f.name for f in model.frames if f.type == pinocchio.FrameType.BODY and f.name != "universe"]
    return {name: data.oMf[model.getFrameId(name)].homogeneous for name in names}, sum(i.mass for i in model.inertias)


def mujoco_poses(path, joints):
    model = mujoco.MjModel.from_xml_path(path)
    data = mujoco.MjData(model)
    for index in range(model.njnt):
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, index)
        data.qpos[model.jnt_qposadr[index]] = joints[name]
    mujoco.mj_kinematics(model, data)
    poses = {}
    for body in range(1, model.nbody):
        X = np.eye(4)
        X[:3, :3], X[:3, 3] = data.xmat[body].reshape(3, 3), data.xpos[body]
        poses[mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, body)] = X
    return poses, model.body_mass.sum()


def check_urdf(path, states):
    robot = yourdfpy.URDF.load(path, load_meshes=True, build_scene_graph=True)
    if not robot.validate():
        yield f"yourdfpy: {robot.errors}"
    links = robot.link_map
    for state in states:
        joints, expected = state["joints"], state["links"]
        robot.update_cfg({name: joints[name] for name in robot.actuated_joint_names})
        own = {name: robot.get_transform(name) for name in links}
        mass = sum(link.inertial.mass for link in links.values())
        readers = {"yourdfpy": (own, mass), "pinocchio": pinocchio_poses(path, joints)}
        readers["mujoco"] = mujoco_poses(path, joints)
        for reader, (poses, mass) in readers.items():
            # MuJoCo leaves the root out where nothing carries it.
            missing = set(expected) - set(poses)
            if missing and not (reader == "mujoco" and len(missing) == 1):
                yield f"{reader}: no {sorted(missing)[:3]}"
            for name, X in poses.items():
                if name not in expected:
                    continue
                com = X[:3, :3] @ links[name].inertial.origin[:3, 3] + X[:3, 3]
                if far(X[:3, :3], np.reshape(expected[name]["turn"], (3, 3))):
                    yield f"{reader}: {name} is turned otherwise"
                if far(com, expected[name]["centre"]):
                    yield f"{reader}: {name} has its centre of mass at {com}, not {expected[name]['centre']}"
            if reader != "mujoco" and abs(mass - state["mass"]) > 1e-6:
                yield f"{reader}: a mass of {mass} kg, not {state['mass']}"


def check_trajectory(path, twin):
    with open(path) as text, open(twin) as other:
        if yaml.safe_load(text) != json.load(other):
            yield "YAML and JSON say different things"
    with open(path) as text:
        for point in yaml.safe_load(text)["points"]:
            for key in ("positions", "velocities", "accelerations"):
                if not all(isinstance(x, float) for x in point[key]):
                    yield f"a number of {key} is none of YAML 1.1"


def matrix(transform):
    q, p = transform.rotation, transform.translation
    X = np.eye(4)
    X[:3, :3] = pinocchio.Quaternion(q.w, q.x, q.y, q.z).toRotationMatrix()
    X[:3, 3] = [p.x, p.y, p.z]
    return X


def check_recording(path, task):
    frames, counts = {}, {}
    robot, last, log = None, -1, []
    with open(path, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for _, channel, message, ros in reader.iter_decoded_messages():
            counts[channel.topic] = counts.get(channel.topic, 0) + 1
            if message.log_time < last:
                yield "messages are not in order"
            last = message.log_time
            if channel.topic == "/robot_description":
                robot = pinocchio.buildModelFromXML(ros.data)
            elif channel.topic in ("/tf", "/tf_static"):
                for one in ros.transforms:
                    frames[one.child_frame_id] = (one.header.frame_id, matrix(one.transform))
            elif channel.topic == "/events":
                log.append(ros.msg)
            elif channel.topic == "/joint_states" and robot is not None and len(task["urdfs"]) == 1:
                # The frames of the recording are those that its description gives at its joint positions.
                data, q = robot.createData(), pinocchio.neutral(robot)
                for name, value in zip(ros.name, ros.position):
                    joint = robot.joints[robot.getJointId(name)]
                    turn = [np.cos(value), np.sin(value)] if joint.nq == 2 else [value]
                    q[joint.idx_q : joint.idx_q + joint.nq] = turn
                pinocchio.framesForwardKinematics(robot, data, q)
                for child, (parent, X) in frames.items():
                    if parent != "world":
                        a, b = (data.oMf[robot.getFrameId(name)] for name in (parent, child))
                        if far((a.inverse() * b).homogeneous, X):
                            yield f"/tf: {child} stands elsewhere in {parent}"
            elif channel.topic == "/planned_trajectory":
                times = [p.time_from_start.sec * 10**9 + p.time_from_start.nanosec for p in ros.points]
                if any(b <= a for a, b in zip(times, times[1:])):
                    yield "times of a trajectory do not increase"
    if not any(line.startswith(task["headline"]) for line in log):
        yield f"/events has no `{task['headline']}`: {log}"
    for topic in ["/tf", "/joint_states", "/planned_trajectory"]:
        if counts.get(topic, 0) == 0:
            yield f"no {topic}"


def main(path):
    with open(path) as file:
        tasks = json.load(file)
    for task in tasks:
        found = []
        for urdf in task["urdfs"]:
            found += check_urdf(urdf["path"], urdf["states"])
        for trajectory in task["trajectories"]:
            found += check_trajectory(trajectory + ".yaml", trajectory + ".json")
        found += check_recording(task["recording"], task)
        for fault in found[:5]:
            print(f"{task['name'][:60]}: {fault}")


if __name__ == "__main__":
    main(sys.argv[1])
