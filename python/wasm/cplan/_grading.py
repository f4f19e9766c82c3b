"""Functions for the grader of exercises, by the planner in WebAssembly."""

from typing import Any

from cplan._problems import Arm, World
from cplan._wasm import ask


def joint_ranges(arm: Arm, world: World) -> list[Any]:
    """Returns for each joint its least and greatest value, and whether it is a circle."""
    return [tuple(joint) for joint in ask({"do": "joint_ranges", "arm": arm, "world": world})]


def judge_boxes(arm: Arm, world: World, boxes: Any, colliding: bool = False) -> list[Any]:
    """Judges closed boxes of configurations, each given by its least and its greatest values. Boxes are expected free; with
    `colliding`, they are expected in collision, and their parts beyond the limits do not matter.

    If a box is proven as expected, the verdict is "free" or "collision" without a configuration. Otherwise the verdict
    comes with a configuration: the opposite verdict, "limits" or "undecided".
    """
    request = {"do": "judge_boxes", "arm": arm, "world": world, "boxes": boxes, "colliding": colliding}
    return [tuple(verdict) for verdict in ask(request)]


def separate(arm: Arm, world: World, boxes: Any) -> bool:
    """Returns true if these boxes are in collision and separate the start from all goals of the world."""
    separated: bool = ask({"do": "separate", "arm": arm, "world": world, "boxes": boxes})
    return separated


def drawn(arm: Arm, world: World, title: Any, at: Any, paths: Any, edges: Any, boxes: Any) -> str:
    """Draws the arm at a configuration with its contacts, the configuration space, and an answer: paths, edges of a roadmap,
    and boxes, which are free, in collision or wrong.
    """
    answer = {"title": title, "at": at, "paths": paths, "edges": edges, "boxes": boxes}
    picture: bytes = ask({"do": "drawn", "arm": arm, "world": world, "answer": answer})
    return picture.decode()
