"""Explanations: why there is no motion and which changes would open a path, or which obstacles shape the motion:
`explain`.
"""

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
    """A change of one thing that opens a path. With `opens` a path is certified, with `closed` it is proven that there
    is none; in metres or radians.

    An obstacle is "moved" in a `direction`, "eroded" on all sides, or "scaled" `to` a fraction of its size. A limit is
    "widened", the clearance "lowered". `among` is "world" if the change opens a path in the whole world. It is "set" if
    it does so only among the members of its set, while another set still blocks the world.
    """

    change: str
    opens: float
    closed: float
    among: str
    direction: Pair | None
    to: float | None


@dataclass(frozen=True)
class Blocker:
    """A member of a blocking set: an "obstacle" by `name` and `number`, from 1; a "limit" of a `joint` at a `side`; or
    the "clearance".

    `without` is "found" if a path is certified among the other members of the set, and "unknown" if this is undecided.
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
    """A box of configurations, from `lower` to `upper`, in all of which a piece of a link hits a part of an obstacle;
    counted from 0.
    """

    lower: Pair
    upper: Pair
    link: int
    piece: int
    obstacle: int
    part: int


@dataclass(frozen=True)
class BlockingSet:
    """A set of members that together exclude any motion. The boxes prove it; there are no boxes if start or goal is not
    free. It is `irreducible` if removing any one member opens a motion.
    """

    blockers: tuple[Blocker, ...]
    proof: tuple[ProofBox, ...]
    irreducible: bool


@dataclass(frozen=True)
class Hit:
    """Two shapes that are too close, and the missing distance in metres."""

    between: str
    lacking: float


@dataclass(frozen=True)
class GivesWay:
    """The distance by which everything must give way: with `opens` a path exists, with `closed` none does; metres."""

    opens: float
    closed: float


@dataclass(frozen=True)
class Bottleneck:
    """The place where the motion gets stuck: a configuration, a place in the plane, and the missing width; metres."""

    joints: Pair
    point: Pair
    too_narrow_by: float
    gives_way: GivesWay
    hits: tuple[Hit, ...]


@dataclass(frozen=True)
class NearbyFree:
    """The nearest free configuration: its distance in joint space, and the distance that the tip moves, in metres."""

    joints: Pair
    distance: float
    tip_moves: float


@dataclass(frozen=True)
class BlockedEnd:
    """A start or goal that is not free: the excess of each joint over its limits, and the obstacles that it hits. `when`
    is set if the arm hits them only while it stands still there, for example "while the tool is lowered".
    """

    end: str
    joints: Pair
    beyond_limits: Pair
    hits: tuple[Hit, ...]
    nearest_free: NearbyFree | None
    when: str | None


@dataclass(frozen=True)
class OutOfReach:
    """A place for the tip that no configuration within the limits reaches, and the nearest reachable place; metres."""

    tip: Pair
    nearest: Pair
    joints: Pair
    misses: float


@dataclass(frozen=True)
class Shorter:
    """The amount by which a path would be shorter: proven lower and upper bound."""

    at_least: float
    at_most: float


@dataclass(frozen=True)
class Saving:
    """An obstacle, limit or clearance that makes the shortest path longer, and the length without it."""

    kind: str
    name: str | None
    number: int | None
    joint: str | None
    side: str | None
    length: float
    shorter_by: Shorter


@dataclass(frozen=True)
class Tightest:
    """The place where a path comes nearest to an obstacle; metres."""

    joints: Pair
    clearance: float
    between: str


@dataclass(frozen=True)
class Explanation(_Findings):
    """The reasons why there is no motion and the changes that open a path, or the obstacles that shape the motion.

    `status` is "found", "infeasible" or "unknown", the last one with a `reason`. If infeasible, `blocking` names the
    obstacles of the first of the `sets`. If found, there are `path`, its `length`, the `lower_bound` of all paths, and
    `shaped_by`. For a task that succeeds, there is only the status. For one that fails, `reasons` are those of `plan`. `stopped_after` (seconds) is set if the time was
    up. Then sets may not be irreducible, and changes and savings may be missing.
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
    reasons: tuple[str, ...]
    _: KW_ONLY
    _text: str = field(repr=False)
    _asked: tuple[Arm, World, tuple[str, ...], float] = field(repr=False)

    def summary(self) -> str:
        """Returns the text that the program prints: the verdict first."""
        return self._text

    def svg(self) -> str:
        """Returns workspace and configuration space side by side, with the blocking obstacles and the place where the
        motion gets stuck.
        """
        return self._drawn(page=False)

    def html(self) -> str:
        """Returns the explanation as a page."""
        return self._drawn(page=True)

    def _drawn(self, page: bool) -> str:
        # Explained again: a page is larger than all other data, and users look at only a few.
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
    """Explains why there is no motion and which changes would open a path, or which obstacles shape the motion. In a
    world with steps, it explains the step that fails.

    `start`, `goal`, `goal_tip` and `clearance` replace those of the world. A start or goal that is not free is also
    explained. Once it is known whether there is a motion, the explanation takes at most `time` seconds; `stopped_after`
    is set if it would have taken longer.

    >>> arm = Arm.rr([1.0, 0.8], width=0.06, limits=[(-1.5, 1.5), (-2.5, 2.5)])
    >>> world = World({"circle": {"center": [0.6, 0.0], "radius": 0.1}, "name": "post"}, start=[1.0, 0.2], goal=[-1.0, -0.2])
    >>> found = explain(arm, world)
    >>> found.status, found.blocking, [change.change for change in found.sets[0].blockers[0].changes]
    ('infeasible', ('post',), ['moved'])
    """
    asked = tuple(words(start=start, goal=goal, goal_tip=goal_tip, clearance=clearance))
    text, summary = _explain(arm, world, _options(asked), time)
    return _made(Explanation, json.loads(text), _json=text, _text=summary, _asked=(arm, world, asked, time))
