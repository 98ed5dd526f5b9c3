# Collisions of plan files, by dense sampling with coal: kinematics, exemptions and search are written anew from the
# documents, and know nothing of the judge. Reads a JSON list of {plan, time, modules} and prints one answer each.
import json, sys
import coal, numpy

SAMPLES = 240      # intervals of a plan, besides the ends of segments
NEAR = 2e-3        # minima this near to the least are refined, m
REFINED = 4        # minima of a pair, the lowest first
ROUNDS = 60        # of golden section
DOCKING_ERROR = 1e-3  # of a connector that states none, m

request = coal.DistanceRequest()
request.gjk_tolerance, request.gjk_max_iterations = 1e-8, 500
request.epa_tolerance, request.epa_max_iterations = 1e-8, 500


def quaternion(q):
    w, x, y, z = numpy.array(q) / numpy.linalg.norm(q)
    return numpy.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])


def pose(told):
    X = numpy.eye(4)
    X[:3, :3], X[:3, 3] = quaternion(told["q"]), told["p"]
    return X


def turn(axis, angles):
    """Poses turned about an axis by each of many angles (Rodrigues)."""
    x, y, z = numpy.array(axis) / numpy.linalg.norm(axis)
    K = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    X = numpy.tile(numpy.eye(4), (len(angles), 1, 1))
    X[:, :3, :3] += numpy.sin(angles)[:, None, None] * K + (1 - numpy.cos(angles))[:, None, None] * (K @ K)
    return X


def slide(axis, by):
    X = numpy.tile(numpy.eye(4), (len(by), 1, 1))
    X[:, :3, 3] = numpy.array(by)[:, None] * numpy.array(axis)
    return X


def along(axis):
    """A rotation that takes z to an axis."""
    z = numpy.array(axis) / numpy.linalg.norm(axis)
    x = numpy.cross(z, numpy.eye(3)[numpy.argmin(abs(z))])
    x /= numpy.linalg.norm(x)
    X = numpy.eye(4)
    X[:3, :3] = numpy.column_stack([x, numpy.cross(z, x), z])
    return X


def support(kind, shape):
    """The farthest points of a convex shape, in coal's frame, along many directions (rows)."""
    if kind == "box":
        return lambda n: numpy.where(n >= 0, 0.5, -0.5) * numpy.array(shape["size"])
    if kind == "sphere":
        return lambda n: shape["radius"] * n
    if kind in ("cylinder", "capsule"):
        def farthest(n):
            out = n * [1, 1, 0] if kind == "cylinder" else n
            out = out / numpy.maximum(numpy.linalg.norm(out, axis=1), 1e-300)[:, None]
            end = numpy.where(n[:, 2:] >= 0, 0.5, -0.5) * shape["length"]
            return shape["radius"] * out + end * [0, 0, 1]

        return farthest
    points = numpy.array(shape["points"])
    return lambda n: points[numpy.argmax(n @ points.T, axis=1)]


def solid(placed):
    """The shapes of coal with their poses in the link, a bounding ball, and their farthest points."""
    X = pose(placed["pose"])
    (kind, shape), = placed["shape"].items()
    if kind == "union":
        return [(made, X @ Y, *rest) for part in shape["parts"] for made, Y, *rest in solid(part)]
    far = support(kind, shape)
    if kind == "box":
        size = numpy.array(shape["size"])
        return [(coal.Box(*size), X, numpy.linalg.norm(size) / 2, far)]
    if kind == "sphere":
        return [(coal.Sphere(shape["radius"]), X, shape["radius"], far)]
    if kind == "cylinder":
        r, l = shape["radius"], shape["length"]
        return [(coal.Cylinder(r, l), X @ along(shape["axis"]), numpy.hypot(r, l / 2), far)]
    if kind == "capsule":
        r, l = shape["radius"], shape["length"]
        return [(coal.Capsule(r, l), X @ along(shape["axis"]), r + l / 2, far)]
    points = numpy.array(shape["points"])
    kept = coal.StdVec_Vec3s()
    for point in points:
        kept.append(point)
    hull = coal.ConvexBase.convexHull(kept, True, "Qt")
    return [(hull, X, numpy.linalg.norm(points, axis=1).max(), far)]


def bernstein(control, u):
    points = [numpy.full(len(u), c) for c in control]
    while len(points) > 1:
        points = [(1 - u) * a + u * b for a, b in zip(points, points[1:])]
    return points[0]


class Motion:
    """A plan: the poses of all links at any times."""

    def __init__(self, plan):
        body, self.library = plan["body"]["tracks"], plan["library"]
        self.robot, self.start = body["robot"], body["start"]
        self.tracks = {track["joint"]: track["segments"] for track in body["tracks"]}
        self.duration = body["duration"]
        self.types = [self.library["modules"][module["kind"]] for module in self.robot["modules"]]
        self.first_link = numpy.cumsum([0] + [len(kind["links"]) for kind in self.types])
        self.first_joint = numpy.cumsum([0] + [len(kind["joints"]) for kind in self.types])
        hinged = [i for i, bond in enumerate(self.robot["bonds"]) if self.connector(bond)["hinge"]]
        self.hinge_joint = {bond: self.first_joint[-1] + k for k, bond in enumerate(hinged)}

    def port(self, at):
        return self.types[at["module"]]["ports"][at["port"]]

    def connector(self, bond):
        return self.library["connectors"][self.port(bond["a"])["connector"]]

    def link_of(self, at):
        return self.first_link[at["module"]] + self.port(at)["link"]

    def joint(self, index, t):
        at = numpy.full(len(t), self.start["joints"][index])
        for s in self.tracks.get(index, []):
            u = numpy.clip((t - s["start"]) / (s["end"] - s["start"]), 0, 1)
            at = numpy.where(t >= s["start"], bernstein(s["control"], u), at)
        return at

    def mate(self, bond, angles):
        """X_PQ, the pose of the second port in the first."""
        connector = self.connector(bond)
        theta = 2 * numpy.pi * bond["turn"] / connector["turns"]
        X = turn([0, 0, 1], [numpy.pi])[0] @ turn([1, 0, 0], [theta])[0]
        return turn(connector["hinge"]["axis"], angles) @ X if connector["hinge"] else numpy.tile(X, (len(angles), 1, 1))

    def across(self, index, t):
        """The pose of the second link of a bond in the first."""
        bond = self.robot["bonds"][index]
        angles = self.joint(self.hinge_joint[index], t) if index in self.hinge_joint else numpy.zeros(len(t))
        return pose(self.port(bond["a"])["pose"]) @ self.mate(bond, angles) @ numpy.linalg.inv(pose(self.port(bond["b"])["pose"]))

    def poses(self, t):
        t = numpy.atleast_1d(t)
        edges = {}

        def add(a, b, X):
            edges.setdefault(a, []).append((b, X))
            edges.setdefault(b, []).append((a, numpy.linalg.inv(X)))

        for module, kind in enumerate(self.types):
            links = [pose(link["pose"]) for link in kind["links"]]
            for j, joint in enumerate(kind["joints"]):
                X, q = pose(joint["pose"]), self.joint(self.first_joint[module] + j, t)
                moved = {"revolute": turn, "prismatic": slide}.get(joint["kind"], lambda axis, q: slide(axis, 0 * q))
                first = self.first_link[module]
                X = numpy.linalg.inv(links[joint["parent"]]) @ X @ moved(joint["axis"], q) @ numpy.linalg.inv(X) @ links[joint["child"]]
                add(first + joint["parent"], first + joint["child"], X)
        for index, bond in enumerate(self.robot["bonds"]):
            add(self.link_of(bond["a"]), self.link_of(bond["b"]), self.across(index, t))
        found, frontier = {0: numpy.tile(numpy.eye(4), (len(t), 1, 1))}, [0]
        while frontier:
            link = frontier.pop()
            for other, X in edges.get(link, []):
                if other not in found:
                    found[other] = found[link] @ X
                    frontier.append(other)
        return [found[link] for link in range(self.first_link[-1])]


def transform(X):
    return coal.Transform3s(X[:3, :3], X[:3, 3])


def distance(a, b, X, Y):
    """The signed distance of two lists of shapes at two poses of their links."""
    least = numpy.inf
    for one, X_A, r, _ in a:
        for other, X_B, s, _ in b:
            A, B = X @ X_A, Y @ X_B
            if numpy.linalg.norm(A[:3, 3] - B[:3, 3]) - r - s < least:
                result = coal.DistanceResult()
                least = min(least, coal.distance(one, transform(A), other, transform(B), request, result))
    return least


def spread(count):
    """Directions all over the sphere (a Fibonacci lattice)."""
    z = (2 * numpy.arange(count) + 1) / count - 1
    turn = numpy.pi * (3 - numpy.sqrt(5)) * numpy.arange(count)
    r = numpy.sqrt(1 - z * z)
    return numpy.column_stack([r * numpy.cos(turn), r * numpy.sin(turn), z])


EVERYWHERE, AROUND = spread(2000), spread(64)


def separation(one, other, X, Y):
    """The signed distance of two convex shapes: the most by which any direction separates them."""
    (_, X_A, _, far), (_, X_B, _, far_other) = one, other
    A, B = X @ X_A, Y @ X_B

    def by(n):
        n = n / numpy.linalg.norm(n, axis=1)[:, None]
        a = far(n @ A[:3, :3]) @ A[:3, :3].T + A[:3, 3]
        b = far_other(-n @ B[:3, :3]) @ B[:3, :3].T + B[:3, 3]
        return n, numpy.sum(n * (b - a), axis=1)

    n, found = by(EVERYWHERE)
    best = -numpy.inf
    for start in n[numpy.argsort(-found)[:2]]:
        scale = 0.1
        for _ in range(200):
            near, values = by(numpy.vstack([start, start + scale * AROUND]))
            k = numpy.argmax(values)
            start, best = near[k], max(best, values[k])
            scale *= 0.5 if k == 0 else 1
            if scale < 1e-8:
                break
    return best


class Case:
    def __init__(self, plan):
        self.motion = motion = Motion(plan)
        self.solids, self.module = [], []
        for index, kind in enumerate(motion.types):
            for link in kind["links"]:
                self.solids.append([made for placed in link["collides"] for made in solid(placed)])
                self.module.append(index)
        self.pairs = self.rules()

    def rules(self):
        """Of each pair of links that is judged: the allowed depth, and whether it counts for the clearance."""
        motion, links = self.motion, range(len(self.solids))
        touch = [motion.types[m]["touch"] for m in self.module]
        pairs = {(a, b): (min(touch[a], touch[b]), True) for a in links for b in links if a < b}
        for module, kind in enumerate(motion.types):
            first = motion.first_link[module]
            for joint in kind["joints"]:
                a, b = sorted((first + joint["parent"], first + joint["child"]))
                X, Y = [pose(kind["links"][link - first]["pose"]) for link in (a, b)]
                drawn = max(0, -self.parts_distance(a, b, X, Y))
                pairs[a, b] = (kind["touch"] + drawn, False)
            for a, b in kind["touching"]:
                pairs.pop(tuple(sorted((first + a, first + b))), None)
        self.docked = 0.0
        for bond in motion.robot["bonds"]:
            a, b = motion.link_of(bond["a"]), motion.link_of(bond["b"])
            X = pose(motion.port(bond["a"])["pose"]) @ motion.mate(dict(bond), numpy.zeros(1))[0] @ numpy.linalg.inv(pose(motion.port(bond["b"])["pose"]))
            overlap = max(0, -distance(self.solids[a], self.solids[b], numpy.eye(4), X))
            capture = motion.connector(bond)["capture"]
            explained = min(overlap, capture["distance"] if capture else DOCKING_ERROR)
            pairs[tuple(sorted((a, b)))] = (min(touch[a], touch[b]) + explained, False)
        return pairs

    def parts_distance(self, a, b, X, Y):
        return distance(self.solids[a], self.solids[b], X, Y)

    def at(self, pair, t):
        poses = self.motion.poses(t)
        a, b = pair
        return distance(self.solids[a], self.solids[b], poses[a][0], poses[b][0])

    def checked(self, pair, value, t):
        """The distance that coal tells, unless it is too deep, and a search over directions finds less: coal's expanding
        polytope sometimes stops early, or fails with the greatest number that there is."""
        (a, b), (allowed, _) = pair, self.pairs[pair]
        if -value <= allowed:
            return value
        poses = self.motion.poses(t)
        X, Y = poses[a][0], poses[b][0]
        parts = [(one, other) for one in self.solids[a] for other in self.solids[b]]
        return max(value, min(separation(one, other, X, Y) for one, other in parts))

    def refined(self, pair, low, high):
        """The least distance of a pair between two times, and when: golden section."""
        part = (numpy.sqrt(5) - 1) / 2
        x, y = high - part * (high - low), low + part * (high - low)
        fx, fy = self.at(pair, x), self.at(pair, y)
        for _ in range(ROUNDS):
            if high - low < 1e-7:
                break
            if fx < fy:
                high, y, fy = y, x, fx
                x = high - part * (high - low)
                fx = self.at(pair, x)
            else:
                low, x, fx = x, y, fy
                y = low + part * (high - low)
                fy = self.at(pair, y)
        return min((fx, x), (fy, y))

    def search(self):
        """The least distance of pairs that count, and the greatest excess over the allowed depth."""
        motion = self.motion
        ends = [t for segments in motion.tracks.values() for s in segments for t in (s["start"], s["end"])]
        times = numpy.unique(numpy.concatenate([numpy.linspace(0, motion.duration, SAMPLES + 1), ends]))
        poses = motion.poses(times)
        least, excess = (numpy.inf, 0.0, None), (-numpy.inf, 0.0, None)
        sampled = {}
        for (a, b), (allowed, counts) in self.pairs.items():
            balls = numpy.full(len(times), numpy.inf)
            for _, X, r, _ in self.solids[a]:
                for _, Y, s, _ in self.solids[b]:
                    between = (poses[a] @ X)[:, :3, 3] - (poses[b] @ Y)[:, :3, 3]
                    balls = numpy.minimum(balls, numpy.linalg.norm(between, axis=1) - r - s)
            wanted = least[0] + NEAR if counts else 0.0
            values = numpy.full(len(times), numpy.inf)
            for i in numpy.flatnonzero(balls < max(wanted, NEAR)):
                values[i] = distance(self.solids[a], self.solids[b], poses[a][i], poses[b][i])
            i = int(numpy.argmin(values))
            while True:
                value = self.checked((a, b), values[i], times[i])
                if value == values[i]:
                    break
                values[i] = value
                i = int(numpy.argmin(values))
            if counts and values[i] < least[0]:
                least = (values[i], times[i], (a, b))
            if -values[i] - allowed > excess[0]:
                excess = (-values[i] - allowed, times[i], (a, b))
            sampled[a, b] = values
        for (a, b), (allowed, counts) in self.pairs.items():
            values = sampled[a, b]
            padded = numpy.concatenate([[numpy.inf], values, [numpy.inf]])
            # Of a distance that stays the same, the last sample alone.
            minima = numpy.flatnonzero((values <= padded[:-2]) & (values < padded[2:]) & numpy.isfinite(values))
            for i in minima[numpy.argsort(values[minima], kind="stable")][:REFINED]:
                near = (counts and values[i] < least[0] + NEAR) or (excess[0] < 0 and values[i] < NEAR - allowed)
                if not near:
                    continue
                low, high = times[max(i - 1, 0)], times[min(i + 1, len(times) - 1)]
                value, t = self.refined((a, b), low, high)
                value = self.checked((a, b), value, t)
                if counts and value < least[0]:
                    least = (value, t, (a, b))
                if -value - allowed > excess[0]:
                    excess = (-value - allowed, t, (a, b))
        return least, excess


def answer(task):
    case = Case(task["plan"])
    (least, when, pair), (excess, at, deepest) = case.search()
    told = None
    if task["time"] is not None:
        wanted = sorted(set(task["modules"]))
        of = lambda pair: sorted({case.module[pair[0]], case.module[pair[1]]})
        pairs = [pair for pair, (_, counts) in case.pairs.items() if counts and of(pair) == wanted]
        told = min(case.at(pair, task["time"]) for pair in pairs)
    name = lambda pair: None if pair is None else [int(link) for link in pair]
    # JSON knows no infinity: where no two links come near each other, none is too deep by far.
    excess = max(excess, -1e9)
    return {
        "clearance": None if numpy.isinf(least) else float(least), "when": float(when), "pair": name(pair),
        "excess": float(excess), "at": float(at), "deepest": name(deepest), "told": None if told is None else float(told),
    }


json.dump([answer(task) for task in json.load(sys.stdin)], sys.stdout)
