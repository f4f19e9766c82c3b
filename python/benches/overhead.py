"""What a call of `cplan.plan` takes beyond the same plan in Rust.

    python python/benches/overhead.py

The same problem is planned in one process by turns: by `cplan.plan`, with its options by name, and by the function that it calls, in a loop
of its own. Of each the least time of many rounds counts, which other processes disturb least. A release of the package (`pip install .`)
tells what users see.
"""

import timeit

import cplan
from cplan._cplan import seconds_in_rust
from cplan.planning import options

ROUNDS, CALLS = 40, 100

arm = cplan.Arm.rr([1.0, 0.8], width=0.06)
world = cplan.World({"circle": {"center": [1.6, 0.0], "radius": 0.1}}, start=[1.0, 0.2], goal=[-1.0, -0.2])
problem = cplan.Problem(arm, world)
asked = options(planner="first")


def microseconds(work: object) -> float:
    return min(timeit.repeat(work, number=CALLS, repeat=ROUNDS)) / CALLS * 1e6  # type: ignore[call-overload]


rust = min(seconds_in_rust(problem, asked, CALLS) for _ in range(ROUNDS)) * 1e6
whole = microseconds(lambda: cplan.plan(problem, planner="first"))
made = cplan.plan(problem, planner="first")
print(f"in Rust              {rust:8.1f} us, {len(made.trajectory)} samples")
print(f"cplan.plan           {whole:8.1f} us")
print(f"overhead             {whole - rust:8.1f} us")
print(f"of it options        {microseconds(lambda: options(planner='first')):8.1f} us")
