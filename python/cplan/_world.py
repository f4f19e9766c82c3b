"""Converts Python objects to keys of a world file: mappings, arrays, and objects with a `__geo_interface__`."""

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

# Keys that may be written as a pair of joint values.
_PLACES = ("start", "goal")


def document(obstacles: Sequence[Any], keys: Mapping[str, Any] | None) -> str:
    """Returns the world as JSON: obstacles in their order, then the other keys."""
    world = dict(keys or {})
    for place in _PLACES:
        if place in world and not isinstance(world[place], Mapping):
            world[place] = {"joints": world[place]}
    listed = [entry for given in obstacles for entry in _obstacles(given)] + list(world.pop("obstacle", []))
    if listed:
        world["obstacle"] = listed
    return json.dumps(_plain(world), allow_nan=False)


def _obstacles(given: Any) -> Iterator[dict[str, Any]]:
    """Converts an obstacle of a world file, a geometry, or an array of corners."""
    if hasattr(given, "__geo_interface__"):
        given = given.__geo_interface__
    if isinstance(given, Mapping):
        yield from _geometry(given) if "type" in given else [dict(given)]
    else:
        yield {"polygon": given}


def _geometry(given: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Converts a GeoJSON object. Of a feature's properties, it takes those that obstacles have."""
    match given["type"]:
        case "Feature":
            properties = given.get("properties") or {}
            taken = {key: properties[key] for key in ("name", "height") if key in properties}
            for obstacle in _geometry(given["geometry"] or {"type": "GeometryCollection", "geometries": []}):
                yield {**obstacle, **taken}
        case "FeatureCollection":
            for feature in given["features"]:
                yield from _geometry(feature)
        case "GeometryCollection":
            for geometry in given["geometries"]:
                yield from _geometry(geometry)
        case "Polygon":
            yield {"polygon": [_open(ring) for ring in given["coordinates"]]}
        case "MultiPolygon":
            for rings in given["coordinates"]:
                yield {"polygon": [_open(ring) for ring in rings]}
        case "LineString" | "LinearRing":
            yield {"polyline": [point[:2] for point in given["coordinates"]]}
        case "MultiLineString":
            for line in given["coordinates"]:
                yield {"polyline": [point[:2] for point in line]}
        case other:
            raise ValueError(f"a geometry of type {other} has no obstacle: give polygons and lines")


def _open(ring: Iterable[Sequence[float]]) -> list[tuple[float, ...]]:
    """Returns corners in the plane, without the repeated first one at the end."""
    corners = [tuple(point[:2]) for point in ring]
    return corners[:-1] if len(corners) > 1 and corners[0] == corners[-1] else corners


def _plain(value: Any) -> Any:
    """Converts a value to lists, dictionaries and Python numbers."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {key: _plain(entry) for key, entry in value.items() if entry is not None}
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    return value
