"""The configuration space of a plan as arrays: C-obstacles, and what its planner built to find the way.

Members are those of `cspace.json`, what a planner does not make is None or empty. Joint values are base to tip, radians or metres; arrays
are read-only.
"""

import json
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Axis:
    """What one joint can take: `lower` to `upper` in `unit`; a circle has a period."""

    joint: str
    unit: str
    topology: str
    lower: float
    upper: float
    period: float | None


@dataclass(frozen=True)
class Proves:
    """What free and blocked prove: `exact`; `outer`, obstacles are grown by `margin` metres at the most, so free is free; `inner`, they are
    shrunk, so blocked is blocked; `sampled`, neither."""

    kind: str
    margin: float | None


@dataclass(frozen=True, eq=False)
class Polygon:
    """Its outer ring, counter-clockwise, and its holes: corners of shape (n, 2), the first again at the end."""

    outer: Array
    holes: tuple[Array, ...]


@dataclass(frozen=True, eq=False)
class Region:
    """What an obstacle blocks, cut where circles are."""

    obstacle: str
    polygons: tuple[Polygon, ...]


@dataclass(frozen=True, eq=False)
class Free:
    """Free space as a planner on polygons sees it, in a window (least and greatest values, shape (2, 2)): on circles some turns."""

    proves: Proves
    window: Array
    polygons: tuple[Polygon, ...]


@dataclass(frozen=True, eq=False)
class Way:
    """A path: waypoints, shape (n, 2), and the same with rounded corners in short segments, shape (m, 2)."""

    name: str
    waypoints: Array
    outline: Array


@dataclass(frozen=True, eq=False)
class Roadmap:
    """Straight motions: vertices, shape (n, 2), and numbers of the two of each edge, shape (m, 2).

    `vertices[edges]` are their ends, shape (m, 2, 2), as matplotlib's `LineCollection` takes them. `whole` tells whether it is all of the
    graph, or what of it was looked at. `visibility` is `"reduced"` or `"full"` for visibility graphs.
    """

    vertices: Array
    edges: NDArray[np.int64]
    whole: bool
    visibility: str | None = None


@dataclass(frozen=True, eq=False)
class Cells:
    """Trapezoids or triangles of free space, corners of shape (n, 2), and the numbers of those that the path passes.

    Of trapezoids: `centers` of area of the channel's cells, and `middles` of the doors between them, one less, shape (n, 2).
    """

    corners: tuple[Array, ...]
    channel: NDArray[np.int64]
    centers: Array
    middles: Array


@dataclass(frozen=True, eq=False)
class Boxes:
    """Boxes of a subdivision, least and greatest values, shape (n, 2, 2): proven free, proven to collide, neither."""

    free: Array
    stuck: Array
    mixed: Array


@dataclass(frozen=True, eq=False)
class Grid:
    """Cells of a field: those of `[i, j]` begin at `lower + (i, j) * size`.

    `blocked` and `values` have shape (n, m). `quantity` tells what values are: `steps` to the goal, `ln_potential` (0 at the goal, the lower
    the farther), `height`; NaN where there is none, None without a field.
    """

    lower: Array
    size: Array
    proves: Proves
    blocked: NDArray[np.bool_]
    quantity: str
    values: Array | None

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """For matplotlib: `imshow(grid.values.T, origin="lower", extent=grid.extent)`."""
        (left, bottom), (right, top) = self.lower, self.lower + self.size * self.blocked.shape
        return float(left), float(right), float(bottom), float(top)


@dataclass(frozen=True, eq=False)
class CSpace:
    """A configuration space, and what takes place in it.

    `goals` are segments, both ends of each, shape (n, 2, 2); `expanded` where a search came, in that order, shape (n, 2); `rows` free stretches
    at fixed values of joint 1 that the path passes, and `proof` boxes of collisions that separate start and goals, both of shape (n, 2, 2).
    `payload` is what is carried, of a task.
    """

    axes: tuple[Axis, Axis]
    payload: str
    proves: Proves
    c_obstacles: tuple[Region, ...]
    start: Array
    goals: Array
    paths: tuple[Way, ...]
    free: Free | None
    roadmap: Roadmap | None
    cells: Cells | None
    expanded: Array
    rows: Array
    boxes: Boxes | None
    grid: Grid | None
    proof: Array


def read(text: str) -> list[CSpace]:
    """The spaces of `cspace.json`."""
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
        grid=made("grid", _grid),
        proof=_array(data.get("proof", []), 2, 2),
    )


def _grid(data: dict[str, Any]) -> Grid:
    shape = data["shape"]
    return Grid(
        lower=_array(data["lower"]),
        size=_array(data["size"]),
        proves=_proves(data["proves"]),
        blocked=_fixed(np.array(data["blocked"], bool).reshape(shape)),
        quantity=data["quantity"],
        values=_array(data["values"], shape[1]) if data["values"] else None,
    )


def _proves(data: dict[str, Any]) -> Proves:
    return Proves(data["kind"], data.get("margin"))


def _polygons(data: list[Any]) -> tuple[Polygon, ...]:
    rings = [[_array(ring, 2) for ring in polygon] for polygon in data]
    return tuple(Polygon(outer, tuple(holes)) for outer, *holes in rings)


def _array(data: list[Any], *inner: int) -> Array:
    """Of pairs shape (n, 2), and so on. Null is NaN."""
    return _fixed(np.array(data, float).reshape(-1, *inner))


def _numbers(data: list[Any], *inner: int) -> NDArray[np.int64]:
    return _fixed(np.array(data, np.int64).reshape(-1, *inner))


def _fixed(array: NDArray[Any]) -> NDArray[Any]:
    array.flags.writeable = False
    return array
