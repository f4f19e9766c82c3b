"""Findings on configurations, motions and planners, and predicates of polygons, by the planner in WebAssembly."""

import os
from collections.abc import Sequence
from typing import Any

from cplan._frames import PolygonTest
from cplan._problems import Arm, Options, World, frozen
from cplan._wasm import ask


def _finite(values: Any) -> Any:
    """Returns nested lists, with None for values that JSON does not have."""
    if isinstance(values, list):
        return [_finite(value) for value in values]
    return values if abs(values) < float("inf") else None


def check(arm: Arm, world: World, at: str, clearance: float | None = None) -> str:
    """Checks whether a configuration (`0.3,-1`) is free, and returns the reasons."""
    found: bytes = ask({"do": "check", "arm": arm, "world": world, "at": at, "clearance": clearance})
    return found.decode()


def slices(arm: Arm, world: World, q1: Any) -> list[Any]:
    """Returns the blocked intervals of joint 2 at values of joint 1 (radians or metres): there a link touches something,
    or is nearer than the clearance. Each array has closed, ascending intervals, shape (n, 2). The result is exact, from
    contact angles. On a circle, an interval across the seam is split in two.
    """
    values = _finite([float(value) for value in q1])
    found = ask({"do": "slices", "arm": arm, "world": world, "q1": values})
    return [frozen(intervals, -1, 2) for intervals in found]


def verify(
    arm: Arm,
    world: World,
    file: Any = None,
    text: str | None = None,
    options: Options | None = None,
    anywhere: bool = False,
    unwrap: bool = False,
) -> str:
    """Verifies a motion: a file, or a text in the format of JSON files."""
    motion = {"text": text or ""} if file is None else {"file": os.fspath(file)}
    request = {"do": "verify", "arm": arm, "world": world, "motion": motion, "options": options or []}
    found: bytes = ask({**request, "anywhere": anywhere, "unwrap": unwrap})
    return found.decode()


def compare(arm: Arm, world: World, words: Sequence[str]) -> list[str]:
    """Compares planners, with the words of the program's `compare`. Returns JSON, text, Markdown and CSV."""
    texts: list[str] = ask({"do": "compare", "arm": arm, "world": world, "words": words})
    return texts


def compared_problems(arm: Arm, world: World, words: Sequence[str]) -> list[Any]:
    """Returns the problems that `compare` compares with these words."""
    problems = ask({"do": "compared_problems", "arm": arm, "world": world, "words": words})
    return [(file, None if query is None else tuple(query)) for file, query in problems]


def explain(arm: Arm, world: World, options: Options | None = None, time: float = 5.0) -> list[str]:
    """Explains why there is no motion and which changes would open a path, or which obstacles shape the motion: JSON and
    text.
    """
    request = {"do": "explain", "arm": arm, "world": world, "options": options or [], "time": time}
    texts: list[str] = ask(request)
    return texts


def explain_drawn(
    arm: Arm, world: World, options: Options | None = None, page: bool = False, time: float = 5.0
) -> str:
    """Draws an explanation as a picture or as a page."""
    request = {"do": "explain_drawn", "arm": arm, "world": world, "options": options or [], "page": page}
    drawn: bytes = ask({**request, "time": time})
    return drawn.decode()


def _corners(name: str, corners: Any) -> Any:
    import numpy as np

    array = np.asarray(corners, dtype=np.float64)
    if array.ndim != 2 or array.shape[1] != 2:
        raise ValueError(f"{name}: expected shape (n, 2), not {list(array.shape)}")
    # Infinity is larger than all coordinates, but JSON does not have it.
    return _finite(np.clip(array, -1e300, 1e300).tolist())


def penetration_depth(a: Any, b: Any) -> float:
    """Returns the penetration depth of two convex polygons in metres: the shortest translation after which they only
    touch. A negative value is the distance between them.

    Corners are arrays of shape (n, 2), counter-clockwise.
    """
    depth: float = ask({"do": "penetration_depth", "a": _corners("a", a), "b": _corners("b", b)})
    return depth


def polygon_test(a: Any, b: Any) -> PolygonTest:
    """Finds the corners of each convex polygon in the other, and sides that cross. Exact.

    Corners are arrays of shape (n, 2), counter-clockwise.
    """
    test = ask({"do": "polygon_test", "a": _corners("a", a), "b": _corners("b", b)})
    return PolygonTest(**{**test, "crossings": [tuple(sides) for sides in test["crossings"]]})


def minkowski_difference(a: Any, b: Any) -> Any:
    """Returns the Minkowski difference: the translations of `b` with which it meets `a`, which is its C-obstacle. The
    result has corners of shape (n, 2), counter-clockwise.

    Both are convex, counter-clockwise, of shape (n, 2).
    """
    return frozen(ask({"do": "minkowski_difference", "a": _corners("a", a), "b": _corners("b", b)}), -1, 2)
