"""Configuration spaces as arrays, against `check` of single configurations, which shares nothing with them."""

from pathlib import Path

import cplan
import numpy as np
import pytest
from cplan.cspace import CSpace, read

shapely = pytest.importorskip("shapely")

ROOT = Path(__file__).parents[2]
DRAWS = np.random.default_rng(7)


def shelf() -> tuple[cplan.Arm, cplan.World]:
    return cplan.Arm.from_urdf(ROOT / "robots/planar_2r.urdf"), cplan.World.from_toml(ROOT / "workspaces/shelf.toml")


def space(**options: object) -> CSpace:
    [only] = cplan.plan(*shelf(), **options).cspaces()
    return only


def test_what_collides_lies_in_the_obstacles_region() -> None:
    found = space()
    assert found.proves.kind == "outer" and [axis.joint for axis in found.axes] == ["shoulder", "elbow"]
    lower, upper = np.array([[axis.lower, axis.upper] for axis in found.axes]).T
    regions = {
        region.obstacle: shapely.union_all([shapely.Polygon(p.outer, p.holes) for p in region.polygons])
        for region in found.c_obstacles
    }
    assert list(regions) == ["shelf", "crate"]
    hits = 0
    for q in DRAWS.uniform(lower, upper, (600, 2)):
        touched = {contact.obstacle for contact in cplan.check(*shelf(), at=q).contacts}
        hits += len(touched)
        assert all(regions[name].distance(shapely.Point(q)) < 1e-9 for name in touched), q
    share = sum(region.area for region in regions.values()) / np.prod(upper - lower)
    assert hits / 600 == pytest.approx(share, abs=0.03) and hits > 20


def test_free_cells_are_free_and_lead_to_the_goal() -> None:
    found = space(planner="wavefront", cells=48)
    grid = found.grid
    assert grid is not None and grid.values is not None and grid.blocked.shape == grid.values.shape
    centres = grid.lower + (np.argwhere(~grid.blocked) + 0.5) * grid.size
    for q in DRAWS.choice(centres, 200):
        assert cplan.check(*shelf(), at=q).free, q
    assert (grid.free, found.failed_attempts) == ("whole", ())
    assert grid.quantity == "steps" and not np.isfinite(grid.values[grid.blocked]).any()
    i, j = np.argwhere(grid.values == 0)[0]
    assert np.all(np.abs(grid.lower + (np.array([i, j]) + 0.5) * grid.size - found.goals[0, 0]) <= grid.size)
    # At most one step between neighbouring free cells.
    steps = np.abs(np.diff(grid.values, axis=0))
    assert np.nanmax(steps) == 1
    assert grid.extent == pytest.approx((-2.9, 2.9, -2.9, 2.9))


def test_a_roadmap_has_the_path() -> None:
    plan = cplan.plan(*shelf(), planner="visibility", levels=1)
    [found] = plan.cspaces()
    roadmap = found.roadmap
    assert roadmap is not None and roadmap.vertices[roadmap.edges].shape == (len(roadmap.edges), 2, 2)
    vertices = {tuple(vertex) for vertex in roadmap.vertices}
    assert tuple(found.start) in vertices and all(tuple(q) in vertices for q in found.paths[0].waypoints)
    assert np.array_equal(found.paths[0].waypoints, plan.path)


def test_boxes_rows_and_cells_are_arrays() -> None:
    boxes = space(planner="subdivision").boxes
    assert boxes is not None
    for lower, upper in boxes.free[:50]:
        assert cplan.check(*shelf(), at=(lower + upper) / 2).free
    for lower, upper in boxes.stuck[:50]:
        assert cplan.check(*shelf(), at=(lower + upper) / 2).contacts
    rows = space().rows
    assert rows.shape[1:] == (2, 2) and np.all(rows[:, 0, 0] == rows[:, 1, 0])
    cells = space(planner="trapezoid").cells
    assert cells is not None and len(cells.channel) > 1 and all(3 <= len(corners) <= 4 for corners in cells.corners)


def test_they_are_what_the_file_has(tmp_path: Path) -> None:
    plan = cplan.plan(*shelf(), planner="harmonic", cells=32, levels=1)
    plan.save(tmp_path / "cspace.json")
    [written], [found] = read((tmp_path / "cspace.json").read_text()), plan.cspaces()
    assert found.grid is not None and np.array_equal(found.grid.values, written.grid.values, equal_nan=True)
    with pytest.raises(ValueError, match="read-only"):
        found.grid.values[0, 0] = 0.0


@pytest.mark.parametrize("clearance", [0.0, 0.05])
def test_a_slice_is_where_a_check_finds_contact(clearance: float) -> None:
    arm = cplan.Arm.rr([1.0, 0.8], width=0.06)
    post, wall = {"circle": {"center": [1.3, 0.2], "radius": 0.1}}, {"polyline": [[-0.5, 1.0], [0.4, 0.7]]}
    world = cplan.World(post, wall, clearance=clearance)
    values = np.array([-1.0, 0.0, 0.15, 0.7, 2.0])
    found = cplan.slices(arm, world, values)
    assert sum(len(intervals) for intervals in found) >= 5
    for q1, intervals in zip(values, found):
        assert np.all(np.diff(intervals.ravel()) >= 0) and not intervals.flags.writeable
        for q2 in DRAWS.uniform(-np.pi, np.pi, 60):
            inside = bool(np.any((intervals[:, 0] <= q2) & (q2 <= intervals[:, 1])))
            assert inside == bool(cplan.check(arm, world, at=(q1, q2)).contacts), (q1, q2)
        for q2 in intervals.ravel():
            if abs(q2) < np.pi:
                assert cplan.check(arm, world, at=(q1, q2)).clearance == pytest.approx(clearance, abs=1e-9)
    with pytest.raises(ValueError, match="joint value"):
        cplan.slices(arm, world, [np.nan])
