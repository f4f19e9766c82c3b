"""Measures the overhead of a call of `cplan.plan` compared with the same plan in Rust.

    python python/benches/overhead.py

It plans the same problem in one process in turns: by `cplan.plan`, with its options by name, and by the function that it
calls, in a separate loop. The least time of many rounds counts, which other processes disturb least.
"""

import timeit
from collections.abc import Callable

import cplan
from cplan._cplan import seconds_in_rust
from cplan.planning import options

ROUNDS, CALLS = 1000, 10

arm = cplan.Arm.rr([1.0, 0.8], width=0.06)
world = cplan.World({"circle": {"center": [1.6, 0.0], "radius": 0.1}}, start=[1.0, 0.2], goal=[-1.0, -0.2])
problem = cplan.Problem(arm, world)
asked = options(planner="first")


def seconds(work: Callable[[], object]) -> float:
    """Returns the average time of a call in seconds."""
    return timeit.timeit(work, number=CALLS) / CALLS


turns = [
    lambda: seconds_in_rust(problem, asked, CALLS),
    lambda: seconds(lambda: cplan.plan(problem, planner="first")),
    lambda: seconds(lambda: cplan.plan(problem, planner="first").trajectory),
    lambda: seconds(lambda: options(planner="first")),
    lambda: seconds(lambda: cplan.Options(["--planner=first"])),
]
rust, whole, arrays, named, anew = (1e6 * min(times) for times in zip(*([turn() for turn in turns] for _ in range(ROUNDS))))
print(f"in Rust          {rust:6.1f} us")
print(f"overhead         {whole - rust:6.1f} us, of it {named:.1f} us for the options by name")
print(f"arrays           {arrays - whole:6.1f} us more when they are asked for")
print(f"words read anew  {anew:6.1f} us, once for the same options")
