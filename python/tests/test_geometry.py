"""Predicates on arrays, against closed forms and Shapely."""

import cplan
import numpy as np
import pytest

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def test_depths_of_squares() -> None:
    assert cplan.penetration_depth(SQUARE, SQUARE + [0.75, 0.1]) == pytest.approx(0.25)
    assert cplan.penetration_depth(SQUARE, SQUARE + [2.0, 0.0]) == pytest.approx(-1.0)
    touching = cplan.polygon_test(SQUARE, SQUARE + [1.0, 0.5])
    assert touching.meet and touching.crossings == []
    apart = cplan.polygon_test(SQUARE, SQUARE + [np.nextafter(1.0, 2.0), 0.0])
    assert not apart.meet and apart.a_inside == []


def test_differences_against_hulls() -> None:
    shapely = pytest.importorskip("shapely")
    random = np.random.default_rng(7)
    for _ in range(50):
        a, b = (np.array(shapely.MultiPoint(random.normal(size=(8, 2))).convex_hull.exterior.coords)[:-1][::-1] for _ in "ab")
        difference = cplan.minkowski_difference(a, b)
        hull = shapely.MultiPoint((a[:, None] - b[None]).reshape(-1, 2)).convex_hull
        assert shapely.Polygon(difference).symmetric_difference(hull).area < 1e-12 * hull.area
        meet = shapely.Polygon(a).intersects(shapely.Polygon(b))
        assert cplan.polygon_test(a, b).meet == meet
        assert (cplan.penetration_depth(a, b) >= 0) == meet


def test_shapes_that_make_no_sense_are_refused() -> None:
    with pytest.raises(ValueError, match="a: .*corner"):
        cplan.penetration_depth(SQUARE[::-1].copy(), SQUARE)
    with pytest.raises(ValueError, match="a: coordinates must be at most"):
        cplan.penetration_depth(SQUARE * 1e160, SQUARE)
    with pytest.raises(ValueError, match=r"b: expected shape \(n, 2\)"):
        cplan.penetration_depth(SQUARE, np.zeros((3, 3)))
