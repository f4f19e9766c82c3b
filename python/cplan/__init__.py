"""Plans motions of planar two-joint arms in configuration space.

There are three answers: a path whose whole continuous motion is certified free of collision (`Found`), a proof that
there is none (`Infeasible`), or `Unknown` at the resolution that was tried.

>>> import cplan
>>> arm = cplan.Arm.rr([1.0, 0.8], width=0.06)
>>> world = cplan.World({"circle": {"center": [1.6, 0.0], "radius": 0.1}}, start=[1.0, 0.2], goal=[-1.0, -0.2])
>>> match cplan.plan(arm, world):
...     case cplan.Found(path, trajectory):
...         print(path.shape[1], trajectory.position[-1])
2 [-1.  -0.2]

Lengths are metres, angles radians, times seconds. A configuration is the pair of joint values, base to tip.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from cplan._cplan import (
    Arm,
    Found,
    Infeasible,
    InputError,
    Options,
    Plan,
    Problem,
    Unknown,
    World,
    __version__,
    minkowski_difference,
    penetration_depth,
    polygon_test,
    slices,
)
from cplan._frames import PolygonTest, Trajectory
from cplan.explaining import Explanation, explain
from cplan.findings import Check, Comparison, Comparisons, Verification, check, compare, verify
from cplan.planning import plan
from cplan.studies import Results, Study

if TYPE_CHECKING:
    from cplan import grading as grading
    from cplan.grading import Grade, grade
else:

    def __getattr__(name: str) -> object:
        """Imports the grader when it is first used, because it needs numpy, and planning does not."""
        if name not in ("Grade", "grade", "grading"):
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        grading = import_module("cplan.grading")
        return grading if name == "grading" else getattr(grading, name)


__all__ = [
    "Arm",
    "Check",
    "Comparison",
    "Comparisons",
    "Explanation",
    "Found",
    "Grade",
    "Infeasible",
    "InputError",
    "Options",
    "Plan",
    "PolygonTest",
    "Problem",
    "Results",
    "Study",
    "Trajectory",
    "Unknown",
    "Verification",
    "World",
    "__version__",
    "check",
    "compare",
    "explain",
    "grade",
    "minkowski_difference",
    "penetration_depth",
    "plan",
    "polygon_test",
    "slices",
    "verify",
]
