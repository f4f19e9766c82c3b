"""Results on configurations, motions and planners, against the output of the program."""

import copy
import json
import pickle
import signal
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import cplan
import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
ROBOT, SHELF = ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/shelf.toml"
SCARA, CELL = ROOT / "robots/scara.urdf", ROOT / "workspaces/tasks/kitting_cell.toml"


def shelf() -> tuple[cplan.Arm, cplan.World]:
    return cplan.Arm.from_urdf(ROBOT), cplan.World.from_toml(SHELF)


def printed(*arguments: object) -> str:
    words = [sys.executable, "-m", "cplan", *map(str, arguments), "--json"]
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode in (0, 3, 4), done.stderr
    return done.stdout


@pytest.mark.parametrize("at", [(-0.9, 0.4), (0.3, -0.2), (0.2, 0.0), (3.2, 0.0)])
def test_a_check_is_what_the_program_finds(at: tuple[float, float]) -> None:
    found = cplan.check(*shelf(), at=at, clearance=0.01)
    assert found.to_json() == printed("check", ROBOT, SHELF, f"--at={at[0]},{at[1]}", "--clearance=0.01")
    data = found.to_dict()
    assert (found.free, found.configuration, found.tip) == (data["free"], at, tuple(data["tip"]))
    assert [contact.depth for contact in found.contacts] == [contact["depth"] for contact in data["contacts"]]
    assert found.free == (not found.contacts and found.within_limits == (True, True)) == (found.nearest_free is None)


def test_a_configuration_may_be_in_degrees() -> None:
    assert cplan.check(*shelf(), at="20deg,-60deg").configuration == (np.radians(20), np.radians(-60))
    with pytest.raises(ValueError, match="at: .*two"):
        cplan.check(*shelf(), at=[0.0])


def test_a_verification_is_what_the_program_finds(tmp_path: Path) -> None:
    arm, world = shelf()
    plan = cplan.plan(arm, world)
    assert isinstance(plan, cplan.Found)
    for name in ("plan.json", "plan.csv", "plan.yaml", "plan.mcap"):
        plan.save(tmp_path / name)
        found = cplan.verify(arm, world, tmp_path / name)
        assert found.to_json() == printed("verify", ROBOT, SHELF, tmp_path / name), name
        assert found.free and found.clearance is not None and 0 < found.clearance
        assert found.nearest is not None and found.clearance <= -found.nearest.depth
    assert cplan.verify(arm, world, plan).to_json() == cplan.verify(arm, world, tmp_path / "plan.json").to_json()


def test_arrays_are_judged_as_files_are(tmp_path: Path) -> None:
    arm, world = shelf()
    plan = cplan.plan(arm, world, jerk=(50.0, 50.0))
    assert isinstance(plan, cplan.Found)
    motion = plan.trajectory
    assert cplan.verify(arm, world, motion).free
    assert cplan.verify(arm, world, pickle.loads(pickle.dumps(motion))).free
    joined = cplan.verify(arm, world, (motion.time, motion.position, motion.velocity))
    assert joined.free and any("cubic" in note for note in joined.notes)
    straight = np.array([plan.path[0], plan.path[-1]])
    file = tmp_path / "path.json"
    file.write_text(json.dumps({"joints": motion.joints, "path": straight.tolist()}))
    found = cplan.verify(arm, world, straight)
    assert found.to_json() == printed("verify", ROBOT, SHELF, file) and found.verdict == "collision"
    first = found.first_contact
    assert first is not None and first.time is None and first.waypoint is not None
    assert np.allclose(first.configuration, straight[0] + first.waypoint * (straight[1] - straight[0]))
    assert cplan.check(arm, world, at=first.configuration).contacts[0].obstacle == first.obstacle


def test_what_a_motion_is_held_to_can_be_told() -> None:
    arm, world = shelf()
    path = [[0.0, 2.0], [0.1, 2.0]]
    assert cplan.verify(arm, world, path).verdict == "ends"
    assert cplan.verify(arm, world, path, anywhere=True).free
    assert cplan.verify(arm, world, path, start=(0.0, 2.0), goal=(0.1, 2.0)).free
    assert cplan.verify(arm, world, path, anywhere=True, clearance=3.0).verdict == "collision"
    fast = cplan.verify(arm, world, ([0.0, 0.001], path), anywhere=True)
    assert (fast.verdict, fast.limits_broken[0].limit) == ("limits", "velocity")
    assert fast.limits_broken[0].value == pytest.approx(100.0)


def test_a_task_is_judged_step_by_step(tmp_path: Path) -> None:
    arm, world = cplan.Arm.from_urdf(SCARA), cplan.World.from_toml(CELL)
    plan = cplan.plan(arm, world)
    file = tmp_path / "kit.json"
    plan.save(file)
    found = cplan.verify(arm, world, plan)
    assert found.free and found.to_json() == printed("verify", SCARA, CELL, file)
    assert found.steps is not None and [step.step for step in found.steps] == [step["step"] for step in found.to_dict()["steps"]]
    with pytest.raises(ValueError, match="tasks, which must begin at the start"):
        cplan.verify(arm, world, plan, anywhere=True)


def test_what_is_no_motion_is_refused(tmp_path: Path) -> None:
    arm, world = shelf()
    closed = cplan.plan(arm, cplan.World.from_toml(ROOT / "workspaces/singular_closed.toml"))
    for motion in (closed, [[0.0, np.nan]], [[0.0, 0.0, 0.0]], ([0.0, 0.0], [[0.0, 0.0], [0.1, 0.0]]), tmp_path / "no.csv"):
        with pytest.raises(cplan.InputError):
            cplan.verify(arm, world, motion)


def untimed(text: str) -> Any:
    """Returns JSON without the members that differ from run to run."""
    return json.loads(text, object_hook=lambda found: {
        name: value for name, value in found.items() if name not in ("time", "memory", "distributions", "summary", "total")
    })


def test_a_comparison_is_what_the_program_prints() -> None:
    asked = {"planners": ["visibility", "wavefront"], "variants": ["trapezoid --path own"], "cells": 64}
    found = cplan.compare(*shelf(), **asked)
    words = ["--planner=visibility", "--planner=wavefront", "--with=trapezoid --path own", "--cells=64"]
    assert isinstance(found, cplan.Comparison)
    assert untimed(found.to_json()) == untimed(printed("compare", ROBOT, SHELF, *words))
    assert [run.planner for run in found.planners] == ["visibility", "wavefront", "trapezoid --path own"]
    best = min(run.length for run in found.planners)
    assert all(run.outcome == "found" and run.ratio == pytest.approx(run.length / best) for run in found.planners)
    assert str(found).startswith("planner") and found._repr_markdown_().startswith("| planner")


def test_random_problems_are_compared() -> None:
    found = cplan.compare(*shelf(), planners=["first", "shortest"], queries=5, seed=3)
    written = printed("compare", ROBOT, SHELF, "--planner=first", "--planner=shortest", "--queries=5", "--seed=3")
    assert isinstance(found, cplan.Comparisons) and untimed(found.to_json()) == untimed(written)
    assert (found.queries, found.seed, len(found.problems)) == (5, 3, 5)
    assert [tally.found + tally.infeasible + tally.unknown for tally in found.planners] == [5, 5]
    assert len(found.to_columns()["planner"]) == 10


def test_control_c_ends_a_comparison() -> None:
    # Background jobs of shells begin with SIGINT ignored.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    with pytest.raises(KeyboardInterrupt):
        threading.Timer(0.5, signal.raise_signal, [signal.SIGINT]).start()
        # All queries take longer than a run of all tests.
        cplan.compare(*shelf(), planners=["harmonic"], cells=1024, queries=1000)


@pytest.mark.parametrize("wrong", [{"planners": ["best"]}, {"queries": 0}, {"suite": "workspaces"}, {"output": "a.csv"}, {"nonsense": 1}])
def test_words_that_make_no_sense_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(ValueError):
        cplan.compare(*shelf(), **wrong)


def test_comparisons_are_frames() -> None:
    found = cplan.compare(*shelf(), planners=["visibility", "wavefront"], cells=64)
    columns = found.to_columns()
    assert columns["length"] == [run.length for run in found.planners]
    assert columns["total_s"] == [run.time.total for run in found.planners]
    assert columns["cells"][0] is None and columns["cells"][1] == found.planners[1].size["cells"]
    frame = pytest.importorskip("pandas").DataFrame(columns)
    assert frame.equals(found.to_pandas()) and list(frame["outcome"]) == ["found", "found"]
    assert pytest.importorskip("polars").DataFrame(columns).height == 2


def test_trajectories_are_frames() -> None:
    motion = cplan.plan(*shelf()).trajectory
    columns = motion.to_dict()
    assert list(columns)[:4] == ["time [s]", "shoulder [rad]", "elbow [rad]", "shoulder velocity [rad/s]"]
    assert np.array_equal(columns["elbow acceleration [rad/s2]"], motion.acceleration[:, 1])
    frame = motion.to_pandas()
    assert frame.shape == (len(motion), 7) and frame["time [s]"].is_monotonic_increasing
    assert pytest.importorskip("polars").DataFrame(columns).shape == frame.shape


def test_without_pandas_one_is_told_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match="pip install pandas"):
        cplan.plan(*shelf()).trajectory.to_pandas()


@pytest.mark.parametrize(
    ("robot", "world", "words"),
    [
        (ROBOT, "no_path.toml", {}),
        (ROBOT, "limits_closed.toml", {}),
        (ROBOT, "shelf.toml", {}),
        (ROBOT, "shelf.toml", {"goal_tip": (5.0, 0.0)}),
        (ROBOT, "shelf.toml", {"goal": (0.14, 0.0), "clearance": 0.01}),
        (SCARA, "tasks/kitting_cell.toml", {}),
    ],
)
def test_an_explanation_is_what_the_program_finds(robot: Path, world: str, words: dict[str, Any]) -> None:
    file = ROOT / "workspaces" / world
    # On a busy machine, the usual limit may be too short.
    found = cplan.explain(cplan.Arm.from_urdf(robot), cplan.World.from_toml(file), time=600.0, **words)
    overrides = [f"--{name.replace('_', '-')}={str(value).strip('()').replace(' ', '')}" for name, value in words.items()]
    assert found.to_json() == printed("explain", robot, file, "--time=600", *overrides)
    data = found.to_dict()
    assert found.status == data["status"] and list(found.blocking) == data.get("blocking", [])
    assert [len(each.blockers) for each in found.sets] == [len(each["blockers"]) for each in data.get("sets", [])]
    assert (found.out_of_reach is not None) == ("goal_tip" in words) and bool(found.blocked_ends) == ("goal" in words)
    assert found.summary() and found.svg().startswith("<svg") and "<html" in found.html()
    assert pickle.loads(pickle.dumps(found)).svg() == found.svg()


# A pick beside a rim, which the lowered flange hits.
RIM = """
robot = { joints = ["axis_1", "axis_2"], tip = "flange", stroke = { joint = "axis_3" } }
start.joints = [0.0, 1.2]
[[obstacle]]
name = "rim"
polygon = [[0.1, -0.35], [0.3, -0.35], [0.3, -0.21], [0.1, -0.21]]
height = [0.0, 0.08]
[[object]]
name = "part"
circle = { center = [0.0, 0.0], radius = 0.009 }
at = [0.2, -0.195]
height = [0.0, 0.02]
lift = 0.15
[[step]]
pick = "part"
[[step]]
place = { at = [0.2, 0.2] }
"""


@pytest.mark.parametrize(
    ("robot", "world"),
    [
        (ROBOT, cplan.World.from_toml(SHELF)),
        (ROBOT, cplan.World.from_toml(ROOT / "workspaces/no_path.toml")),
        (SCARA, cplan.World.from_toml(CELL)),
        (SCARA, cplan.World.from_text(RIM)),
    ],
)
def test_what_one_function_says_no_other_denies(robot: Path, world: cplan.World) -> None:
    arm = cplan.Arm.from_urdf(robot)
    plan, found = cplan.plan(arm, world), cplan.explain(arm, world)
    assert found.status == type(plan).__name__.lower()
    if isinstance(plan, cplan.Found):
        assert cplan.verify(arm, world, plan).verdict == "free"
    elif robot == SCARA:
        assert found.blocking == ("rim",) and found.reasons
        assert {end.when for end in found.blocked_ends} == {"while the tool is lowered"}


def test_changes_are_told_between_a_path_and_a_proof() -> None:
    arm, world = cplan.Arm.from_urdf(ROBOT), cplan.World.from_toml(ROOT / "workspaces/no_path.toml")
    [closed] = cplan.explain(arm, world, time=600.0).sets
    [wall] = closed.blockers
    assert (wall.kind, wall.name, wall.number, wall.without) == ("obstacle", "front wall", 1, "found") and closed.proof
    assert [change.change for change in wall.changes] == ["moved", "eroded"]
    assert all(0 < change.closed < change.opens for change in wall.changes)
    move = wall.changes[0]
    assert move.direction is not None
    for by, outcome in [(move.opens, cplan.Found), (move.closed, cplan.Infeasible)]:
        text = world.toml.replace("[[obstacle]]", f"[[obstacle]]\nat = {[by * part for part in move.direction]}", 1)
        assert isinstance(cplan.plan(arm, cplan.World.from_text(text)), outcome), by


def test_findings_can_be_pickled_and_copied() -> None:
    arm, world = shelf()
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    path = cplan.plan(arm, world).path
    found = [
        cplan.check(arm, world, at=(0.3, -0.2)),
        cplan.verify(arm, world, path),
        cplan.compare(arm, world, planners=["first"]),
        cplan.polygon_test(square, square + 0.5),
    ]
    for thing in found:
        for other in (pickle.loads(pickle.dumps(thing)), copy.deepcopy(thing)):
            assert type(other) is type(thing) and other == thing


def test_trajectories_and_plans_can_be_pickled_and_copied() -> None:
    plan = cplan.plan(*shelf())
    motion = plan.trajectory
    for other in (pickle.loads(pickle.dumps(motion)), copy.copy(motion), copy.deepcopy(motion)):
        for name in ("time", "position", "velocity", "acceleration"):
            assert np.array_equal(getattr(other, name), getattr(motion, name)) and not getattr(other, name).flags.writeable
        assert (other.joints, other.units, other.interpolation) == (motion.joints, motion.units, motion.interpolation)
    assert copy.deepcopy(plan) is plan and copy.copy(plan) is plan
    copied = copy.deepcopy({"plan": plan, "world": shelf()[1], "options": cplan.Options(["--planner=first"])})
    assert copied["plan"] is plan and copied["world"] == shelf()[1] and copied["options"] == cplan.Options(["--planner=first"])
    problem = cplan.Problem(*shelf())
    assert copy.deepcopy(problem) is problem and copy.copy(problem) is problem


def test_files_beside_a_world_are_found_from_elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Reads a world by a relative path, here and in another folder."""
    monkeypatch.chdir(ROOT)
    arm, world = cplan.Arm.from_urdf("robots/room_gantry.urdf"), cplan.World.from_toml("workspaces/store_room.toml")
    stored = pickle.dumps((arm, world))
    here = cplan.plan(arm, world).to_json()
    monkeypatch.chdir(tmp_path)
    assert cplan.plan(*pickle.loads(stored)).to_json() == here
