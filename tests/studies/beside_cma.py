"""`cmaes` of studies beside `cma` (Hansen, Akimoto, Baudis): evaluations to the target on ten functions.

    python tests/studies/beside_cma.py MODL [SEEDS]

Both search the cube [-5, 5]^5 from its middle with a standard deviation of 3; the least is at (1, 1.5, 2, ...), value 0.
Prints a table, and ends with 1 if a median is above 1.1 times that of `cma`.
"""

import csv
import math
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import cma
import numpy as np

DIMENSION, BUDGET, TARGET = 5, 12_000, 1e-8
SHIFT = [1 + 0.5 * i for i in range(DIMENSION)]


def powers(x, top):
    return [top ** (i / (len(x) - 1)) for i in range(len(x))]


# Each function in Python, of the distance z from the optimum, and the same in Modl.
FUNCTIONS = {
    "sphere": (lambda z: float(z @ z), "sum([x ^ 2 for x in z])"),
    "ellipsoid": (
        lambda z: float(np.array(powers(z, 1e6)) @ z**2),
        "sum([exp(ln(1e6) * i / 4) * z[i] ^ 2 for i in 0..5])",
    ),
    "cigar": (lambda z: float(z[0] ** 2 + 1e6 * (z[1:] @ z[1:])), "z[0] ^ 2 + 1e6 * sum([z[i] ^ 2 for i in 1..5])"),
    "discus": (lambda z: float(1e6 * z[0] ** 2 + z[1:] @ z[1:]), "1e6 * z[0] ^ 2 + sum([z[i] ^ 2 for i in 1..5])"),
    "rosenbrock": (
        lambda z: float(sum(100 * ((z[i] + 1) ** 2 - z[i + 1] - 1) ** 2 + z[i] ** 2 for i in range(4))),
        "sum([100 * ((z[i] + 1) ^ 2 - z[i + 1] - 1) ^ 2 + z[i] ^ 2 for i in 0..4])",
    ),
    "different powers": (
        lambda z: float(sum(abs(z[i]) ** (2 + i) for i in range(5))),
        "sum([abs(z[0]) ^ 2, abs(z[1]) ^ 3, abs(z[2]) ^ 4, abs(z[3]) ^ 5, abs(z[4]) ^ 6])",
    ),
    "schwefel 1.2": (
        lambda z: float((np.cumsum(z) ** 2).sum()),
        "sum([sum([z[j] for j in 0..i + 1]) ^ 2 for i in 0..5])",
    ),
    "zakharov": (
        lambda z: float(z @ z + (s := sum(0.5 * (i + 1) * z[i] for i in range(5))) ** 2 + s**4),
        "sum([x ^ 2 for x in z]) + s(z) ^ 2 + s(z) ^ 4",
    ),
    "ackley": (
        lambda z: float(
            20 * (1 - math.exp(-0.2 * math.sqrt(z @ z / 5)))
            + math.e
            - math.exp(sum(math.cos(2 * math.pi * x) for x in z) / 5)
        ),
        "20 * (1 - exp(-0.2 * sqrt(sum([x ^ 2 for x in z]) / 5))) + exp(1) - exp(sum([cos(x * 1turn) for x in z]) / 5)",
    ),
    "exponential": (lambda z: 1 - math.exp(-0.5 * float(z @ z)), "1 - exp(-0.5 * sum([x ^ 2 for x in z]))"),
}


def reference(function, seed):
    settings = {
        "bounds": [-5, 5], "seed": seed, "verbose": -9, "maxfevals": BUDGET,
        "tolfun": 0, "tolfunhist": 0, "tolx": 0, "tolflatfitness": 10**9, "tolstagnation": 10**9,
    }  # fmt: skip
    search = cma.CMAEvolutionStrategy([0.0] * DIMENSION, 3.0, settings)
    count = 0
    while count < BUDGET:
        points = search.ask()
        values = [function(np.array(x) - SHIFT) for x in points]
        for at, value in enumerate(values):
            if value < TARGET:
                return count + at + 1
        count += len(points)
        search.tell(points, values)
        if search.stop():
            break
    return math.inf


def program(words):
    axes = ", ".join(f"x{i} in -5.0..5" for i in range(DIMENSION))
    shifted = ", ".join(f"x{i} - {SHIFT[i]}" for i in range(DIMENSION))
    return (
        "record Row { cost: Number }\n"
        "fn s(z: List<Number>) -> Number = sum([0.5 * (i + 1) * z[i] for i in 0..5])\n"
        f"fn f(z: List<Number>) -> Number = {words}\n"
        f"study search({axes}) by cmaes(minimise: cost, budget: {BUDGET}) = Row(cost: f([{shifted}]))\n"
    )


def own(modl, words, seed, folder):
    file = Path(folder) / "f.mod"
    file.write_text(program(words))
    command = [modl, "study", file, "-o", folder, "--seed", str(seed), "--threads", "1"]
    subprocess.run(command, check=True, capture_output=True)
    with open(Path(folder) / "search.csv", newline="") as stream:
        rows = list(csv.DictReader(stream))
    for count, row in enumerate(rows, 1):
        if row["code"] == "" and float(row["cost"]) < TARGET:
            return count
    return math.inf


def main():
    modl, seeds = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 20
    worst = 0.0
    print("| function | `cma` | `cmaes` | ratio |\n|---|--:|--:|--:|")
    for name, (function, words) in FUNCTIONS.items():
        wanted = statistics.median(reference(function, seed) for seed in range(1, seeds + 1))
        with tempfile.TemporaryDirectory() as folder:
            found = statistics.median(own(modl, words, seed, folder) for seed in range(1, seeds + 1))
        ratio = found / wanted
        worst = max(worst, ratio)
        print(f"| {name} | {wanted:.0f} | {found:.0f} | {ratio:.2f} |", flush=True)
    return 1 if worst > 1.1 else 0


sys.exit(main())
