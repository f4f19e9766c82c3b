"""Checks of configurations and motions: `check` and `verify`. Comparisons of planners: `compare`.

Results have the members of the program's JSON as attributes; missing ones are None. `to_dict` and `to_json` return the
JSON itself.
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field, fields, is_dataclass
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from types import UnionType
from typing import TYPE_CHECKING, Any, TypeVar, get_args, get_origin, get_type_hints, overload

from cplan import _frames
from cplan._cplan import Arm, Plan, Problem, World
from cplan._cplan import check as _check
from cplan._cplan import compare as _compare
from cplan._cplan import compared_problems as _compared_problems
from cplan._cplan import verify as _verify
from cplan._frames import Trajectory, listed
from cplan.planning import options, words

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
else:
    # Only arrays need numpy, so findings are made before it is loaded.
    ArrayLike = Any

Pair = tuple[float, float]
Vector = tuple[float, float, float]
Side = tuple[Pair, Pair]


@dataclass(frozen=True)
class _Findings:
    _: KW_ONLY
    _json: str = field(repr=False)

    def to_json(self) -> str:
        """Returns the output of the program with `--json`, byte for byte except for measured times."""
        return self._json

    def to_dict(self) -> dict[str, Any]:
        """Returns the JSON as dictionaries and lists."""
        found: dict[str, Any] = json.loads(self._json)
        return found


@dataclass(frozen=True)
class Basis:
    """The plane of motion: directions of its coordinates and of heights in the root frame."""

    u: Vector
    v: Vector
    normal: Vector


@dataclass(frozen=True)
class Corner:
    """A corner in the other shape: plane coordinates, and the distance to the nearest side; metres."""

    at: Pair
    depth: float


@dataclass(frozen=True)
class Contact:
    """A link and an obstacle that touch, or are nearer than the required distance; lengths in metres.

    `depth` is the penetration depth; a negative value is a distance. For polygons, there are the corners of each in the
    other, and the sides that cross: the link's and the obstacle's.
    """

    link: str
    body: str
    obstacle: str
    touching: bool
    depth: float
    link_corners_inside: tuple[Corner, ...]
    obstacle_corners_inside: tuple[Corner, ...]
    crossing_sides: tuple[tuple[Side, Side], ...]


@dataclass(frozen=True)
class NearestFree:
    """The nearest free configuration: its distance in joint space, and its clearance in metres.

    `resolution` is the spacing of the tested values of joint 1; joint 2 is exact for each.
    """

    configuration: Pair
    distance: float
    clearance: float | None
    resolution: float


@dataclass(frozen=True)
class Motors:
    """The shafts of both motors, if the world describes them: their angles in radians.

    `within_limits` is false if the elbow's motor on the base is beyond its range.
    """

    angles: Pair
    within_limits: bool


@dataclass(frozen=True)
class Check(_Findings):
    """The reasons why a configuration is free or not.

    `clearance` is the least signed distance to an obstacle, `required` the required distance, `tip` the position of the
    tip; all in metres.
    """

    free: bool
    configuration: Pair
    within_limits: tuple[bool, bool]
    motors: Motors | None
    tip: Pair
    clearance: float | None
    required: float
    plane: Basis
    contacts: tuple[Contact, ...]
    nearest_free: NearestFree | None


@dataclass(frozen=True)
class Encounter:
    """A link and an obstacle at a moment of a motion.

    `depth` is the penetration depth in metres; a negative value is a distance. The moment is a `time` in seconds. For a
    path without times it is a `waypoint`, counted from 0, with the fraction of the segment to the next one. `sample` is
    the last one at or before the moment.
    """

    link: str
    body: str
    obstacle: str
    depth: float
    time: float | None
    waypoint: float | None
    sample: int
    configuration: Pair


@dataclass(frozen=True)
class BrokenLimit:
    """A limit that a motion breaks: the reached and the allowed value, in rad or m and seconds, and the moment, as in
    `Encounter`.
    """

    joint: str
    limit: str
    value: float
    allowed: float
    time: float | None
    waypoint: float | None
    sample: int
    configuration: Pair


@dataclass(frozen=True)
class TurnContact:
    """The orientation at which an object that is turned hits an obstacle, in radians."""

    angle: float
    obstacle: str


@dataclass(frozen=True)
class Turn:
    """A turn of the wrist while the arm does not move: orientations of the object in radians; `clearance` in metres."""

    from_: float
    to: float
    seconds: float
    clearance: float | None
    contact: TurnContact | None


@dataclass(frozen=True)
class Step:
    """The result for a step of a task. Numbers of steps and cycles count from 1; `seconds` is the duration of its
    motion.
    """

    step: int
    cycle: int
    action: str
    object: str | None
    carried: str | None
    verdict: str
    first_sample: int
    last_sample: int
    seconds: float
    clearance: float | None
    nearest: Encounter | None
    first_contact: Encounter | None
    free_until: float | None
    deepest: Encounter | None
    undecided: Encounter | None
    turn: Turn | None
    limits_broken: tuple[BrokenLimit, ...]
    faults: tuple[str, ...]


@dataclass(frozen=True)
class Verification(_Findings):
    """The result of verifying a whole motion, also between its samples.

    `verdict` is one of free, undecided, claims (values stated in the file are wrong), ends (the motion does not lead
    from start to goal), limits, task (it is not the task of the world), collision. `clearance` is a proven lower bound
    on the distance to every obstacle, in metres.
    """

    verdict: str
    joints: tuple[str, str]
    units: tuple[str, str]
    samples: int
    duration: float | None
    required: float
    clearance: float | None
    nearest: Encounter | None
    first_contact: Encounter | None
    free_until: float | None
    deepest: Encounter | None
    undecided: Encounter | None
    limits_broken: tuple[BrokenLimit, ...]
    faults: tuple[str, ...]
    not_judged: tuple[str, ...]
    steps: tuple[Step, ...] | None
    notes: tuple[str, ...]

    @property
    def free(self) -> bool:
        """True if the motion is proven free, within all limits, and solves the problem."""
        return self.verdict == "free"


@dataclass(frozen=True)
class StageTimes:
    """Seconds that the stages of a run took."""

    build: float | None
    query: float | None
    certify: float | None
    prove: float | None
    total: float | None


@dataclass(frozen=True)
class Run:
    """A planner's run on a problem.

    `length` is the length of the path in joint space, `ratio` its ratio to the shortest path of all planners,
    `over_optimum` its ratio to the proven lower bound. `clearance` is in metres, `duration` of the motion in seconds.
    `size` has the sizes of the planner's data by name.
    """

    planner: str
    path_kind: str
    outcome: str
    length: float | None
    paths: dict[str, dict[str, float | None] | None] | None
    ratio: float | None
    over_optimum: float | None
    pieces: int | None
    clearance: float | None
    duration: float | None
    size: dict[str, int] | None
    time: StageTimes
    memory: int | None
    note: str | None
    reason: str | None


@dataclass(frozen=True)
class _Compared(_Findings):
    _: KW_ONLY
    _text: str = field(repr=False)
    _markdown: str = field(repr=False)
    _csv: str = field(repr=False)

    def __str__(self) -> str:
        return self._text

    def _repr_markdown_(self) -> str:
        return self._markdown

    def to_csv(self) -> str:
        """Returns the output of the program with `--csv`: one line per run."""
        return self._csv

    def to_columns(self) -> dict[str, list[Any]]:
        """Returns one row per run with the columns of `to_csv`, as `pandas.DataFrame` and `polars.DataFrame` accept
        them; None if there is no value.
        """
        rows = list(csv.DictReader(io.StringIO(self._csv)))
        return {name: [_entry(name, row[name]) for row in rows] for name in rows[0]}

    def to_pandas(self) -> Any:
        """Returns the table as a pandas DataFrame; needs pandas."""
        return _frames.pandas(self.to_columns())


_WORDS = ("problem", "planner", "outcome", "note", "reason")
_COUNTS = ("nodes", "edges", "cells", "sweeps", "expanded", "memory_bytes")


def _entry(column: str, text: str) -> Any:
    if not text:
        return None
    return text if column in _WORDS else int(text) if column in _COUNTS else float(text)


@dataclass(frozen=True)
class ProblemRuns:
    """The planners' runs on a problem; lengths are in `length_unit`. `lower_bound` is a proven lower bound on the
    length of all paths.

    `start` and `goal` are set if they were drawn at random.
    """

    problem: str
    length_unit: str
    lower_bound: float | None
    contradictory: bool
    planners: tuple[Run, ...]
    start: Pair | None
    goal: Pair | None


@dataclass(frozen=True)
class Comparison(ProblemRuns, _Compared):
    """A comparison of planners on one problem."""


@dataclass(frozen=True)
class Tally:
    """The number of a planner's runs for each outcome, and the distributions of their figures."""

    planner: str
    found: int
    infeasible: int
    unknown: int
    total: int
    distributions: dict[str, dict[str, float]]


@dataclass(frozen=True)
class Comparisons(_Compared):
    """A comparison of planners on random problems in one world; `summary` is in words."""

    title: str
    queries: int
    seed: int
    problems: tuple[ProblemRuns, ...]
    planners: tuple[Tally, ...]
    summary: tuple[str, ...]
    contradictions: tuple[str, ...]


_Made = TypeVar("_Made")


def _made(kind: type[_Made], data: Any, **given: Any) -> _Made:
    """Returns an object from JSON; missing members are empty or None."""
    types = get_type_hints(kind)
    # Names that Python reserves have a trailing underscore.
    members = {each.name: data.get(each.name.rstrip("_")) for each in fields(kind) if each.init and each.name[0] != "_"}  # type: ignore[arg-type]
    return kind(**{name: _value(types[name], value) for name, value in members.items()}, **given)


def _value(kind: Any, value: Any) -> Any:
    if isinstance(kind, UnionType):
        return None if value is None else _value(get_args(kind)[0], value)
    if get_origin(kind) is tuple:
        of, *others = get_args(kind)
        kinds = [of] * len(value or []) if others == [...] else [of, *others]
        return tuple(_value(each, entry) for each, entry in zip(kinds, value or []))
    return _made(kind, value) if is_dataclass(kind) and isinstance(kind, type) else value


def check(arm: Arm, world: World, at: Sequence[float] | str, *, clearance: float | None = None) -> Check:
    """Checks whether a configuration is free: contacts, their depth, limits, and the nearest free configuration.

    `at` are joint values, base to tip, radians or metres, or a text such as "20deg,-60deg". `clearance` (metres)
    replaces that of the world.

    >>> arm = Arm.rr([1.0, 0.8], width=0.06)
    >>> found = check(arm, World({"circle": {"center": [1.6, 0.0], "radius": 0.1}, "name": "post"}), at=[0.0, 0.0])
    >>> found.free, found.contacts[0].obstacle, found.contacts[0].depth
    (False, 'post', 0.13)
    """
    place = at if isinstance(at, str) else ",".join(str(float(value)) for value in at)
    text = _check(arm, world, place, clearance)
    return _made(Check, json.loads(text), _json=text)


def verify(
    arm: Arm,
    world: World,
    motion: str | PathLike[str] | Plan | Trajectory | ArrayLike,
    *,
    start: Sequence[float] | str | None = None,
    goal: Sequence[float] | str | None = None,
    goal_tip: Sequence[float] | None = None,
    clearance: float | None = None,
    anywhere: bool = False,
    unwrap: bool = False,
) -> Verification:
    """Verifies any motion, also between samples: it must be collision-free, within the limits, and lead from start to
    goal.

    `motion` is a file (.json of cplan, .csv, .yaml or .mcap of ROS 2), a plan with a motion, or a `Trajectory`. It can
    also be an array of waypoints, shape `(n, 2)`, with straight segments between them, or a tuple of arrays `(time,
    position)`, shapes `(n,)` and `(n, 2)`, optionally with velocities and accelerations. Joint values are in radians or
    metres, base to tip; times in seconds.

    `start`, `goal`, `goal_tip` and `clearance` replace those of the world. With `anywhere`, the motion may begin and
    end anywhere. With `unwrap`, joints without limits take the shorter direction from sample to sample.

    >>> arm = Arm.rr([1.0, 0.8], width=0.06)
    >>> world = World({"circle": {"center": [1.6, 0.0], "radius": 0.1}}, start=[1.0, 0.0], goal=[-1.0, 0.0])
    >>> verify(arm, world, [[1.0, 0.0], [-1.0, 0.0]]).verdict
    'collision'
    >>> verify(arm, world, [[1.0, 0.0], [0.5, 1.5], [-1.0, 1.5], [-1.0, 0.0]]).verdict
    'free'
    """
    asked = options(start=start, goal=goal, goal_tip=goal_tip, clearance=clearance)
    file = motion if isinstance(motion, (str, PathLike)) else None
    text = None if file is not None else _motion(arm, world, motion)
    found = _verify(arm, world, file, text, asked, anywhere, unwrap)
    return _made(Verification, json.loads(found), _json=found)


def _motion(arm: Arm, world: World, motion: Any) -> str:
    """Returns a motion that is not a file as the text of a JSON file."""
    if isinstance(motion, Plan):
        return motion.to_json()
    if isinstance(motion, Trajectory):
        rows = [motion.time, motion.position, motion.velocity, motion.acceleration]
        return _document(motion.joints, rows, motion.interpolation)
    joints = arm.joints(world)
    if isinstance(motion, tuple):
        return _document(joints, motion, None)
    return json.dumps({"joints": joints, "path": listed(motion)})


def _document(joints: list[str], rows: Sequence[Any], interpolation: str | None) -> str:
    names = ["time", "position", "velocity", "acceleration"]
    samples = {name: listed(row) for name, row in zip(names, rows)}
    return json.dumps({"joints": joints, "interpolation": interpolation, "trajectory": samples})


Planner = Callable[[Problem], ArrayLike | tuple[ArrayLike, ...] | Plan | Trajectory | None]
"""A planner in Python: a function from a problem to a motion, as `verify` takes it; None if it finds no motion."""


@overload
def compare(
    arm: Arm,
    world: World,
    *,
    planners: Sequence[str] | Mapping[str, Planner | None] = (),
    variants: Sequence[str] = (),
    queries: None = None,
    **more: Any,
) -> Comparison: ...
@overload
def compare(
    arm: Arm,
    world: World,
    *,
    planners: Sequence[str] | Mapping[str, Planner | None] = (),
    variants: Sequence[str] = (),
    queries: int,
    **more: Any,
) -> Comparisons: ...
def compare(
    arm: Arm,
    world: World,
    *,
    planners: Sequence[str] | Mapping[str, Planner | None] = (),
    variants: Sequence[str] = (),
    queries: int | None = None,
    **more: Any,
) -> Comparison | Comparisons:
    """Compares planners: outcome, length relative to the proven optimum, clearance, duration, and the times of the
    stages.

    `planners` are names; by default all. `variants` are planners with their own options, such as "trapezoid --path
    own". `queries` is a number of random start-goal pairs, which replace those of the world. All other options are
    those of `cplan compare`, by name, such as the `seed` of the pairs. Ctrl-C ends it, except with `jobs=2` and more.

    Your own planners are functions from a `Problem` to a motion: `planners={"mine": f}`. Names with None are planners
    of cplan, `{"mine": f, "shortest": None}`; without any, all run beside yours. Each motion is judged as by `verify`.

    >>> arm = Arm.rr([1.0, 0.8], width=0.06)
    >>> world = World({"circle": {"center": [1.6, 0.0], "radius": 0.1}}, start=[1.0, 0.2], goal=[-1.0, -0.2])
    >>> compared = compare(arm, world, planners=["visibility", "wavefront"], cells=64)
    >>> [(run.planner, run.outcome) for run in compared.planners]
    [('visibility', 'found'), ('wavefront', 'found')]
    >>> own = {"straight": lambda problem: [problem.start, problem.goals[0]], "shortest": None}
    >>> [(run.planner, run.outcome, run.reason) for run in compare(arm, world, planners=own).planners]
    [('shortest', 'found', None), ('straight', 'unknown', 'the path collides: link "link 2" and obstacle "obstacle 1"')]
    """
    own = {name: f for name, f in planners.items() if f is not None} if isinstance(planners, Mapping) else {}
    asked = [f"--planner={name}" for name in planners if name not in own]
    asked += [f"--with={variant}" for variant in variants] + words(queries=queries, **more)
    with TemporaryDirectory() as folder:
        if own:
            ends = {name: more.get(name) for name in ("start", "goal", "goal_tip", "clearance")}
            for file, query in _compared_problems(arm, world, asked):
                start, goal = query or (ends["start"], ends["goal"])
                problem = Problem(arm, world, options(**{**ends, "start": start, "goal": goal}))
                for name, planner in own.items():
                    place = Path(folder, name)
                    place.mkdir(exist_ok=True)
                    motion = planner(problem)
                    if motion is not None:
                        Path(place, f"{file}.json").write_text(_motion(arm, world, motion))
            asked.append(f"--paths={folder}")
        texts = _compare(arm, world, asked)
    given = dict(zip(["_json", "_text", "_markdown", "_csv"], texts))
    data = json.loads(texts[0])
    return _made(Comparison, data, **given) if queries is None else _made(Comparisons, data, **given)
