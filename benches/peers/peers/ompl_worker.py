"""One run of one planner of pip's OMPL, in a process of its own: OMPL takes its seed before anything else.

usage: python ompl_worker.py CHECKER SCENE PLANNER SEED LIMIT_SECONDS
"""

import ctypes
import json
import math
import sys
import time

import ompl.base as ob
import ompl.geometric as og
import ompl.util as ou

RESOLUTION = 0.01
"""Motions are tested where no joint has moved by more than this, radians."""

PLANNERS = {"RRTConnect": og.RRTConnect, "PRM": og.PRM, "RRT*": og.RRTstar}
"""Those that run on circles: BIT* and AORRTC ask for a sampler that knows none, and Python cannot set another."""


def collision_test(library: str, scene: str) -> tuple[ctypes.CDLL, ctypes.c_void_p]:
    """The compiled checker and its scene: a validity check in Python itself would take a hundred times as long."""
    checker = ctypes.CDLL(library)
    checker.scene_read.restype = ctypes.c_void_p
    checker.scene_read.argtypes = [ctypes.c_char_p]
    checker.scene_collides.argtypes = [ctypes.c_void_p, ctypes.c_double, ctypes.c_double]
    read = checker.scene_read(scene.encode())
    if read is None:
        sys.exit(1)
    return checker, ctypes.c_void_p(read)


def main() -> None:
    """Prints a JSON object."""
    library, scene, name, seed, limit = sys.argv[1:]
    ou.RNG.setSeed(int(seed))
    ou.setLogLevel(ou.LogLevel.LOG_NONE)
    checker, handle = collision_test(library, scene)
    collides = checker.scene_collides

    space = ob.CompoundStateSpace()
    for _ in range(2):
        space.addSubspace(ob.SO2StateSpace(), 1.0)
    setup = og.SimpleSetup(space)
    setup.setStateValidityChecker(lambda state: not collides(handle, state[0].value, state[1].value))
    setup.getSpaceInformation().setStateValidityCheckingResolution(RESOLUTION / math.pi)
    ends = []
    with open(scene) as lines:
        words = {line.split()[0]: line.split()[1:] for line in lines}
    for end in ("start", "goal"):
        state = space.allocState()
        state[0].value, state[1].value = map(float, words[end])
        ends.append(state)
    setup.setStartAndGoalStates(*ends)
    if name == "RRT*":
        objective = ob.PathLengthOptimizationObjective(setup.getSpaceInformation())
        # Any cost satisfies an infinite threshold: the first solution ends the run.
        objective.setCostThreshold(ob.Cost(math.inf))
        setup.setOptimizationObjective(objective)
    setup.setPlanner(PLANNERS[name](setup.getSpaceInformation()))

    start = time.perf_counter()
    setup.setup()
    status = setup.getPlanner().solve(ob.timedPlannerTerminationCondition(float(limit)))
    report = {"status": str(status), "ms": (time.perf_counter() - start) * 1e3}
    if setup.haveExactSolutionPath():
        report["path"] = [[state[0].value, state[1].value] for state in setup.getSolutionPath().getStates()]
    print(json.dumps(report))


if __name__ == "__main__":
    main()
