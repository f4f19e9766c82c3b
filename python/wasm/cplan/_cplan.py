"""The names of the extension module `_cplan`, with the planner as WebAssembly.

An installed extension module takes precedence over this file, because Python imports it first.
"""

import os
from collections.abc import Sequence
from importlib.metadata import version

from cplan._calls import (
    check,
    compare,
    compared_problems,
    explain,
    explain_drawn,
    minkowski_difference,
    penetration_depth,
    polygon_test,
    slices,
    verify,
)
from cplan._grading import drawn, joint_ranges, judge_boxes, separate
from cplan._problems import (
    Arm,
    Found,
    Infeasible,
    Options,
    Plan,
    Problem,
    Unknown,
    World,
    plan,
    restored,
    seconds_in_rust,
)
from cplan._tables import Journal, Rows, Study, rows_restored
from cplan._wasi import Exit
from cplan._wasm import InputError, ask

__all__ = [
    "Arm",
    "Found",
    "Infeasible",
    "InputError",
    "Journal",
    "Options",
    "Plan",
    "Problem",
    "Rows",
    "Study",
    "Unknown",
    "World",
    "__version__",
    "check",
    "compare",
    "compared_problems",
    "drawn",
    "explain",
    "explain_drawn",
    "joint_ranges",
    "judge_boxes",
    "minkowski_difference",
    "penetration_depth",
    "plan",
    "polygon_test",
    "restored",
    "rows_restored",
    "run",
    "seconds_in_rust",
    "separate",
    "slices",
    "verify",
]

__version__ = version("cplan")

for _public in (Arm, Found, Infeasible, InputError, Options, Plan, Problem, Unknown, World):
    _public.__module__ = "cplan"


def run(arguments: Sequence[str]) -> int:
    """Runs the program `cplan` with these arguments, its name first; returns its exit code."""
    try:
        code: int = ask({"do": "run", "arguments": [os.fsdecode(argument) for argument in arguments]})
    except Exit as ended:
        return ended.code
    return code
