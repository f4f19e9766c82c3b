"""cplan and OMPL on cells of two arms with two revolute joints each: success, collisions, cycle and processor time.

usage: python two_arms.py CPLAN FOLDER... [--kind PATTERN] [--runs N] [--limit SECONDS] [--jobs N]

The folders have cell files, as the examples `crossing_goals` and `cell_set` of the crate cplan-cell write them. OMPL
plans in the four joints of both arms, and tests motions at samples. Each motion is then judged every 50 us, by the same
tests. docs/two_arms.md explains the table.
"""

import argparse
import ctypes
import functools
import itertools
import json
import math
import multiprocessing
import pathlib
import resource
import statistics
import subprocess
import sys
import time
import tomllib
import typing
import xml.etree.ElementTree as ElementTree

import numpy as np
import ompl.base as ob
import ompl.geometric as og
import ompl.util as ou
import toppra
from scipy.interpolate import CubicHermiteSpline

INTERVAL = 5e-5
"""Time between two tests of the judge, seconds."""

SKEW = 0.02
"""Difference of the clocks for the second test, seconds: cplan's default."""

TIME_TO_TOP_SPEED = 0.25
"""cplan's default if a URDF states no acceleration, seconds."""

FINE = 0.01
"""Distance of OMPL's samples in the rows "0.01 rad"."""

LIBRARY = pathlib.Path(__file__).resolve().parents[2] / "target/peers/libtwo_arms.so"
"""Collision tests in C++."""

Motion = typing.Callable[[np.ndarray], np.ndarray]
"""Times in seconds to the values of all four joints, one row for each time."""


class Body(typing.NamedTuple):
    """A convex shape of a link: a polygon with a radius around it, and the least and the greatest height."""

    frame: int
    corners: np.ndarray
    radius: float
    heights: tuple[float, float]


def numbers(text: str | None) -> np.ndarray:
    """Returns the numbers of an attribute, or zeros if it is missing."""
    return np.array([float(word) for word in (text or "0 0 0").split()])


class Robot:
    """A URDF whose first two joints move and turn about z. All frames are parallel to the root at zero."""

    def __init__(self, file: pathlib.Path, held: dict[str, float]) -> None:
        root = ElementTree.parse(file).getroot()
        self.joints, self.bodies = [], []
        links = {link.get("name"): link for link in root.findall("link")}
        joints = {joint.find("parent").get("link"): joint for joint in root.findall("joint")}
        children = {joint.find("child").get("link") for joint in root.findall("joint")}
        (name,) = set(links) - children
        place, link = np.zeros(3), 0
        while True:
            self.add_bodies(links[name], link, place)
            joint = joints.get(name)
            if joint is None:
                break
            name, kind = joint.find("child").get("link"), joint.get("type")
            place = place + self.origin(joint)
            if kind == "revolute" and link < 2:
                limit = joint.find("limit")
                self.joints.append({key: float(limit.get(key)) for key in ("lower", "upper", "velocity")})
                self.joints[-1]["origin"] = place[:2]
                place, link = np.array([0, 0, place[2]]), link + 1
            elif kind == "prismatic":
                place = place + held.get(joint.get("name"), 0.0) * numbers(joint.find("axis").get("xyz"))
        self.tip = place[:2]

    @staticmethod
    def origin(element: ElementTree.Element) -> np.ndarray:
        """Returns the translation of an element."""
        origin = element.find("origin")
        if origin is not None and numbers(origin.get("rpy")).any():
            raise ValueError("two_arms.py reads no turned frames; take cells of SCARAs or of planar_2r.urdf")
        return numbers(None if origin is None else origin.get("xyz"))

    def add_bodies(self, element: ElementTree.Element, link: int, place: np.ndarray) -> None:
        """Adds the collision shapes of a link, whose frame is at a place in the frame of the last moving joint."""
        for collision in element.findall("collision"):
            x, y, z = place + self.origin(collision)
            box, cylinder = collision.find("geometry/box"), collision.find("geometry/cylinder")
            if box is not None:
                a, b, height = numbers(box.get("size")) / 2
                corners, radius = [[x - a, y - b], [x + a, y - b], [x + a, y + b], [x - a, y + b]], 0.0
            else:
                corners, radius = [[x, y]], float(cylinder.get("radius"))
                height = float(cylinder.get("length")) / 2
            self.bodies.append(Body(link, np.array(corners), radius, (z - height, z + height)))

    def solutions(self, base: np.ndarray, angle: float, tip: np.ndarray) -> list[list[float]]:
        """Returns the joint values within the limits that put the tip at a place."""
        first, second = self.joints
        sine, cosine = math.sin(angle), math.cos(angle)
        x, y = np.array([[cosine, sine], [-sine, cosine]]) @ (tip - base) - first["origin"]
        a, b = second["origin"][0], self.tip[0]
        bend = (x * x + y * y - a * a - b * b) / (2 * a * b)
        found = []
        for elbow in (math.acos(bend), -math.acos(bend)) if abs(bend) < 1 else ():
            shoulder = math.atan2(y, x) - math.atan2(b * math.sin(elbow), a + b * math.cos(elbow))
            joints = [math.remainder(shoulder, 2 * math.pi), elbow]
            if all(j["lower"] <= q <= j["upper"] for j, q in zip(self.joints, joints, strict=True)):
                found.append(joints)
        return found


class Cell:
    """A cell file, with the collision test of two_arms.cpp."""

    def __init__(self, file: pathlib.Path, library: ctypes.CDLL) -> None:
        self.file, self.library = file, library
        read = tomllib.loads(file.read_text())
        if "obstacle" in read:
            raise ValueError(f"{file}: two_arms.py reads no obstacles")
        self.start, goals, joints, shapes, arms = [], [], [], [], []
        for k, arm in enumerate(read["arm"]):
            robot = Robot(file.parent / arm["urdf"], arm.get("robot", {}).get("fixed", {}))
            base, angle = np.array(arm["base"]["at"]), float(arm["base"].get("angle", 0.0))
            self.start += arm["start"]["joints"]
            goal = arm["goal"]
            goals.append([goal["joints"]] if "joints" in goal else robot.solutions(base, angle, np.array(goal["tip"])))
            joints += robot.joints
            sine, cosine = math.sin(angle), math.cos(angle)
            turn = np.array([[cosine, -sine], [sine, cosine]])
            arms += [*(base + turn @ robot.joints[0]["origin"]), angle, *robot.joints[1]["origin"]]
            for body in robot.bodies:
                if body.frame == 0:
                    shapes.append((k, 0, body._replace(corners=body.corners @ turn.T + base)))
                else:
                    shapes.append((k, body.frame, body._replace(frame=2 * k + body.frame)))
        self.low = np.array([joint["lower"] for joint in joints])
        self.high = np.array([joint["upper"] for joint in joints])
        self.speed = np.array([joint["velocity"] for joint in joints])
        self.acceleration = self.speed / TIME_TO_TOP_SPEED
        self.handle = ctypes.c_void_p(library.cell_new((ctypes.c_double * 10)(*arms)))
        for _, _, body in shapes:
            corners = body.corners.flatten()
            pointer = (ctypes.c_double * len(corners))(*corners)
            library.cell_add_shape(self.handle, body.frame, ctypes.c_double(body.radius), len(body.corners), pointer)
        self.add_pairs(shapes)
        self.goals = [a + b for a in goals[0] for b in goals[1] if self.is_free(a + b)]

    def add_pairs(self, shapes: list[tuple[int, int, Body]]) -> None:
        """Adds the pairs of shapes of different links whose heights meet."""
        for (i, (arm, link, a)), (k, (other, its, b)) in itertools.combinations(enumerate(shapes), 2):
            if a.heights[0] > b.heights[1] or b.heights[0] > a.heights[1]:
                continue
            if arm != other:
                if link or its:
                    self.library.cell_add_pair(self.handle, i, k, 1)
            elif link != its:
                self.library.cell_add_pair(self.handle, i, k, 0)

    def is_free(self, q: list[float]) -> bool:
        """Whether nothing touches."""
        return self.library.cell_first_collision(self.handle, 1, (ctypes.c_double * 4)(*q)) < 0

    def distance_between(self, q: np.ndarray) -> float:
        """Returns the distance of the arms, metres."""
        return self.library.cell_distance_between(self.handle, (ctypes.c_double * 4)(*q))

    def is_motion_free(self, motion: Motion, duration: float, skew: float) -> bool:
        """Whether a motion is within the limits of the joints and free at each test, if the second clock is ahead."""
        times = np.arange(-abs(skew), duration + abs(skew) + INTERVAL, INTERVAL)
        first, second = (motion(np.clip(t, 0.0, duration)) for t in (times, times + skew))
        q = np.ascontiguousarray(np.hstack([first[:, :2], second[:, 2:]]))
        if (q < self.low - 1e-6).any() or (q > self.high + 1e-6).any():
            return False
        pointer = q.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
        return self.library.cell_first_collision(self.handle, len(q), pointer) < 0


class Validator(ob.MotionValidator):
    """Tests a straight motion at samples, in one call of C++."""

    def __init__(self, information: ob.SpaceInformation, cell: Cell, step: float) -> None:
        super().__init__(information)
        self.cell, self.step, self.ends = cell, step, ((ctypes.c_double * 4)(), (ctypes.c_double * 4)())

    def checkMotion(self, a: ob.State, b: ob.State, *_: object) -> bool:
        """Whether all samples are free."""
        for end, state in zip(self.ends, (a, b), strict=True):
            end[0], end[1], end[2], end[3] = state[0], state[1], state[2], state[3]
        return bool(self.cell.library.cell_is_motion_free(self.cell.handle, *self.ends, self.step))


def ompl_path(cell: Cell, planner: type, step: float | None, limit: float, smooth: bool) -> list[list[float]] | None:
    """Returns the simplified path of a planner, or None. If there is no step, OMPL's default is the step."""
    space, bounds = ob.RealVectorStateSpace(4), ob.RealVectorBounds(4)
    for k in range(4):
        bounds.setLow(k, cell.low[k])
        bounds.setHigh(k, cell.high[k])
    space.setBounds(bounds)
    setup = og.SimpleSetup(space)
    information = setup.getSpaceInformation()
    setup.setStateValidityChecker(lambda state: cell.is_free([state[0], state[1], state[2], state[3]]))
    default = information.getStateValidityCheckingResolution() * space.getMaximumExtent()
    information.setMotionValidator(Validator(information, cell, step or default))
    goals = ob.GoalStates(information)
    for goal in cell.goals:
        goals.addState(as_state(space, goal))
    setup.setGoal(goals)
    setup.addStartState(as_state(space, cell.start))
    setup.setPlanner(planner(information))
    setup.setup()
    until = time.process_time() + limit
    setup.getPlanner().solve(ob.PlannerTerminationCondition(lambda: time.process_time() > until))
    if not setup.haveExactSolutionPath():
        return None
    path, simplifier = setup.getSolutionPath(), og.PathSimplifier(information)
    simplifier.simplifyMax(path)
    if smooth:
        simplifier.smoothBSpline(path)
    return [[state[k] for k in range(4)] for state in path.getStates()]


def as_state(space: ob.StateSpace, q: list[float]) -> ob.State:
    """Returns a state of OMPL."""
    state = space.allocState()
    for k in range(4):
        state[k] = q[k]
    return state


def with_stops(cell: Cell, path: list[list[float]]) -> tuple[Motion, float]:
    """Returns the fastest motion on the polyline that stops at each corner, and its duration."""
    pieces, now = [], 0.0
    for a, b in itertools.pairwise(np.array(path)):
        if not (a == b).all():
            # Speed and acceleration of a parameter from 0 to 1.
            with np.errstate(divide="ignore"):
                speed, rate = ((most / np.abs(b - a)).min() for most in (cell.speed, cell.acceleration))
            ramp = min(speed / rate, 1 / math.sqrt(rate))
            lasts = ramp + 1 / (rate * ramp)
            pieces.append((now, a, b, rate, ramp, lasts))
            now += lasts
    begins = np.array([piece[0] for piece in pieces])

    def motion(times: np.ndarray) -> np.ndarray:
        q = np.empty((len(times), 4))
        chosen = np.clip(np.searchsorted(begins, times, side="right") - 1, 0, None)
        for k, (begin, a, b, rate, ramp, lasts) in enumerate(pieces):
            t = np.clip(times[chosen == k] - begin, 0, lasts)
            up, down = np.minimum(t, ramp), np.maximum(t - (lasts - ramp), 0)
            s = rate * (ramp * t - ramp * ramp / 2 + (ramp - up) ** 2 / 2 - down * down / 2)
            q[chosen == k] = a + s[:, None] * (b - a)
        return q

    return motion, now


def without_stops(cell: Cell, path: list[list[float]]) -> tuple[Motion, float] | None:
    """Returns toppra's fastest motion on the cubic spline through the waypoints, and its duration."""
    points = np.array(path)
    points = points[np.append(True, np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-9)]
    along = np.append(0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))
    limits = [
        kind(np.stack([-most, most], axis=1))
        for kind, most in (
            (toppra.constraint.JointVelocityConstraint, cell.speed),
            (toppra.constraint.JointAccelerationConstraint, cell.acceleration),
        )
    ]
    spline = toppra.SplineInterpolator(along, points, bc_type="natural")
    trajectory = toppra.algorithm.TOPPRA(limits, spline, parametrizer="ParametrizeConstAccel").compute_trajectory(0, 0)
    return trajectory and (trajectory, trajectory.duration)


def cplan_motion(cplan: str, cell: Cell, skew: float) -> tuple[dict, Motion | None]:
    """Returns cplan's answer, and its motion. Checks a distance of the arms that the answer states."""
    command = [cplan, "cell", str(cell.file), "--json", "--quiet", "--skew", str(skew)]
    answer = json.loads(subprocess.run(command, stdout=subprocess.PIPE, check=False).stdout)
    if answer["status"] != "found":
        return answer, None
    splines = [
        CubicHermiteSpline(*(np.array(arm["trajectory"][key]) for key in ("time", "position", "velocity")))
        for arm in answer["arms"]
    ]
    ends = [spline.x[-1] for spline in splines]

    def motion(times: np.ndarray) -> np.ndarray:
        return np.hstack([spline(np.minimum(times, end)) for spline, end in zip(splines, ends, strict=True)])

    near = answer["nearest"]
    q = np.hstack([spline(np.clip(t, 0, end)) for spline, end, t in zip(splines, ends, near["times"], strict=True)])
    if abs(cell.distance_between(q) - near["distance"]) > 1e-6:
        raise ValueError(f"{cell.file}: cplan and two_arms.cpp disagree about the distance of the arms")
    return answer, motion


class Run(typing.NamedTuple):
    """Result of a planner for one cell. The ratio is that of the cycle to the bound."""

    seconds: float
    found: bool = False
    free: bool = False
    free_with_skew: bool = False
    ratio: float = math.nan


def judged(cell: Cell, bound: float, seconds: float, result: tuple[Motion, float] | None) -> Run:
    """Judges a motion."""
    if result is None:
        return Run(seconds)
    free = cell.is_motion_free(*result, 0.0)
    free_with_skew = free and all(cell.is_motion_free(*result, skew) for skew in (SKEW, -SKEW))
    return Run(seconds, True, free, free_with_skew, result[1] / bound)


def row(name: str, runs: list[Run]) -> str:
    """Returns the row of a planner in Markdown. Ratios are those of the free motions."""
    ratios, seconds = [run.ratio for run in runs if run.free], [run.seconds for run in runs]
    cycle = f"{statistics.median(ratios):.2f} | {max(ratios):.2f}" if ratios else "- | -"
    found, free, with_skew = (sum(run[field] for run in runs) for field in (1, 2, 3))
    time = f"{statistics.median(seconds):.3g} s | {max(seconds):.3g} s"
    return f"| {name} | {found} of {len(runs)} | {free} | {with_skew} | {cycle} | {time} |"


def processor_time() -> float:
    """Returns the processor time of this process and its children, seconds."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(usage.ru_utime + usage.ru_stime for usage in used)


def compile_library() -> None:
    """Compiles two_arms.cpp."""
    source = pathlib.Path(__file__).parent / "cpp/two_arms.cpp"
    LIBRARY.parent.mkdir(parents=True, exist_ok=True)
    subprocess.run(["g++", "-O3", "-std=c++17", "-shared", "-fPIC", str(source), "-o", str(LIBRARY)], check=True)


def load_library() -> ctypes.CDLL:
    """Loads two_arms.cpp."""
    library = ctypes.CDLL(str(LIBRARY))
    pointer, handle = ctypes.c_void_p, ctypes.c_void_p
    library.cell_new.restype, library.cell_new.argtypes = handle, [pointer]
    library.cell_add_shape.argtypes = [handle, ctypes.c_int, ctypes.c_double, ctypes.c_int, pointer]
    library.cell_add_pair.argtypes = [handle, ctypes.c_int, ctypes.c_int, ctypes.c_int]
    library.cell_first_collision.argtypes = [handle, ctypes.c_int, pointer]
    library.cell_is_motion_free.argtypes = [handle, pointer, pointer, ctypes.c_double]
    library.cell_distance_between.restype, library.cell_distance_between.argtypes = ctypes.c_double, [handle, pointer]
    return library


def contenders(options: argparse.Namespace) -> list[tuple]:
    """Returns name, planner, step, smoothing and number of runs of OMPL's rows."""
    return [
        ("OMPL RRTConnect, 0.01 rad, stops at corners", og.RRTConnect, FINE, False, options.runs),
        ("OMPL RRTConnect, 0.01 rad, smoothed", og.RRTConnect, FINE, True, options.runs),
        ("OMPL RRTConnect, OMPL's default step, smoothed", og.RRTConnect, None, True, options.runs),
        (f"OMPL BIT\\*, {options.limit:g} s, 0.01 rad, smoothed", og.BITstar, FINE, True, 1),
    ]


def measure(file: pathlib.Path, options: argparse.Namespace) -> list[list[Run]]:
    """Returns the runs of each row for one cell."""
    print(file, file=sys.stderr, flush=True)
    cell = Cell(file, load_library())
    motions = []
    for skew in (0.0, SKEW):
        begin = processor_time()
        answer, motion = cplan_motion(options.cplan, cell, skew)
        motions.append((answer, processor_time() - begin, motion and (motion, answer["duration"])))
    # The bound of `--skew 0` holds for all motions.
    bound = motions[0][0]["lower_bound"] or math.nan
    rows = [[judged(cell, bound, seconds, result)] for _, seconds, result in reversed(motions)]
    for _, planner, step, smooth, count in contenders(options):
        rows.append([])
        for _ in range(count):
            begin = processor_time()
            path = ompl_path(cell, planner, step, options.limit, smooth)
            result = path and (without_stops if smooth else with_stops)(cell, path)
            rows[-1].append(judged(cell, bound, processor_time() - begin, result))
    return rows


def main() -> None:
    """Prints a table in Markdown."""
    parser = argparse.ArgumentParser(description="cplan and OMPL on cells of two arms")
    parser.add_argument("cplan")
    parser.add_argument("folders", nargs="+", type=pathlib.Path)
    parser.add_argument("--kind", default="*", help="pattern for the names of cells")
    parser.add_argument("--runs", type=int, default=3, help="runs of RRTConnect for each cell")
    parser.add_argument("--limit", type=float, default=1.0, help="processor time of a planner for each cell, seconds")
    parser.add_argument("--jobs", type=int, default=1, help="number of cells at once")
    options = parser.parse_args()
    ou.RNG.setSeed(1)
    ou.setLogLevel(ou.LogLevel.LOG_NONE)
    toppra.setup_logging("ERROR")
    compile_library()
    files = sorted(file for folder in options.folders for file in folder.glob(f"{options.kind}.toml"))
    if not files:
        sys.exit(f"no cell {options.kind}.toml in {', '.join(map(str, options.folders))}")
    try:
        with multiprocessing.Pool(options.jobs) as pool:
            cells = pool.map(functools.partial(measure, options=options), files, chunksize=1)
    except ValueError as error:
        sys.exit(str(error))
    names = ["cplan", "cplan, `--skew 0`", *(name for name, *_ in contenders(options))]
    print("| planner | found | free | free, clocks 20 ms apart | cycle over bound: median | max | time: median | max |")
    print("|---|---|---|---|---|---|---|---|")
    for name, runs in zip(names, zip(*cells, strict=True), strict=True):
        print(row(name, list(itertools.chain(*runs))))


if __name__ == "__main__":
    main()
