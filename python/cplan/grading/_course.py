"""The exercises of the course, by chapter and number."""

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np

from cplan._cplan import Arm, World
from cplan.grading._boxes import Channel, Proof
from cplan.grading._claims import Blockers, Solutions
from cplan.grading._exercise import Exercise
from cplan.grading._grids import Harmonic, Wavefront
from cplan.grading._motions import Path, Roadmap
from cplan.grading._regions import Region, Slice

SHELF = {"name": "shelf", "polygon": [[1.15, 0.18], [1.6, 0.18], [1.6, 0.3], [1.15, 0.3]]}
CRATE = {"name": "crate", "polygon": [[0.5, -1.6], [0.8, -1.6], [0.8, -1.3], [0.5, -1.3]]}
U = {
    "name": "U",
    "polygon": [[0.62, 0.33], [1.42, 0.33], [1.42, 1.17], [0.62, 1.17], [0.62, 1.07], [1.32, 1.07], [1.32, 0.43], [0.62, 0.43]],
}
BLOCK = {"name": "block", "polygon": [[0.5, 0.4], [0.8, 0.4], [0.8, 0.7], [0.5, 0.7]]}
WEDGE = {"name": "wedge", "polygon": [[1.2, 0.0], [1.6, 0.0], [1.6, 0.8]]}
PILLAR = {"name": "pillar", "polygon": [[0.0, 0.5], [0.3, 0.5], [0.3, 0.6], [0.0, 0.6]]}
FRONT = {"name": "front wall", "polygon": [[0.4, -0.04], [2.0, -0.04], [2.0, 0.04], [0.4, 0.04]]}
BACK = {"name": "back wall", "polyline": [[-0.4, 0.0], [-2.0, 0.0]]}
POST = {"name": "post", "circle": {"center": [0.6, 0.5], "radius": 0.1}}
OUT_OF_THE_U = {"start": [1.0, 0.75], "goal": [1.85, 0.75]}
ACROSS_THE_TABLE = {"start": [0.1, 0.1], "goal": [1.9, 1.4]}
BELOW_THE_SHELF = {"start": [-0.9, 0.4], "goal": [1.55, -0.35]}
ACROSS_THE_WALLS = {"start": [-0.8, 0.3], "goal": [0.9, -0.3]}

GANTRY = """<robot name="gantry">
  <link name="base"/>
  <joint name="x" type="prismatic">
    <parent link="base"/><child link="bridge"/><axis xyz="1 0 0"/><limit lower="0" upper="2" effort="1" velocity="1"/>
  </joint>
  <link name="bridge"/>
  <joint name="y" type="prismatic">
    <parent link="bridge"/><child link="head"/><axis xyz="0 1 0"/><limit lower="0" upper="1.5" effort="1" velocity="1"/>
  </joint>
  <link name="head"><collision><geometry><box size="0.2 0.1 0.1"/></geometry></collision></link>
</robot>
"""


def _arm(forearm: float = 0.8) -> Arm:
    """Creates the arm of the course, with limits."""
    return Arm.rr([1.0, forearm], width=0.06, limits=[(-2.9, 2.9), (-2.9, 2.9)], velocity=[2.0, 3.0])


def _gantry() -> Arm:
    """Creates a gantry: a rectangle of 0.2 m x 0.1 m that slides along x and y."""
    return Arm.from_text(GANTRY, "gantry.urdf")


def _slice() -> Slice:
    return Slice(_arm(), World(SHELF, CRATE, **BELOW_THE_SHELF), q1=float(np.radians(27.7)))


def _region() -> Region:
    return Region(_gantry(), World(BLOCK, WEDGE, **ACROSS_THE_TABLE))


def _roadmap() -> Roadmap:
    # The passage between pillar and block has no width: there the head touches both.
    places = [[0.1, 0.1], [0.4, 0.2], [0.4, 0.9], [0.6, 1.2], [1.0, 0.2], [1.0, 0.7], [1.1, 1.2], [1.5, 1.1], [1.9, 1.4], [1.9, 0.3]]
    return Roadmap(_gantry(), World(BLOCK, WEDGE, PILLAR, **ACROSS_THE_TABLE), samples=np.array(places), radius=0.9)


def _short_path() -> Path:
    return Path(_arm(), World(SHELF, CRATE, **BELOW_THE_SHELF), within=0.01)


def _channel() -> Channel:
    return Channel(_arm(), World(SHELF, CRATE, **BELOW_THE_SHELF))


def _wavefront() -> Wavefront:
    return Wavefront(_gantry(), World(U, **OUT_OF_THE_U), cells=(20, 15))


def _harmonic() -> Harmonic:
    return Harmonic(_gantry(), World(U, **OUT_OF_THE_U), cells=(20, 15))


def _turning() -> Arm:
    """Creates the arm of the course, whose joints turn without limits."""
    return Arm.rr([1.0, 0.8], width=0.06)


def _proof() -> Proof:
    return Proof(_turning(), World(FRONT, BACK, **ACROSS_THE_WALLS))


def _blockers() -> Blockers:
    return Blockers(_turning(), (FRONT, BACK, POST, SHELF), ACROSS_THE_WALLS)


def _solutions() -> Solutions:
    arm = Arm.rr([1.0, 0.8], width=0.06, limits=[(-4.5, 4.5), (-4.5, 4.5)])
    return Solutions(arm, World(POST, start=[-1.5, 0.0], goal={"tip": [0.35, 1.2]}))


def _payload() -> Path:
    return Path(_arm(forearm=1.1), World(SHELF, CRATE, **BELOW_THE_SHELF))


_EXERCISES: dict[str, Callable[[], Exercise[Any]]] = {
    "c_obstacles 1": _slice,
    "c_obstacles 2": _region,
    "roadmaps 1": _roadmap,
    "roadmaps 2": _short_path,
    "cells 1": _channel,
    "waves 1": _wavefront,
    "fields 1": _harmonic,
    "proofs 1": _proof,
    "proofs 2": _blockers,
    "tasks 1": _solutions,
    "tasks 2": _payload,
}

NAMES = tuple(_EXERCISES)
"""Names of the exercises of the course."""


# An exercise caches its exact regions and bounds.
_created = lru_cache(maxsize=None)(lambda name: _EXERCISES[name]())


def exercise(name: str) -> Exercise[Any]:
    """Returns an exercise of the course by its name, such as "roadmaps 1"."""
    if name not in _EXERCISES:
        raise ValueError(f'there is no exercise "{name}"; there are {", ".join(NAMES)}')
    return _created(name)
