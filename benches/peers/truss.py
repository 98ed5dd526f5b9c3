"""The linear-actuator-robots paper's method as a careful Python programmer would write it, to measure
`cargo bench --bench truss` against: numba for geometry, OSQP for the quadratic programmes.

    python3 -m venv peer && peer/bin/pip install -r benches/peers/requirements.txt
    peer/bin/python benches/peers/truss.py

It morphs the robot of 34 nodes and 108 actuators into a cube of side 2 by the paper's projected gradient
(18)-(22) with rows that ask for values (rows of rates alone get stuck), and moves it 4 lengths along x by
objective (17) with three nodes held. `tests/truth/truss.json` has the distances that this has to reach.
"""

import json
import pathlib
import time

import numba
import numpy as np
import osqp
import scipy.sparse as sp

ROOT = pathlib.Path(__file__).resolve().parents[2]
LEAST, MOST, APART, CAP, KAPPA = 0.3, 3.0, 0.1, 0.05, 1e-3


@numba.njit(cache=True)
def nearest_weights(px, py, pz, a, b, c):
    """Weights of the point of a triangle that is nearest to p (Ericson, 5.1.5), in numbers alone: small
    arrays would be allocated."""
    ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    x, y, z = px - a[0], py - a[1], pz - a[2]
    d1, d2 = ux * x + uy * y + uz * z, vx * x + vy * y + vz * z
    if d1 <= 0 and d2 <= 0:
        return 1.0, 0.0, 0.0
    x, y, z = px - b[0], py - b[1], pz - b[2]
    d3, d4 = ux * x + uy * y + uz * z, vx * x + vy * y + vz * z
    if d3 >= 0 and d4 <= d3:
        return 0.0, 1.0, 0.0
    vc = d1 * d4 - d3 * d2
    if vc <= 0 and d1 >= 0 and d3 <= 0:
        v = d1 / (d1 - d3)
        return 1.0 - v, v, 0.0
    x, y, z = px - c[0], py - c[1], pz - c[2]
    d5, d6 = ux * x + uy * y + uz * z, vx * x + vy * y + vz * z
    if d6 >= 0 and d5 <= d6:
        return 0.0, 0.0, 1.0
    vb = d5 * d2 - d1 * d6
    if vb <= 0 and d2 >= 0 and d6 <= 0:
        w = d2 / (d2 - d6)
        return 1.0 - w, 0.0, w
    va = d3 * d6 - d5 * d4
    if va <= 0 and d4 >= d3 and d5 >= d6:
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        return 0.0, 1.0 - w, w
    s = 1.0 / (va + vb + vc)
    return va * s, vb * s, vc * s


@numba.njit(cache=True)
def project(points, x, faces):
    """The gradient of the mean squared distance over the nodes, and that mean."""
    pull = np.zeros_like(x)
    total = 0.0
    for i in range(len(points)):
        px, py, pz = points[i, 0], points[i, 1], points[i, 2]
        best, where = 1e30, 0
        weights = (1.0, 0.0, 0.0)
        for f in range(len(faces)):
            a, b, c = x[faces[f, 0]], x[faces[f, 1]], x[faces[f, 2]]
            u, v, w = nearest_weights(px, py, pz, a, b, c)
            dx = px - (u * a[0] + v * b[0] + w * c[0])
            dy = py - (u * a[1] + v * b[1] + w * c[1])
            dz = pz - (u * a[2] + v * b[2] + w * c[2])
            square = dx * dx + dy * dy + dz * dz
            if square < best:
                best, where, weights = square, f, (u, v, w)
        u, v, w = weights
        a, b, c = faces[where]
        for k in range(3):
            d = points[i, k] - (u * x[a, k] + v * x[b, k] + w * x[c, k])
            pull[a, k] += u * d
            pull[b, k] += v * d
            pull[c, k] += w * d
        total += best
    return pull / len(points), total / len(points)


@numba.njit(cache=True)
def witness(a, b, c, d):
    """How far along two segments their nearest points are, and how far apart."""
    ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    vx, vy, vz = d[0] - c[0], d[1] - c[1], d[2] - c[2]
    wx, wy, wz = a[0] - c[0], a[1] - c[1], a[2] - c[2]
    uu, uv, vv = ux * ux + uy * uy + uz * uz, ux * vx + uy * vy + uz * vz, vx * vx + vy * vy + vz * vz
    uw, vw = ux * wx + uy * wy + uz * wz, vx * wx + vy * wy + vz * wz
    det = uu * vv - uv * uv
    s = min(max((uv * vw - vv * uw) / det, 0.0), 1.0) if det > 1e-9 * uu * vv else 0.0
    t = min(max((uv * s + vw) / vv, 0.0), 1.0)
    s = min(max((uv * t - uw) / uu, 0.0), 1.0)
    t = min(max((uv * s + vw) / vv, 0.0), 1.0)
    ex, ey, ez = wx + s * ux - t * vx, wy + s * uy - t * vy, wz + s * uz - t * vz
    return s, t, np.sqrt(ex * ex + ey * ey + ez * ez)


@numba.njit(cache=True)
def too_near(x, edges, pairs):
    found = []
    for k in range(len(pairs)):
        i, j = pairs[k]
        s, t, d = witness(x[edges[i, 0]], x[edges[i, 1]], x[edges[j, 0]], x[edges[j, 1]])
        if d < APART:
            found.append((k, APART - d))
    return found


class Truss:
    def __init__(self):
        truth = json.loads((ROOT / "tests/truth/truss.json").read_text())
        self.x = np.array(truth["vertices"], float)
        self.edges = np.array(truth["edges"])
        self.faces = np.array(truth["outer_triangles_oriented_outward"])
        m = len(self.edges)
        shares = [(i, j) for i in range(m) for j in range(i) if not set(self.edges[i]) & set(self.edges[j])]
        self.pairs = np.array(shares)

    def row(self, x, key):
        """A limit's value and its gradient over the nodes."""
        kind, k = key
        g = np.zeros_like(x)
        if kind == "apart":
            i, j = self.pairs[k]
            (a, b), (c, d) = self.edges[i], self.edges[j]
            s, t, far = witness(x[a], x[b], x[c], x[d])
            n = (x[a] + s * (x[b] - x[a]) - x[c] - t * (x[d] - x[c])) / far
            g[a], g[b] = g[a] + (1 - s) * n, g[b] + s * n
            g[c], g[d] = g[c] - (1 - t) * n, g[d] - t * n
            return far - APART, g.ravel()
        if kind == "above":
            g[k, 2] = 1.0
            return x[k, 2], g.ravel()
        a, b = self.edges[k]
        e = x[a] - x[b]
        length = np.linalg.norm(e)
        sign = 1.0 if kind == "least" else -1.0
        g[a], g[b] = sign * e / length, -sign * e / length
        return (length - LEAST if kind == "least" else MOST - length), g.ravel()

    def broken(self, x, ground):
        lengths = np.linalg.norm(x[self.edges[:, 0]] - x[self.edges[:, 1]], axis=1)
        found = [(("least", k), LEAST - lengths[k]) for k in np.flatnonzero(lengths < LEAST - 1e-10)]
        found += [(("most", k), lengths[k] - MOST) for k in np.flatnonzero(lengths > MOST + 1e-10)]
        if ground:
            found += [(("above", k), -x[k, 2]) for k in np.flatnonzero(x[:, 2] < -1e-10)]
        near = too_near(x, self.edges, self.pairs)
        return found + [(("apart", k), lack) for k, lack in near if lack > 1e-10]

    def step(self, x, wanted, held=(), centre=None, ground=False, memory=()):
        """min |u - wanted|^2 under the limits, which are asked for where they break."""
        n = x.size
        fixed = [3 * node + k for node in held for k in range(3)]
        equal = sp.csc_matrix((np.ones(len(fixed)), (range(len(fixed)), fixed)), shape=(len(fixed), n))
        right = np.zeros(len(fixed))
        if centre is not None:
            mean = sp.csc_matrix(np.kron(np.full(len(x), 1.0 / len(x)), np.eye(3)))
            equal, right = sp.vstack([equal, mean]), np.concatenate([right, centre])
        asked = {key: 1e-6 for key in memory}
        for _ in range(40):
            rows = [self.row(x, key) for key in asked]
            if rows:
                more = sp.csc_matrix(np.array([g for _, g in rows]))
                low = np.array([delta - value for (value, _), delta in zip(rows, asked.values())])
                matrix = sp.vstack([equal, more], format="csc")
                bounds = np.concatenate([right, low]), np.concatenate([right, np.full(len(low), np.inf)])
            else:
                matrix, bounds = sp.csc_matrix(equal), (right, right)
            if matrix.shape[0]:
                solver = osqp.OSQP()
                solver.setup(sp.identity(n, format="csc"), -wanted.ravel(), matrix, *bounds, verbose=False,
                             eps_abs=1e-7, eps_rel=1e-7, max_iter=20000)
                found = solver.solve()
                if found.info.status_val not in (1, 2):
                    return None, ()
                u = found.x.reshape(-1, 3)
            else:
                u = wanted
            far = np.linalg.norm(u, axis=1).max()
            if centre is None and far > CAP:
                u = u * (CAP / far)
            y = x + u
            broken = self.broken(y, ground)
            if not broken:
                return y, [key for key in asked if self.row(y, key)[0] < 0.02]
            for key, lack in broken:
                asked[key] = asked[key] + 1.5 * lack if key in asked else 1e-6
        return None, ()


def cube():
    points = []
    for k in range(3):
        for c in (0.0, 2.0):
            e = np.eye(3)
            for i in range(16):
                for j in range(16):
                    points.append(c * e[k] + (i + 0.5) / 8 * e[(k + 1) % 3] + (j + 0.5) / 8 * e[(k + 2) % 3])
    points = np.array(points)
    return points - points.mean(axis=0)


def morph(truss, steps):
    x, points, memory = truss.x - truss.x.mean(axis=0), cube(), ()
    n, edges = len(x), truss.edges
    project(points, x, truss.faces)
    truss.broken(x, False)
    begun = time.perf_counter()
    for _ in range(steps):
        pull, _ = project(points, x, truss.faces)
        spring = np.zeros_like(x)
        d = x[edges[:, 0]] - x[edges[:, 1]]
        np.add.at(spring, edges[:, 0], d)
        np.add.at(spring, edges[:, 1], -d)
        v = (n / 2.2) * (pull - KAPPA / len(edges) * spring)
        far = np.linalg.norm(v, axis=1).max()
        v *= min(1.0, CAP / far)
        y, memory = truss.step(x, v, memory=memory)
        if y is None:
            break
        x = y
    lasted = time.perf_counter() - begun
    return 1e3 * lasted / steps, np.sqrt(project(points, x, truss.faces)[1])


def locomote(truss, steps):
    x, memory = truss.x.copy(), ()
    edges = truss.edges
    begun, made = time.perf_counter(), 0
    for _ in range(steps):
        low = np.flatnonzero(x[:, 2] < 1e-4)
        middle = x.mean(axis=0)
        held = best_three(x, low, middle)
        d = x[edges[:, 1]] - x[edges[:, 0]]
        length = np.linalg.norm(d, axis=1, keepdims=True)
        pull = np.zeros_like(x)
        np.add.at(pull, edges[:, 0], d * (1 - 1 / length))
        np.add.at(pull, edges[:, 1], -d * (1 - 1 / length))
        y, memory = truss.step(x, 0.05 * pull, held, np.array([0.05, 0, 0]), True, memory)
        # Without rolling: until it would tip.
        if y is None or held is None:
            break
        x, made = y, made + 1
    return 1e3 * (time.perf_counter() - begun) / max(made, 1), made


def best_three(x, low, middle):
    """The three feet whose triangle holds the middle farthest inside, of those on the hull."""
    from scipy.spatial import ConvexHull

    hull = low[ConvexHull(x[low, :2]).vertices]
    best, found = -np.inf, hull[:3]
    for i in range(len(hull)):
        for j in range(i + 1, len(hull)):
            for k in range(j + 1, len(hull)):
                p = x[[hull[i], hull[j], hull[k]], :2]
                sides = np.roll(p, -1, axis=0) - p
                arms = middle[:2] - p
                inside = ((sides[:, 0] * arms[:, 1] - sides[:, 1] * arms[:, 0]) / np.linalg.norm(sides, axis=1)).min()
                if inside > best:
                    best, found = inside, [hull[i], hull[j], hull[k]]
    return found


if __name__ == "__main__":
    truss = Truss()
    for steps in (60, 200):
        each, rms = morph(truss, steps)
        print(f"| peer, gradient, cube | {steps} | {each:.2f} | {rms:.5f} |")
    locomote(truss, 2)
    each, made = locomote(truss, 15)
    print(f"| peer, (17), along x | {made} | {each:.2f} | |")
