"""The problems, read from the URDF and the world files: by code of our own, which shares nothing with cplan's."""

from __future__ import annotations

import math
import tomllib
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import numpy as np

PROBLEMS = Path(__file__).parent.parent / "problems"
ARM = PROBLEMS / "arm.urdf"

Corners: TypeAlias = np.ndarray
"""Corners of a convex polygon, counter-clockwise, one a line."""


@dataclass(frozen=True)
class Problem:
    """Two bars at the origin among convex polygons; start and goal where the file has them."""

    name: str
    world: Path
    links: tuple[Corners, Corners]
    elbow: float
    obstacles: list[Corners]
    start: np.ndarray | None
    goal: np.ndarray | None

    @property
    def files(self) -> list[str]:
        """Arm and world, as cplan takes them."""
        return [str(ARM), str(self.world)]


def load(name: str) -> Problem:
    """Reads `problems/NAME.toml` and the arm."""
    world = PROBLEMS / f"{name.lower()}.toml"
    content = tomllib.loads(world.read_text())
    links, elbow = _arm()
    ends = [np.array(content[end]["joints"], dtype=float) if end in content else None for end in ("start", "goal")]
    obstacles = [np.array(obstacle["polygon"], dtype=float) for obstacle in content["obstacle"]]
    for corners in obstacles:
        _demand_convex(corners)
    return Problem(name, world, links, elbow, obstacles, *ends)


def _arm() -> tuple[tuple[Corners, Corners], float]:
    """Rectangles of both links, and where the second joint sits on the first link's x axis."""
    robot = ElementTree.parse(ARM).getroot()
    links = (_rectangle(robot, "upper_arm"), _rectangle(robot, "forearm"))
    elbow = robot.find("joint[@name='elbow']/origin")
    assert elbow is not None
    x, y, _ = _numbers(elbow, "xyz")
    assert y == 0.0, "the checkers know an elbow on the x axis"
    return links, x


def _rectangle(robot: ElementTree.Element, link: str) -> Corners:
    origin = robot.find(f"link[@name='{link}']/collision/origin")
    box = robot.find(f"link[@name='{link}']/collision/geometry/box")
    assert origin is not None and box is not None, f"{link} is no box"
    (x, y, _), (width, height, _) = _numbers(origin, "xyz"), _numbers(box, "size")
    signs = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    return np.array([x, y]) + signs * np.array([width, height]) / 2


def _numbers(element: ElementTree.Element, attribute: str) -> list[float]:
    return [float(word) for word in element.attrib[attribute].split()]


def _demand_convex(corners: Corners) -> None:
    sides = np.roll(corners, -1, axis=0) - corners
    turns = sides[:, 0] * np.roll(sides[:, 1], -1) - sides[:, 1] * np.roll(sides[:, 0], -1)
    assert (turns > 0).all(), "the checkers know convex polygons, counter-clockwise"


def write_scene(problem: Problem, file: Path) -> None:
    """The problem for the C++ checker, every number to the last bit."""

    def line(what: str, numbers: np.ndarray) -> str:
        return " ".join([what, *(repr(float(number)) for number in np.ravel(numbers))])

    lines = [line("elbow", np.array([problem.elbow]))]
    lines += [line("link", corners) for corners in problem.links]
    lines += [line("obstacle", corners) for corners in problem.obstacles]
    if problem.start is not None and problem.goal is not None:
        lines += [line("start", problem.start), line("goal", problem.goal)]
    file.write_text("\n".join(lines) + "\n")


def unwrapped(path: np.ndarray) -> np.ndarray:
    """A path whose waypoints count on across half a turn: each step goes the shorter way round."""
    steps = (np.diff(path, axis=0) + math.pi) % (2 * math.pi) - math.pi
    return path[0] + np.vstack([np.zeros(2), np.cumsum(steps, axis=0)])


def length(path: np.ndarray) -> float:
    """Euclidean length in joint space, radians."""
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
