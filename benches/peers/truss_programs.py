"""Random programs of trusses, by seed: walks in random headings of trusses in random orientations, and morphs into random shapes.

    python benches/peers/truss_programs.py FOLDER [COUNT] [SEED]

Two of three programs walk, one morphs. Half of the walks are of octets, a tetrahelix and an octahedron; the others of an irregular
octahedron with an inner node, in a random orientation, which is put down and falls to where it rests.
"""

import math
import pathlib
import random
import sys

FRAMES = [
    "octet(edge: 2m, divisions: 2)",
    "octet(edge: 3m, divisions: 3, interior: false)",
    "octet(edge: 4m, divisions: 4, interior: false)",
    "tetrahelix(5, edge: 1m)",
    "from_mesh(octahedron(edge: 1m))",
]
SHAPES = ["cube(edge: {0:.2f}m)", "ell(length: {1:.2f}m, width: {2:.2f}m)", "tetrahedron(edge: {1:.2f}m)", "octahedron(edge: {0:.2f}m)"]


def irregular(dice):
    """An octahedron whose corners are moved, with a node inside, turned by a random rotation."""
    w, x, y, z = (dice.gauss(0, 1) for _ in range(4))
    n = math.sqrt(w * w + x * x + y * y + z * z)
    w, x, y, z = w / n, x / n, y / n, z / n
    rows = [
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    ]
    corners = [tuple(sign * (k == axis) for k in range(3)) for axis in range(3) for sign in (1, -1)] + [(0, 0, 0)]
    corners = [[c + dice.uniform(-0.12, 0.12) for c in corner] for corner in corners]
    turned = [[sum(a * b for a, b in zip(row, corner)) for row in rows] for corner in corners]
    lines = [f"  node n{i} = [{p[0]:.4f}m, {p[1]:.4f}m, {p[2] + 2:.4f}m]" for i, p in enumerate(turned)]
    pairs = [(a, b) for a in range(6) for b in range(a + 1, 6) if a // 2 != b // 2] + [(a, 6) for a in range(6)]
    lines += [f"  strut n{a} -- n{b}" for a, b in pairs]
    return "truss T of PneumaticReel {\n" + "\n".join(lines) + "\n}"


def walk(dice):
    truss = irregular(dice) if dice.random() < 0.5 else f"truss T of PneumaticReel = {dice.choice(FRAMES)}"
    heading, far = dice.uniform(0, 2 * math.pi), dice.uniform(1.0, 4.0)
    place = f"[{far * math.cos(heading):.3f}m, {far * math.sin(heading):.3f}m, 0m]"
    objective = dice.choice(["springs", "lengths", "restoring"])
    return f"""use std.truss.PneumaticReel
use std.shapes.octahedron
{truss}
let walk = locomote(T, path: [{place}], objective: {objective})
print(walk.ended, walk.steps, walk.rolls)
emit(walk, "NAME.plan.json")
"""


def morph(dice):
    shape = dice.choice(SHAPES).format(dice.uniform(1.4, 2.2), dice.uniform(2.0, 3.2), dice.uniform(0.8, 1.2))
    return f"""use std.truss.PneumaticReel
use std.shapes.{{cube, ell, tetrahedron, octahedron}}
truss T of PneumaticReel = {FRAMES[2]}
let made = morph(T, {shape}, budget: {dice.randrange(40, 120)})
print(made.ended, made.steps, made.rms)
emit(made, "NAME.plan.json")
"""


def main(folder, count=100, seed=1):
    dice = random.Random(int(seed))
    for index in range(int(count)):
        name = f"random_{index:03}"
        text = (morph if index % 3 == 2 else walk)(dice)
        pathlib.Path(folder, name + ".mod").write_text(text.replace("NAME", name))


if __name__ == "__main__":
    main(*sys.argv[1:])
