"""The configuration space of a plan as arrays: C-obstacles, and the data of its planner.

Members have the names of `cspace.json`. Data that a planner does not make is None or empty. Joint values are base to
tip, in radians or metres. Arrays are read-only.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    _Array = NDArray[np.float64]


@dataclass(frozen=True)
class Axis:
    """The values of one joint: `lower` to `upper` in `unit`; a circle has a period."""

    joint: str
    unit: str
    topology: str
    lower: float
    upper: float
    period: float | None


@dataclass(frozen=True)
class Proves:
    """The guarantee of the C-obstacles. `exact`: equal to the truth. `outer`: obstacles are grown by at most `margin`
    metres, so free configurations are free in truth. `inner`: obstacles are shrunk, so blocked configurations are blocked
    in truth. `sampled`: no guarantee.
    """

    kind: str
    margin: float | None


@dataclass(frozen=True, eq=False)
class Polygon:
    """A polygon: its outer ring, counter-clockwise, and its holes. Corners have shape (n, 2); the first one is repeated
    at the end.
    """

    outer: _Array
    holes: tuple[_Array, ...]


@dataclass(frozen=True, eq=False)
class Region:
    """The C-obstacle of an obstacle, cut at the seams of circles."""

    obstacle: str
    polygons: tuple[Polygon, ...]


@dataclass(frozen=True, eq=False)
class Free:
    """Free space of a planner on polygons, in a window (least and greatest values, shape (2, 2)); on circles it spans
    some turns.
    """

    proves: Proves
    window: _Array
    polygons: tuple[Polygon, ...]


@dataclass(frozen=True, eq=False)
class Way:
    """A path: its waypoints, shape (n, 2), and the path with rounded corners as short segments, shape (m, 2)."""

    name: str
    waypoints: _Array
    outline: _Array


@dataclass(frozen=True, eq=False)
class Roadmap:
    """A graph of straight motions: vertices, shape (n, 2), and the indices of the two ends of each edge, shape (m, 2).

    `vertices[edges]` are the ends, shape (m, 2, 2), in the form of matplotlib's `LineCollection`. `whole` is False if
    only the part of the graph that the search examined is here. `visibility` is `"reduced"` or `"full"` for visibility
    graphs.
    """

    vertices: _Array
    edges: NDArray[np.int64]
    whole: bool
    visibility: str | None = None


@dataclass(frozen=True, eq=False)
class Cells:
    """Trapezoids or triangles of free space, corners of shape (n, 2), and the indices of those that the path passes.

    Only for trapezoids: `centers` of area of the channel's cells, and `middles` of the portals between them, one fewer,
    shape (n, 2).
    """

    corners: tuple[_Array, ...]
    channel: NDArray[np.int64]
    centers: _Array
    middles: _Array


@dataclass(frozen=True, eq=False)
class Boxes:
    """Boxes of a subdivision, least and greatest values, shape (n, 2, 2): proven free, proven colliding, undecided."""

    free: _Array
    stuck: _Array
    mixed: _Array


@dataclass(frozen=True, eq=False)
class Grid:
    """Cells of a field. Cell `[i, j]` begins at `lower + (i, j) * size`. `free` is the part of a free cell that is known
    to be free: `whole` or `center`.

    `blocked` and `values` have shape (n, m). `quantity` is the meaning of the values: `steps` to the goal,
    `ln_potential` (0 at the goal, lower with distance), or `height`. Cells without a value have NaN; without a field,
    `values` is None.
    """

    lower: _Array
    size: _Array
    proves: Proves
    free: str
    blocked: NDArray[np.bool_]
    quantity: str
    values: _Array | None

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """The extent for matplotlib: `imshow(grid.values.T, origin="lower", extent=grid.extent)`."""
        (left, bottom), (right, top) = self.lower, self.lower + self.size * self.blocked.shape
        return float(left), float(right), float(bottom), float(top)


@dataclass(frozen=True, eq=False)
class CSpace:
    """A configuration space and its content.

    `goals` are segments, both ends of each, shape (n, 2, 2). `expanded` are the places that a search expanded, in
    order, shape (n, 2). `rows` are free stretches at fixed values of joint 1 that the path passes; `proof` has
    collision boxes that separate start and goals. Both have shape (n, 2, 2). `payload` is the name of the carried
    object, in a task. `failed_attempts` are the results of earlier attempts, in words.
    """

    axes: tuple[Axis, Axis]
    payload: str
    proves: Proves
    c_obstacles: tuple[Region, ...]
    start: _Array
    goals: _Array
    paths: tuple[Way, ...]
    free: Free | None
    roadmap: Roadmap | None
    cells: Cells | None
    expanded: _Array
    rows: _Array
    boxes: Boxes | None
    failed_attempts: tuple[str, ...]
    grid: Grid | None
    proof: _Array


def read(text: str) -> list[CSpace]:
    """Returns the spaces of `cspace.json`."""
    whole = json.loads(text)
    first, second = (Axis(**axis) for axis in whole["axes"])
    return [_space((first, second), space) for space in whole["spaces"]]


def _space(axes: tuple[Axis, Axis], data: dict[str, Any]) -> CSpace:
    def made(name: str, make: Any) -> Any:
        return make(data[name]) if name in data else None

    return CSpace(
        axes=axes,
        payload=data["payload"],
        proves=_proves(data["proves"]),
        c_obstacles=tuple(Region(each["obstacle"], _polygons(each["polygons"])) for each in data["c_obstacles"]),
        start=_array(data["start"]),
        goals=_array(data["goals"], 2, 2),
        paths=tuple(Way(way["name"], _array(way["waypoints"], 2), _array(way["outline"], 2)) for way in data["paths"]),
        free=made("free", lambda free: Free(_proves(free["proves"]), _array(free["window"], 2), _polygons(free["polygons"]))),
        roadmap=made("roadmap", lambda map: Roadmap(_array(map["vertices"], 2), _numbers(map["edges"], 2), map["whole"], map.get("visibility"))),
        cells=made("cells", lambda cells: Cells(tuple(_array(each, 2) for each in cells["corners"]), _numbers(cells["channel"]), *(_array(cells.get(key, []), 2) for key in ("centers", "middles")))),
        expanded=_array(data.get("expanded", []), 2),
        rows=_array(data.get("rows", []), 2, 2),
        boxes=made("boxes", lambda boxes: Boxes(*(_array(boxes[kind], 2, 2) for kind in ("free", "stuck", "mixed")))),
        failed_attempts=tuple(data.get("failed_attempts", [])),
        grid=made("grid", _grid),
        proof=_array(data.get("proof", []), 2, 2),
    )


def _grid(data: dict[str, Any]) -> Grid:
    shape = data["shape"]
    return Grid(
        lower=_array(data["lower"]),
        size=_array(data["size"]),
        proves=_proves(data["proves"]),
        free=data["free"],
        blocked=_fixed(data["blocked"], bool).reshape(shape),
        quantity=data["quantity"],
        values=_array(data["values"], shape[1]) if data["values"] else None,
    )


def _proves(data: dict[str, Any]) -> Proves:
    return Proves(data["kind"], data.get("margin"))


def _polygons(data: list[Any]) -> tuple[Polygon, ...]:
    rings = [[_array(ring, 2) for ring in polygon] for polygon in data]
    return tuple(Polygon(outer, tuple(holes)) for outer, *holes in rings)


def _array(data: list[Any], *inner: int) -> _Array:
    """Returns a read-only array, for pairs of shape (n, 2). Null becomes NaN."""
    return _fixed(data, float).reshape(-1, *inner)


def _numbers(data: list[Any], *inner: int) -> NDArray[np.int64]:
    return _fixed(data, "int64").reshape(-1, *inner)


def _fixed(data: list[Any], kind: Any) -> NDArray[Any]:
    import numpy as np

    array = np.array(data, kind)
    array.flags.writeable = False
    return array
