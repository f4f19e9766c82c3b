"""pip's OMPL on the suite of docs/suite.md: how many problems each planner solves, how long its paths are, and how many
of them are free. Reads nothing except the JSON lines.

usage: python suite.py SUITE.jsonl [EVERY [LIMIT_SECONDS]]
"""

import itertools
import json
import math
import statistics
import sys
import time

import numpy as np
import ompl.base as ob
import ompl.geometric as og
import ompl.util as ou

PLANNERS = {"RRTConnect": og.RRTConnect, "KPIECE1": og.KPIECE1, "PRM": og.PRM}
"""Planners that stop at their first solution."""

RESOLUTION = 0.01
"""Motions are tested where the joints have moved by this, radians or metres."""

JUDGED = 1e-3
"""The judge tests paths where the joints have moved by this."""


class Polygon:
    """A convex polygon: its corners, and the normals of its sides with the least product that is inside."""

    def __init__(self, corners: list[list[float]]) -> None:
        self.corners = np.array(corners)
        sides = np.roll(self.corners, -1, axis=0) - self.corners
        self.normals = np.stack([sides[:, 1], -sides[:, 0]], axis=1)
        self.reach = (self.normals * self.corners).sum(axis=1)


def separates(polygon: Polygon, corners: np.ndarray) -> bool:
    """Whether a side of the polygon has all corners beyond it."""
    return bool(((polygon.normals @ corners.T).min(axis=1) > polygon.reach).any())


class Problem:
    """A line of the suite."""

    def __init__(self, line: str) -> None:
        read = json.loads(line)
        self.read, self.joints = read, read["arm"]["joints"]
        self.links = [[np.array(shape) for shape in link] for link in read["arm"]["links"]]
        self.obstacles = [Polygon(corners) for corners in read["obstacles"]]

    def is_free(self, q: list[float]) -> bool:
        """Whether the arm touches no obstacle."""
        at, turn = np.zeros(2), np.eye(2)
        for joint, link, value in zip(self.joints, self.links, q, strict=True):
            at = at + turn @ joint["origin"]
            if joint["type"] == "revolute":
                sine, cosine = math.sin(value), math.cos(value)
                turn = turn @ np.array([[cosine, -sine], [sine, cosine]])
            else:
                at = at + turn @ np.array(joint["direction"]) * value
            for shape in link:
                corners = shape @ turn.T + at
                placed = None
                for obstacle in self.obstacles:
                    if separates(obstacle, corners):
                        continue
                    placed = placed or Polygon(corners.tolist())
                    if not separates(placed, obstacle.corners):
                        return False
        return True

    def is_path_free(self, path: list[list[float]]) -> bool:
        """Whether the path is free at each place that the judge tests."""
        for a, b in itertools.pairwise(path):
            count = max(1, math.ceil(math.dist(a, b) / JUDGED))
            if not all(self.is_free([a[k] + (b[k] - a[k]) * i / count for k in (0, 1)]) for i in range(count + 1)):
                return False
        return True

    def solve(self, planner: type, limit: float) -> tuple[list[list[float]] | None, float]:
        """Returns the waypoints of an exact solution, or None, and the time in milliseconds."""
        space, bounds = ob.RealVectorStateSpace(2), ob.RealVectorBounds(2)
        for k, joint in enumerate(self.joints):
            bounds.setLow(k, joint["limits"][0])
            bounds.setHigh(k, joint["limits"][1])
        space.setBounds(bounds)
        setup = og.SimpleSetup(space)
        setup.setStateValidityChecker(lambda state: self.is_free([state[0], state[1]]))
        setup.getSpaceInformation().setStateValidityCheckingResolution(RESOLUTION / space.getMaximumExtent())
        ends = []
        for end in ("start", "goal"):
            state = space.allocState()
            state[0], state[1] = self.read[end]
            ends.append(state)
        setup.setStartAndGoalStates(*ends)
        setup.setPlanner(planner(setup.getSpaceInformation()))
        begin = time.perf_counter()
        setup.setup()
        setup.getPlanner().solve(ob.timedPlannerTerminationCondition(limit))
        took = (time.perf_counter() - begin) * 1e3
        if not setup.haveExactSolutionPath():
            return None, took
        return [[state[0], state[1]] for state in setup.getSolutionPath().getStates()], took


def main() -> None:
    """Prints a table in Markdown."""
    every, limit = int((sys.argv[2:] or ["1"])[0]), float((sys.argv[3:] or ["2"])[0])
    ou.RNG.setSeed(1)
    ou.setLogLevel(ou.LogLevel.LOG_NONE)
    with open(sys.argv[1]) as lines:
        problems = [Problem(line) for line in list(lines)[::every]]
    print("| planner | paths, where one exists | free | length over the bound | ms | paths, where none exists |")
    print("|---|---|---|---|---|---|")
    for name, planner in PLANNERS.items():
        found, free, wrong, lengths, times = 0, 0, 0, [], []
        for problem in problems:
            path, took = problem.solve(planner, limit)
            if problem.read["answer"] == "infeasible":
                wrong += path is not None
                continue
            times.append(took)
            if path is not None:
                found += 1
                if problem.is_path_free(path):
                    free += 1
                    length = sum(math.dist(a, b) for a, b in itertools.pairwise(path))
                    lengths.append(length / problem.read["bound"])
        feasible = sum(problem.read["answer"] == "found" for problem in problems)
        median = statistics.median(lengths) if lengths else math.nan
        print(
            f"| OMPL {name} | {found} of {feasible} | {free} | {median:.2f} | {statistics.median(times):.0f} "
            f"| {wrong} of {len(problems) - feasible} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
