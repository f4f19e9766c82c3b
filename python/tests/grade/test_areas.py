"""Exact areas of polygons, against shapely on random stars."""

from fractions import Fraction

import numpy as np
import pytest
from cplan.grading import _areas as areas

shapely = pytest.importorskip("shapely")


def star(random: np.random.Generator) -> np.ndarray:
    """Returns a simple polygon around a random place, not convex."""
    angles = (np.arange(9) + random.uniform(0, 0.9, 9)) * 2 * np.pi / 9
    radii = random.uniform(0.1, 1.0, 9)
    corners: np.ndarray = random.uniform(-0.5, 0.5, 2) + radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return corners


@pytest.mark.parametrize("seed", range(20))
def test_differences_of_unions_agree_with_shapely(seed: int) -> None:
    random = np.random.default_rng(seed)
    a, b = ([star(random) for _ in range(2)] for _ in range(2))
    window = areas.ring([(-0.6, -0.6), (0.6, -0.6), (0.6, 0.6), (-0.6, 0.6)])
    parts = areas.difference(*([[areas.ring(polygon)] for polygon in union] for union in (a, b)), window)
    first, second = (shapely.unary_union([shapely.Polygon(polygon).buffer(0) for polygon in union]) for union in (a, b))
    wanted = (first - second, second - first)
    for part, region in zip(parts, wanted):
        region = region & shapely.box(-0.6, -0.6, 0.6, 0.6)
        assert float(part.area) == pytest.approx(region.area, abs=1e-12)
        assert part.place is not None and region.contains(shapely.Point(part.place))


@pytest.mark.parametrize("seed", range(20))
def test_simple_polygons_agree_with_shapely(seed: int) -> None:
    random = np.random.default_rng(seed)
    mixed = random.uniform(-1, 1, size=(5, 2))
    assert areas.is_simple(areas.ring(star(random)))
    assert areas.is_simple(areas.ring(mixed)) == shapely.Polygon(mixed).is_valid


def test_areas_are_exact() -> None:
    third = Fraction(1, 3)
    tiny = [[(Fraction(0), Fraction(0)), (third, Fraction(0)), (third, third)]]
    window = areas.ring([(-1, -1), (2, -1), (2, 2), (-1, 2)])
    assert [part.area for part in areas.difference([tiny], [], window)] == [Fraction(1, 18), 0]
    # Rings within a ring are holes.
    frame = [areas.ring([(0, 0), (1, 0), (1, 1), (0, 1)]), areas.ring([(0.25, 0.25), (0.75, 0.25), (0.75, 0.75), (0.25, 0.75)])]
    assert areas.difference([frame], [], window)[0].area == Fraction(3, 4)
    assert not areas.is_simple(areas.ring([(0, 0), (1, 0), (0.5, 0), (0.5, 1)])), "a side turns back onto the one before"
