"""Forces, rigidity and slip of trusses by another library: scipy's linear programmes and numpy's singular values.

    python benches/peers/truss_forces.py MODL PLAN.json...

needs numpy and scipy. Of every plan it looks at every keyframe and at ten moments between, with the nodes that stay on the
ground from one keyframe to the next, uneven ground included: the least greatest force over all distributions in equilibrium at
every node, as a part of what a strut bears, which is less where it may buckle, with contacts in a pyramid of eight edges inside
a friction cone of 0.8 times that of the world, at rest and, where the step accelerates or brakes, with the
inertia of the nodes; the greatest acceleration of a strut, by second differences of its length; the least singular value of the rigidity matrix that
belongs to no rigid motion; and what nodes on the ground slide. It compares them with what `MODL verify PLAN.json` says of
the margins of forces and of rigidity and of the farthest that a node slides, and fails where a force within the limit, or a
singular value, is missed by more than the instants between the judge's allow.
"""

import json
import multiprocessing
import re
import subprocess
import sys

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import coo_matrix

GRAVITY, FRICTION, EDGES, CONTACT = 9.80665, 0.8, 8, 1e-4
MOMENTS = 10


class Ground:
    """Flat ground, or a height field of squares of two triangles, with a common side from the least x and y to the greatest."""

    def __init__(self, field):
        self.field = field
        if field:
            self.heights = np.array(field["heights"]).reshape(-1, field["columns"])

    def at(self, p):
        """The height below a point, m, and the unit normal there."""
        if not self.field:
            return 0.0, np.array([0.0, 0.0, 1.0])
        rows, columns = self.heights.shape
        place = (p[:2] - self.field["corner"]) / self.field["spacing"]
        most = np.array([columns - 1.0, rows - 1.0])
        u, v = np.clip(place, 0.0, most)
        i, j = min(int(u), columns - 2), min(int(v), rows - 2)
        (a, b), (c, d) = self.heights[j : j + 2, i : i + 2]
        u, v = u - i, v - j
        rise = np.array([b - a, d - b] if u >= v else [d - c, c - a])
        height = a + rise @ [u, v]
        rise = np.where((place < 0) | (place > most), 0.0, rise) / self.field["spacing"]
        normal = np.array([-rise[0], -rise[1], 1.0])
        return height, normal / np.linalg.norm(normal)

    def above(self, p):
        return p[2] - self.at(p)[0]


def pyramid(normal, friction):
    """The edges of a pyramid inside the friction cone about a normal, turned as the judge's is, since another holds other forces."""
    u = np.cross(normal, [1.0, 0.0, 0.0] if abs(normal[0]) < 0.5 else [0.0, 1.0, 0.0])
    u /= np.linalg.norm(u)
    v = np.cross(normal, u)
    angles = 2 * np.pi * np.arange(EDGES) / EDGES
    return normal + friction * (np.outer(np.cos(angles), u) + np.outer(np.sin(angles), v))


def least_greatest(nodes, struts, contacts, weights, bears, moved=None):
    """The least greatest force as a part of what a strut bears; infinite if nothing holds the truss. contacts: nodes with the
    edges of their pyramids; bears: what a strut of a length pulls and pushes; moved: the accelerations of the nodes, m/s2."""
    n, m = len(nodes), len(struts)
    whole = weights.sum()
    rows, columns, values, limits = [], [], [], []

    def add(node, column, vector):
        for k in range(3):
            rows.append(3 * node + k)
            columns.append(column)
            values.append(vector[k])

    for s, (a, b) in enumerate(struts):
        e = nodes[b] - nodes[a]
        length = np.linalg.norm(e)
        limits.append(bears(length))
        add(a, s, e / length)
        add(b, s, -e / length)
    for i, (foot, edges) in enumerate(contacts):
        for edge, direction in enumerate(edges):
            add(foot, m + EDGES * i + edge, direction)
    size = m + EDGES * len(contacts) + 1
    equal = coo_matrix((values, (rows, columns)), shape=(3 * n, size))
    right = np.zeros(3 * n)
    right[2::3] = weights / whole
    if moved is not None:
        right += (moved * (weights / GRAVITY)[:, None]).ravel() / whole
    strut = np.arange(m)
    pull, push = whole / np.array(limits).T
    above = coo_matrix(
        (
            np.concatenate([pull, -push, -np.ones(2 * m)]),
            (np.concatenate([strut, m + strut, strut, m + strut]), np.concatenate([strut, strut, np.full(2 * m, size - 1)])),
        ),
        shape=(2 * m, size),
    )
    costs = np.zeros(size)
    costs[-1] = 1.0
    bounds = [(None, None)] * m + [(0, None)] * (size - m)
    for presolve in (True, False):
        found = linprog(costs, above, np.zeros(2 * m), equal, right, bounds, method="highs", options={"presolve": presolve})
        # HiGHS 1.x ends some programmes without an answer (status 4), which it solves without its presolve.
        if found.status != 4:
            break
    return found.fun if found.status == 0 else np.inf


def weakest(nodes, struts):
    """The seventh least singular value of the rigidity matrix."""
    matrix = np.zeros((len(struts), 3 * len(nodes)))
    for row, (a, b) in enumerate(struts):
        e = (nodes[a] - nodes[b]) / np.linalg.norm(nodes[a] - nodes[b])
        matrix[row, 3 * a : 3 * a + 3] = e
        matrix[row, 3 * b : 3 * b + 3] = -e
    squares = np.linalg.eigvalsh(matrix.T @ matrix)
    return np.sqrt(max(squares[6], 0.0))


def progress(times, up, down, duration):
    """The progress of a step from rest to rest at some times, and its acceleration there."""
    whole = duration - (up + down) / 2
    rate = np.minimum(1, np.minimum(times / up, (duration - times) / down)) / whole
    part = np.where(times < up, times**2 / (2 * up), np.where(times > duration - down, whole - (duration - times) ** 2 / (2 * down), times - up / 2))
    return part / whole, np.where(times < up, 1 / (up * whole), np.where(times > duration - down, -1 / (down * whole), 0.0)), rate


def fastest(x, y, struts, ramps, duration):
    """The greatest acceleration of a strut's length in a step, by second differences, m/s2."""
    times = np.linspace(0, duration, 101)
    parts = progress(times, ramps["up"], ramps["down"], duration)[0]
    ends = np.array(struts)
    from_, to = (z[ends[:, 0]] - z[ends[:, 1]] for z in (x, y))
    lengths = np.linalg.norm(from_[None] + (to - from_)[None] * parts[:, None, None], axis=2)
    return np.abs(np.diff(lengths, 2, axis=0)).max() / (times[1] - times[0]) ** 2


def looked_at(path):
    with open(path) as file:
        plan = json.load(file)
    body = plan["body"]
    body = body.get("node_paths", body)
    strut = plan["library"]["struts"][body["strut"]]
    struts = [tuple(s) for s in body["struts"]]
    frames = body["keyframes"]
    nodes = [np.array(frame["nodes"]) for frame in frames]
    weights = np.full(len(nodes[0]), (strut.get("node_mass") or 0.0) * GRAVITY)
    for a, b in struts:
        weights[[a, b]] += strut["mass"] * GRAVITY / 2
    mean = np.mean([np.linalg.norm(nodes[0][a] - nodes[0][b]) for a, b in struts])
    ground = Ground(body.get("surroundings", {}).get("terrain"))
    worlds = [entry["world"] for entry in plan["worlds"]]
    stands = any(world["gravity"] > 0 for world in worlds)
    friction = FRICTION * worlds[0].get("friction", 1.0)

    def touches(p):
        return ground.above(p) <= CONTACT * mean

    def stays(p, q):
        return all(touches(p + (q - p) * t) for t in (np.linspace(0, 1, 33) if ground.field and (p != q).any() else (0, 1)))

    def bears(length):
        buckling = strut.get("buckling")
        push = strut["force"] if buckling is None else min(strut["force"], buckling * (strut["length"][1] / length) ** 2)
        return strut["force"], push

    force, least, quickest, slid = 0.0, np.inf, 0.0, np.zeros(len(nodes[0]))
    for i in range(1, len(nodes)):
        if frames[i]["interpolation"] != "linear":
            continue
        x, y = nodes[i - 1], nodes[i]
        feet = [node for node in range(len(x)) if stays(x[node], y[node])]
        slid[feet] += stands * np.linalg.norm((y - x)[feet, :2], axis=1)
        ramps, duration = frames[i].get("ramps"), frames[i]["time"] - frames[i - 1]["time"]
        if strut.get("acceleration") is not None:
            quickest = max(quickest, fastest(x, y, struts, ramps, duration) if ramps else (x != y).any() * np.inf)
        tips = i + 1 < len(frames) and frames[i + 1]["interpolation"] != "linear"
        for moment in range(MOMENTS + 2):
            part = moment / (MOMENTS + 1)
            z = x + (y - x) * part
            least = min(least, weakest(z, struts))
            if not stands:
                continue
            contacts = [(foot, pyramid(ground.at(z[foot])[1], friction)) for foot in feet]
            force = max(force, least_greatest(z, struts, contacts, weights, bears))
            if ramps:
                whole = duration - (ramps["up"] + ramps["down"]) / 2
                rates = [1 / (ramps["up"] * whole)] * (part <= ramps["up"] / (2 * whole))
                rates += [-1 / (ramps["down"] * whole)] * (1 - part <= ramps["down"] / (2 * whole) and not tips)
                for rate in rates:
                    force = max(force, least_greatest(z, struts, contacts, weights, bears, (y - x) * rate))
    excused = any(exemption["kind"] != "slip" for exemption in plan.get("exemptions", []))
    return path, strut, body.get("limits", {}), (stands, excused), force, least, slid, quickest


def told(modl, path):
    """What the verdict says: margins by name."""
    words = subprocess.run([modl, "verify", path], capture_output=True, text=True, check=False).stdout
    found = {name: float(value) for name, value in re.findall(r"^ *(rigidity) +([\d.e-]+), worst", words, re.M)}
    percent = re.findall(r"^ *(force margin) +(-?[\d.]+)%", words, re.M)
    found.update((name, float(value) / 100) for name, value in percent)
    lengths = re.findall(r"^ *(slip) +([\d.e-]+)(mm|m), worst", words, re.M)
    found.update((name, float(value) * {"mm": 1e-3, "m": 1.0}[unit]) for name, value, unit in lengths)
    return words, found


def main(modl, paths):
    failed = False
    with multiprocessing.Pool() as pool:
        for path, strut, limits, (stands, excused), force, least, slid, quickest in pool.imap(looked_at, paths):
            _, found = told(modl, path)
            margin = 1 - force
            bad = abs(found["rigidity"] - least) > 0.02 * least
            bad |= quickest > 1.01 * (strut.get("acceleration") or np.inf)
            if stands:
                bad |= abs(found["force margin"] - margin) > 0.05 * (1 - margin)
                bad |= not excused and force > 1.01
                bad |= limits.get("slip", 0) > 0 and slid.sum() > limits["slip"] + 1e-6
                bad |= abs(found["slip"] - slid.max()) > 1e-6 + 1e-5 * slid.max()
            failed |= bad
            print(
                f"{path}: greatest force {force * strut['force']:.1f} N, margin {margin:.4f} (told {found.get('force margin')}), least "
                f"singular value {least:.5f} (told {found['rigidity']}), slip {slid.sum():.4f} m, of one {slid.max():.4f} m (told {found.get('slip')}), "
                f"greatest acceleration {quickest:.4f} m/s2 {'BAD' if bad else ''}",
                flush=True,
            )
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
