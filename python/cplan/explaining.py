"""Why there is no motion and what opens a way; of one that there is, what shapes it: `explain`."""

import html
import json
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, field

from cplan._cplan import Arm, World
from cplan._cplan import explain as _explain
from cplan._cplan import explain_drawn as _explain_drawn
from cplan.findings import Pair, _Findings, _made
from cplan.planning import _options, words


@dataclass(frozen=True)
class Change:
    """A change of one thing that opens a way: by `opens` a path is certified, by `closed` it is proven that there is none; metres or radians.

    An obstacle is "moved" in a `direction`, "eroded" on all sides or "scaled" `to` a part of its size; a limit is "widened", the clearance
    "lowered". It opens a way `among` all things of the "world", or among its "set" alone, where another set closes the world, too.
    """

    change: str
    opens: float
    closed: float
    among: str
    direction: Pair | None
    to: float | None


@dataclass(frozen=True)
class Blocker:
    """A member of a set that blocks: an "obstacle" by `name` and `number`, from 1; a "limit" of a `joint` at a `side`; or the "clearance".

    `without` it, among the others of its set, a path is "found" and certified, or it is "unknown" whether there is one.
    """

    kind: str
    name: str | None
    number: int | None
    joint: str | None
    side: str | None
    without: str
    changes: tuple[Change, ...]


@dataclass(frozen=True)
class ProofBox:
    """A box of configurations, from `lower` to `upper`, in all of which a piece of a link hits a part of an obstacle; counted from 0."""

    lower: Pair
    upper: Pair
    link: int
    piece: int
    obstacle: int
    part: int


@dataclass(frozen=True)
class BlockingSet:
    """A set with all of which there is no motion, which the boxes prove (none where start or goal is not free); `irreducible` if without any one there is."""

    blockers: tuple[Blocker, ...]
    proof: tuple[ProofBox, ...]
    irreducible: bool


@dataclass(frozen=True)
class Hit:
    """Two shapes that are nearer than they may be, by so many metres."""

    between: str
    lacking: float


@dataclass(frozen=True)
class GivesWay:
    """When everything gives way by `opens` there is a path, by `closed` not yet; metres."""

    opens: float
    closed: float


@dataclass(frozen=True)
class Bottleneck:
    """Where the motion gets stuck: a configuration, a place in the plane, by how much it is too narrow; metres."""

    joints: Pair
    point: Pair
    too_narrow_by: float
    gives_way: GivesWay
    hits: tuple[Hit, ...]


@dataclass(frozen=True)
class NearbyFree:
    """The nearest free configuration: its distance in joint space, and how far the tip moves to it, metres."""

    joints: Pair
    distance: float
    tip_moves: float


@dataclass(frozen=True)
class BlockedEnd:
    """A start or goal that is not free: how far each joint is beyond its limits, and what it hits."""

    end: str
    joints: Pair
    beyond_limits: Pair
    hits: tuple[Hit, ...]
    nearest_free: NearbyFree | None


@dataclass(frozen=True)
class OutOfReach:
    """A place for the tip that no configuration within the limits reaches, and the nearest that one does; metres."""

    tip: Pair
    nearest: Pair
    joints: Pair
    misses: float


@dataclass(frozen=True)
class Shorter:
    """By how much a path would be shorter: proven lower and upper bound."""

    at_least: float
    at_most: float


@dataclass(frozen=True)
class Saving:
    """What makes the shortest path longer, and how long that would be without it."""

    kind: str
    name: str | None
    number: int | None
    joint: str | None
    side: str | None
    length: float
    shorter_by: Shorter


@dataclass(frozen=True)
class Tightest:
    """Where a path comes nearest to an obstacle; metres."""

    joints: Pair
    clearance: float
    between: str


@dataclass(frozen=True)
class Explanation(_Findings):
    """Why there is no motion and what opens a way; of one that there is, what shapes it.

    `status` is "found", "infeasible" or "unknown", then with a `reason`. Infeasible: `blocking` names the obstacles of the first of the `sets`.
    Found: `path`, its `length` and the `lower_bound` of any, and `shaped_by`. Of steps that can all be done there is the status alone.
    `stopped_after` is there if the time was up (seconds): then sets may not be irreducible, and changes and savings may be missing.
    """

    status: str
    joints: tuple[str, ...]
    start: Pair | None
    reason: str | None
    blocking: tuple[str, ...]
    sets: tuple[BlockingSet, ...]
    bottleneck: Bottleneck | None
    blocked_ends: tuple[BlockedEnd, ...]
    out_of_reach: OutOfReach | None
    path: tuple[Pair, ...]
    length: float | None
    lower_bound: float | None
    shaped_by: tuple[Saving, ...]
    tightest: Tightest | None
    stopped_after: float | None
    _: KW_ONLY
    _text: str = field(repr=False)
    _asked: tuple[Arm, World, tuple[str, ...], float] = field(repr=False)

    def summary(self) -> str:
        """As the program prints it: the verdict first."""
        return self._text

    def svg(self) -> str:
        """Workspace and configuration space side by side, with what is in the way and where the motion gets stuck."""
        return self._drawn(page=False)

    def html(self) -> str:
        """The same as a page."""
        return self._drawn(page=True)

    def _drawn(self, page: bool) -> str:
        # Explained anew: a page is larger than all else, and few are looked at.
        arm, world, asked, time = self._asked
        return _explain_drawn(arm, world, _options(asked), page, time)

    def _repr_html_(self) -> str:
        return f'<pre>{html.escape(self._text)}</pre>{self.svg()}'


def explain(
    arm: Arm,
    world: World,
    *,
    start: Sequence[float] | str | None = None,
    goal: Sequence[float] | str | None = None,
    goal_tip: Sequence[float] | None = None,
    clearance: float | None = None,
    time: float = 5.0,
) -> Explanation:
    """Why there is no motion and what opens a way; of one that there is, what shapes it. A world with steps: of the step that fails.

    `start`, `goal`, `goal_tip` and `clearance` stand in place of the world's. A start or goal that is not free is explained, too. Once it is known
    whether there is a motion, the explanation takes no more than `time` seconds; `stopped_after` says whether it would have taken longer.

    >>> arm = Arm.rr([1.0, 0.8], width=0.06, limits=[(-1.5, 1.5), (-2.5, 2.5)])
    >>> world = World({"circle": {"center": [0.6, 0.0], "radius": 0.1}, "name": "post"}, start=[1.0, 0.2], goal=[-1.0, -0.2])
    >>> found = explain(arm, world)
    >>> found.status, found.blocking, [change.change for change in found.sets[0].blockers[0].changes]
    ('infeasible', ('post',), ['moved'])
    """
    asked = tuple(words(start=start, goal=goal, goal_tip=goal_tip, clearance=clearance))
    text, summary = _explain(arm, world, _options(asked), time)
    return _made(Explanation, json.loads(text), _json=text, _text=summary, _asked=(arm, world, asked, time))
