"""The wheel with the planner as WebAssembly: the results of the program, and instances that end. CPLAN names the program."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import cplan
import pytest
from cplan import _wasm

ROOT = Path(__file__).parents[3]
ROBOT, SHELF = ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/shelf.toml"
PROGRAM = os.environ.get("CPLAN", str(ROOT / "target/debug/cplan"))


def shelf() -> tuple[cplan.Arm, cplan.World]:
    return cplan.Arm.from_urdf(ROBOT), cplan.World.from_toml(SHELF)


def program(*words: object) -> str:
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True)
    assert done.returncode in (0, 3, 4), done.stderr
    return done.stdout


def same(a: Any, b: Any) -> bool:
    """Compares values of JSON: numbers to nine digits, because sines differ in their last digit between platforms."""
    if isinstance(a, dict) and isinstance(b, dict):
        return list(a) == list(b) and all(same(a[key], b[key]) for key in a)
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, float) and isinstance(b, float):
        return a == pytest.approx(b, rel=1e-9, abs=1e-9)
    return bool(a == b)


@pytest.mark.parametrize(
    ("robot", "world", "options"),
    [
        ("planar_2r", "shelf", {}),
        ("planar_2r", "shelf", {"planner": "visibility"}),
        ("planar_2r", "shelf", {"planner": "trapezoid"}),
        ("planar_2r", "shelf", {"planner": "wavefront", "cells": 64}),
        ("planar_2r", "shelf", {"planner": "harmonic", "cells": 64}),
        ("planar_2r", "shelf", {"planner": "subdivision"}),
        ("planar_2r", "shelf", {"planner": "prm"}),
        ("planar_2r", "workbench", {}),
        ("planar_2r", "singular_closed", {}),
        ("planar_2r", "no_path", {}),
        ("scara", "scara_cell", {}),
        ("scara", "tasks/kitting_cell", {}),
    ],
)
def test_a_plan_is_that_of_the_program(robot: str, world: str, options: dict[str, Any]) -> None:
    files = [ROOT / f"robots/{robot}.urdf", ROOT / f"workspaces/{world}.toml"]
    plan = cplan.plan(cplan.Arm.from_urdf(files[0]), cplan.World.from_toml(files[1]), **options)
    words = [f"--{name}={value}" for name, value in options.items()]
    assert same(json.loads(plan.to_json()), json.loads(program(*files, *words, "--json")))


def test_findings_are_those_of_the_program(tmp_path: Path) -> None:
    arm, world = shelf()
    assert same(json.loads(cplan.check(arm, world, at=(0.3, -0.2)).to_json()), json.loads(program("check", ROBOT, SHELF, "--at=0.3,-0.2", "--json")))
    no_path = ROOT / "workspaces/no_path.toml"
    explained = cplan.explain(arm, cplan.World.from_toml(no_path), time=600.0)
    assert same(json.loads(explained.to_json()), json.loads(program("explain", ROBOT, no_path, "--time=600", "--json")))
    cplan.plan(arm, world).save(tmp_path / "plan.json")
    found = cplan.verify(arm, world, tmp_path / "plan.json")
    assert same(json.loads(found.to_json()), json.loads(program("verify", ROBOT, SHELF, tmp_path / "plan.json", "--json")))


def ended(error: type[BaseException]) -> None:
    """Ends the instance by an exception."""

    def refuse(line: str) -> None:
        raise error(line)

    with pytest.raises(error):
        cplan.plan(*shelf(), planner="visibility", gap=1e-9, levels=1, progress=refuse)


def test_objects_outlive_an_instance(tmp_path: Path) -> None:
    problem = cplan.Problem(*shelf())
    plan = cplan.plan(problem)
    picture, before = plan.svg(), _wasm.PLANNER.generation
    ended(RuntimeError)
    assert plan.svg() == picture and _wasm.PLANNER.generation == before + 1
    ended(KeyboardInterrupt)
    assert cplan.plan(problem).to_json() == plan.to_json() and problem.kind == "RR"


def test_objects_are_released() -> None:
    plan = cplan.plan(*shelf())
    number = plan._handle.number  # type: ignore[attr-defined]
    assert _wasm.ask({"do": "plan_text", "plan": number, "content": "summary"})
    del plan
    with pytest.raises(ValueError, match="there is no object"):
        _wasm.ask({"do": "plan_text", "plan": number, "content": "summary"})


def test_functions_that_are_called_cannot_call() -> None:
    answers: list[str] = []

    def call(line: str) -> None:
        try:
            cplan.plan(*shelf())
        except RuntimeError as error:
            answers.append(str(error))

    plan = cplan.plan(*shelf(), planner="visibility", gap=1e-9, levels=1, progress=call)
    assert plan.status == "found" and answers and "cannot be called" in answers[0]


def test_a_plan_of_the_other_package_is_opened() -> None:
    plan = cplan.plan(*shelf())
    module, data = plan.__reduce__()[0].__module__, plan.__reduce__()[1][0]
    assert module == "cplan._problems" and json.loads(data)
    assert cplan._cplan.restored(data).to_json() == plan.to_json()  # type: ignore[attr-defined]


def run(*words: object, stdin: str | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "cplan", *map(str, words)], capture_output=True, text=True, input=stdin)


def test_the_program_reads_and_writes_files(tmp_path: Path) -> None:
    robot, output = tmp_path / "arm.urdf", tmp_path / "plan.json"
    robot.write_bytes(ROBOT.read_bytes())
    assert run(robot, SHELF, "--quiet", "--output", output).returncode == 0
    first = output.read_bytes()
    assert json.loads(first)["status"] == "found"
    # An existing file is replaced, an input is not.
    assert run(robot, SHELF, "--quiet", "--output", output).returncode == 0 and output.read_bytes() == first
    (tmp_path / "same.json").symlink_to(robot)
    refused = run(robot, SHELF, "--quiet", "--output", tmp_path / "same.json")
    assert refused.returncode == 1 and "is the input file" in refused.stderr and robot.read_bytes() == ROBOT.read_bytes()
    assert run("no.urdf", "no.toml").stderr.startswith("error: no.toml: cannot be read")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["arm.urdf", "plan.json", "same.json"]


def test_a_batch_is_that_of_the_program() -> None:
    lines = "".join(json.dumps({"urdf": str(ROBOT), "world": str(SHELF), "options": {"goal": [goal, -0.35]}}) + "\n" for goal in (1.5, 1.3, 9.0))
    # There are no threads.
    words = ["batch", "--fields", "status,planner", "--jobs=2"]
    own = run(*words, stdin=lines)
    theirs = subprocess.run([PROGRAM, *words], capture_output=True, text=True, input=lines)
    assert (own.returncode, own.stdout) == (theirs.returncode, theirs.stdout) and own.stdout.count("found") == 2
