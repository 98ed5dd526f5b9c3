"""Least durations of paths by toppra: reads {"paths": [{"points", "speed", "acceleration"}]}, writes the seconds of each.

The points of a path are dense; their parameter is the length of the path, so that its derivative is nowhere zero.
"""

import json
import sys

import numpy as np
import toppra as ta
import toppra.algorithm as algo
import toppra.constraint as constraint

ta.setup_logging("ERROR")


def seconds(path):
    points = np.array(path["points"])
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    spline = ta.SplineInterpolator(length, points, bc_type="not-a-knot")
    limits = [
        constraint.JointVelocityConstraint(np.array(path["speed"])),
        constraint.JointAccelerationConstraint(
            np.array(path["acceleration"]),
            discretization_scheme=constraint.DiscretizationType.Interpolation,
        ),
    ]
    grid = np.linspace(0, length[-1], path["grid"])
    instance = algo.TOPPRA(limits, spline, gridpoints=grid, solver_wrapper="seidel")
    _, speeds, _ = instance.compute_parameterization(0, 0)
    return float(np.sum(2 * np.diff(grid) / (speeds[1:] + speeds[:-1])))


cases = json.load(sys.stdin)["paths"]
json.dump([seconds(path) for path in cases], sys.stdout)
