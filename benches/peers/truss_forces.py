"""Forces, rigidity and slip of trusses by another library: scipy's linear programmes and numpy's singular values.

    python benches/peers/truss_forces.py MODL PLAN.json...

needs numpy and scipy. Of every plan it looks at every keyframe and at ten moments between, with the nodes that stay on the
ground from one keyframe to the next: the least greatest force over all distributions in equilibrium at every node, with
contacts in a pyramid of eight edges inside a friction cone of 0.8; the least singular value of the rigidity matrix that
belongs to no rigid motion; and what nodes on the ground slide. It compares them with what `MODL verify PLAN.json` says of
the margin of forces and of rigidity, and fails where a force within the limit, or a singular value, is missed by more than
the instants between the judge's allow.
"""

import json
import re
import subprocess
import sys

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import coo_matrix

GRAVITY, FRICTION, EDGES, CONTACT = 9.80665, 0.8, 8, 1e-4
MOMENTS = 10


def least_greatest(nodes, struts, feet, weights):
    """The least greatest force, N; infinite if nothing holds the truss."""
    n, m = len(nodes), len(struts)
    whole = weights.sum()
    rows, columns, values = [], [], []

    def add(node, column, vector):
        for k in range(3):
            rows.append(3 * node + k)
            columns.append(column)
            values.append(vector[k])

    for s, (a, b) in enumerate(struts):
        e = nodes[b] - nodes[a]
        e /= np.linalg.norm(e)
        add(a, s, e)
        add(b, s, -e)
    for i, foot in enumerate(feet):
        for edge in range(EDGES):
            angle = 2 * np.pi * edge / EDGES
            add(foot, m + EDGES * i + edge, [FRICTION * np.cos(angle), FRICTION * np.sin(angle), 1.0])
    size = m + EDGES * len(feet) + 1
    equal = coo_matrix((values, (rows, columns)), shape=(3 * n, size))
    right = np.zeros(3 * n)
    right[2::3] = weights / whole
    strut = np.arange(m)
    above = coo_matrix(
        (
            np.concatenate([np.ones(m), -np.ones(m), -np.ones(2 * m)]),
            (np.concatenate([strut, m + strut, strut, m + strut]), np.concatenate([strut, strut, np.full(2 * m, size - 1)])),
        ),
        shape=(2 * m, size),
    )
    costs = np.zeros(size)
    costs[-1] = 1.0
    bounds = [(None, None)] * m + [(0, None)] * (size - m)
    found = linprog(costs, above, np.zeros(2 * m), equal, right, bounds, method="highs")
    return found.fun * whole if found.status == 0 else np.inf


def weakest(nodes, struts):
    """The seventh least singular value of the rigidity matrix."""
    matrix = np.zeros((len(struts), 3 * len(nodes)))
    for row, (a, b) in enumerate(struts):
        e = (nodes[a] - nodes[b]) / np.linalg.norm(nodes[a] - nodes[b])
        matrix[row, 3 * a : 3 * a + 3] = e
        matrix[row, 3 * b : 3 * b + 3] = -e
    squares = np.linalg.eigvalsh(matrix.T @ matrix)
    return np.sqrt(max(squares[6], 0.0))


def looked_at(path, every=1):
    with open(path) as file:
        plan = json.load(file)
    body = plan["body"]
    body = body.get("node_paths", body)
    strut = plan["library"]["struts"][body["strut"]]
    struts = [tuple(s) for s in body["struts"]]
    frames = body["keyframes"]
    nodes = [np.array(frame["nodes"]) for frame in frames]
    weights = np.full(len(nodes[0]), strut.get("node_mass", 0.0) * GRAVITY)
    for a, b in struts:
        weights[[a, b]] += strut["mass"] * GRAVITY / 2
    mean = np.mean([np.linalg.norm(nodes[0][a] - nodes[0][b]) for a, b in struts])
    stands = any(world["world"]["gravity"] > 0 for world in plan["worlds"])
    force, least, slip = 0.0, np.inf, 0.0
    for i in range(1, len(nodes)):
        if frames[i]["interpolation"] != "linear":
            continue
        x, y = nodes[i - 1], nodes[i]
        feet = np.nonzero((x[:, 2] <= CONTACT * mean) & (y[:, 2] <= CONTACT * mean))[0]
        slip += stands * np.linalg.norm((y - x)[feet, :2], axis=1).sum()
        if i % every:
            continue
        for moment in range(MOMENTS + 2):
            z = x + (y - x) * moment / (MOMENTS + 1)
            least = min(least, weakest(z, struts))
            if stands:
                force = max(force, least_greatest(z, struts, feet, weights))
    excused = any(exemption["kind"] != "slip" for exemption in plan.get("exemptions", []))
    return strut, body.get("limits", {}), (stands, excused), force, least, slip


def told(modl, path):
    """What the verdict says: margins by name."""
    words = subprocess.run([modl, "verify", path], capture_output=True, text=True, check=False).stdout
    found = {name: float(value) for name, value in re.findall(r"^ *(rigidity) +([\d.e-]+), worst", words, re.M)}
    percent = re.findall(r"^ *(force margin) +(-?[\d.]+)%", words, re.M)
    found.update((name, float(value) / 100) for name, value in percent)
    return words, found


def main(modl, paths):
    failed = False
    for path in paths:
        strut, limits, (stands, excused), force, least, slip = looked_at(path)
        _, found = told(modl, path)
        margin = 1 - force / strut["force"]
        bad = abs(found["rigidity"] - least) > 0.02 * least
        if stands:
            bad |= abs(found["force margin"] - margin) > 0.05 * (1 - margin)
            bad |= not excused and force > 1.01 * strut["force"]
            bad |= limits.get("slip", 0) > 0 and slip > limits["slip"] + 1e-6
        failed |= bad
        print(
            f"{path}: force {force:.1f} N, margin {margin:.4f} (told {found.get('force margin')}), "
            f"least singular value {least:.5f} (told {found['rigidity']}), slip {slip:.4f} m {'BAD' if bad else ''}"
        )
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
