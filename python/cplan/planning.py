"""Planning: from an arm and a world to an answer."""

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any

from cplan._cplan import Arm, Found, Infeasible, Options, Problem, Unknown, World
from cplan._cplan import plan as _plan


def options(**given: Any) -> Options | None:
    """Converts options of the program's command line by their names: `cells=80`, `tip_speed=0.5`, `goal=(0.3, -1.0)`,
    `backward=True`.

    `cplan help planners` describes each. Returns None if no option is given.

    >>> options(planner="wavefront", cells=(80, 40), start=(0.5, -0.25))
    <cplan.Options: --planner=wavefront --cells=80x40 --start=0.5,-0.25>
    """
    asked = words(**given)
    return _options(tuple(asked)) if asked else None


# Parsing words takes longer than a small plan.
_options = lru_cache(maxsize=64)(Options)


def words(**given: Any) -> list[str]:
    """Converts options to words of a command line."""
    return [word for name, value in given.items() for word in _words(name, value)]


def _words(name: str, value: Any) -> list[str]:
    if value is None or value is False:
        return []
    option = "--" + name.replace("_", "-")
    if hasattr(value, "tolist"):
        value = value.tolist()
    if value is True:
        return [option]
    if isinstance(value, (list, tuple)):
        separator = "x" if name in ("cells", "grid") else ","
        value = separator.join("none" if entry is None else str(entry) for entry in value)
    return [f"{option}={value}"]


def plan(
    arm: Arm | Problem,
    world: World | None = None,
    *,
    planner: str = "shortest",
    start: Sequence[float] | str | None = None,
    goal: Sequence[float] | str | None = None,
    goal_tip: Sequence[float] | None = None,
    clearance: float | None = None,
    progress: Callable[[str], object] | None = None,
    **more: Any,
) -> Found | Infeasible | Unknown:
    """Plans a motion. Returns a certified motion, a proof that no motion exists, or neither if this stays unknown.

    The input is an arm and a world, or a `Problem` of both. `start`, `goal` (joint values), `goal_tip` (a place for the
    tip, metres) and `clearance` (metres) replace those of the world. All other options are those of the program, by
    name: see `options`. `progress` is called with lines of text during long work.

    Other Python threads run meanwhile; Ctrl-C ends the plan.

    Raises `InputError` with all defects of arm, world, start and goal, and `ValueError` for invalid options.
    """
    overrides = {"start": start, "goal": goal, "goal_tip": goal_tip, "clearance": clearance}
    named = {} if planner == "shortest" else {"planner": planner}
    asked = options(**named, **overrides, **more)
    if isinstance(arm, Problem):
        if world is not None or any(value is not None for value in overrides.values()):
            raise ValueError("a problem has its world, start, goal and clearance already")
        problem = arm
    elif world is None:
        raise TypeError("plan() needs a world beside the arm")
    else:
        problem = Problem(arm, world, asked)
    return _plan(problem, asked, progress)
