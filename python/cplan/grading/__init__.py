"""Grades answers to exercises about configuration spaces. The judge decides, not samples.

>>> import cplan
>>> arm = cplan.Arm.rr([1.0, 0.8], width=0.06)
>>> world = cplan.World({"circle": {"center": [1.6, 0.0], "radius": 0.1}}, start=[1.0, 0.2], goal=[-1.0, -0.2])
>>> cplan.grade(Path(arm, world), [[1.0, 0.2], [-1.0, -0.2]]).reason
'collision'

An exercise is one of the course, by its name, or your own: `Path`, `Roadmap`, `Slice`, `Region`, `Channel`, `Proof`,
`Wavefront`, `Harmonic`, `Blockers` or `Solutions` of an arm in a world.
"""

from typing import Any

from cplan.grading._boxes import Channel, Proof
from cplan.grading._claims import Blockers, Solutions
from cplan.grading._course import NAMES, exercise
from cplan.grading._exercise import Exercise, Grade
from cplan.grading._grids import Harmonic, Wavefront
from cplan.grading._motions import Path, Roadmap
from cplan.grading._regions import Region, Slice

__all__ = [
    "Blockers",
    "Channel",
    "Exercise",
    "Grade",
    "Harmonic",
    "NAMES",
    "Path",
    "Proof",
    "Region",
    "Roadmap",
    "Slice",
    "Solutions",
    "Wavefront",
    "exercise",
    "grade",
]


def grade(exercise_or_name: str | Exercise[Any], answer: Any) -> Grade:
    """Grades an answer to an exercise: one of the course by its name, such as "roadmaps 1", or your own.

    The result is true if the answer is right. Otherwise its message and figures state where the answer fails, and a
    notebook shows a picture of that.
    """
    asked = exercise(exercise_or_name) if isinstance(exercise_or_name, str) else exercise_or_name
    return asked.grade(answer)
