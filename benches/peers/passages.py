"""RRT-Connect of OMPL on the narrow passages of `cargo bench --bench passages -- FILE`, beside the results in that file.

Both search in the plane of a ball among walls. OMPL examines a motion every `STEP` metres by the closed form of the distance from
rectangles, and shortens its path by its own default; the file's planner proves its motions between postures by a bound. A
way of OMPL counts as free if the ball keeps off the walls along it, to 0.1 mm, examined every 0.1 mm.

    python benches/peers/passages.py FILE
"""

import json
import math
import statistics
import sys
import time

from ompl import base, geometric, util

# The distance between two places of a motion that OMPL examines, m.
STEP = 1e-3
# The longest time of one search, s.
TIMEOUT = 10.0


def gap(x, y, walls, ball):
    """The least distance of the ball from the walls, m; negative where they overlap."""
    least = math.inf
    for a, b, c, d in walls:
        dx, dy = max(a - x, x - b, 0.0), max(c - y, y - d, 0.0)
        least = min(least, math.hypot(dx, dy))
    return least - ball


def search(passage, ball, clearance):
    """Returns (processor time in s, states of the path or None, number of examined states)."""
    walls = passage["walls"]
    count = 0

    def valid(state):
        nonlocal count
        count += 1
        return gap(state[0], state[1], walls, ball) > clearance

    begin = time.process_time()
    space = base.RealVectorStateSpace(2)
    bounds = base.RealVectorBounds(2)
    bounds.setLow(-1.0)
    bounds.setHigh(1.0)
    space.setBounds(bounds)
    setup = geometric.SimpleSetup(space)
    setup.setStateValidityChecker(valid)
    info = setup.getSpaceInformation()
    info.setStateValidityCheckingResolution(STEP / space.getMaximumExtent())
    start, goal = space.allocState(), space.allocState()
    for i in range(2):
        start[i], goal[i] = passage["from"][i], passage["to"][i]
    setup.setStartAndGoalStates(start, goal)
    setup.setPlanner(geometric.RRTConnect(info))
    setup.solve(TIMEOUT)
    solved = setup.haveExactSolutionPath()
    if solved:
        setup.simplifySolution()
    taken = time.process_time() - begin
    path = [(s[0], s[1]) for s in setup.getSolutionPath().getStates()] if solved else None
    return taken, path, count


def is_free(path, walls, ball):
    """True if the ball keeps off the walls along a path."""
    for (x0, y0), (x1, y1) in zip(path, path[1:]):
        steps = max(1, math.ceil(math.hypot(x1 - x0, y1 - y0) / 1e-4))
        for i in range(steps + 1):
            part = i / steps
            if gap(x0 + part * (x1 - x0), y0 + part * (y1 - y0), walls, ball) < -1e-4:
                return False
    return True


def main():
    util.setLogLevel(util.LOG_ERROR)
    # OMPL has one seed for a process.
    util.RNG.setSeed(1)
    with open(sys.argv[1], encoding="utf-8") as file:
        data = json.load(file)
    ball, clearance, seeds = data["ball"], data["clearance"], data["seeds"]
    own_times, own_solved = [], 0
    times, solved, free, counts = [], 0, 0, []
    for passage in data["passages"]:
        own_times += passage["times"]
        own_solved += sum(passage["solved"])
        for _ in range(seeds):
            taken, path, count = search(passage, ball, clearance)
            times.append(taken)
            counts.append(count)
            if path is not None:
                solved += 1
                free += is_free(path, passage["walls"], ball)
    searches = len(times)
    print("| | ways found | of these free | median |")
    print("|---|--:|--:|--:|")
    print(f"| `avoid` | {own_solved} of {searches} | proved | {1e3 * statistics.median(own_times):.2f} ms |")
    print(f"| RRT-Connect of OMPL | {solved} of {searches} | {free} | {1e3 * statistics.median(times):.2f} ms |")
    print(f"OMPL examined {statistics.median(counts):.0f} states in the median")
    if own_solved < solved or statistics.median(own_times) > statistics.median(times):
        sys.exit("fewer ways were found, or it took longer")


if __name__ == "__main__":
    main()
