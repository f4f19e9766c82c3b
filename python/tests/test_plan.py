"""Plans through the package's public functions, against the files of the program."""

import json
import pickle
import re
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import cplan
import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
ROBOT, SHELF = ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/shelf.toml"


def shelf() -> tuple[cplan.Arm, cplan.World]:
    return cplan.Arm.from_urdf(ROBOT), cplan.World.from_toml(SHELF)


def program(*arguments: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "cplan", *map(str, arguments)], capture_output=True, text=True)


def test_a_motion_is_what_the_program_writes() -> None:
    plan = cplan.plan(*shelf())
    assert isinstance(plan, cplan.Found)
    result = json.loads(plan.to_json())
    written = program(ROBOT, SHELF, "--json")
    assert written.returncode == 0 and written.stdout == plan.to_json()
    assert np.array_equal(plan.path, result["path"])
    assert np.array_equal(plan.trajectory.position, result["trajectory"]["position"])
    assert np.array_equal(plan.trajectory.time, result["trajectory"]["time"])
    assert plan.length == result["length"] and plan.duration == result["duration"]
    assert plan.lower_bound <= plan.length <= plan.lower_bound * (1 + plan.gap) * (1 + 1e-12)
    assert plan.gap <= 1e-4
    assert len(plan.trajectory) == len(plan.trajectory.time)
    assert plan.trajectory.units == ["rad", "rad"]


def test_arrays_are_the_same_each_time_and_cannot_be_changed() -> None:
    plan = cplan.plan(*shelf())
    assert plan.path is plan.path and plan.trajectory.position is plan.trajectory.position
    with pytest.raises(ValueError, match="read-only"):
        plan.path[0] = 0.0
    with pytest.raises(AttributeError):
        plan.length = 1.0


def test_each_answer_has_its_class() -> None:
    arm, _ = shelf()
    closed = cplan.plan(arm, cplan.World.from_toml(ROOT / "workspaces/singular_closed.toml"))
    match closed:
        case cplan.Infeasible(reason):
            assert "proven" in closed.summary() and reason
        case _:
            pytest.fail(repr(closed))
    unknown = cplan.plan(*shelf(), planner="wavefront", cells=8, levels=1)
    match unknown:
        case cplan.Unknown(reason):
            assert reason == unknown.reason
        case cplan.Found(path, trajectory):
            assert np.array_equal(path[0], trajectory.position[0])


@pytest.mark.parametrize("planner", ["visibility", "trapezoid", "wavefront", "harmonic", "first"])
def test_options_are_those_of_the_program(planner: str) -> None:
    plan = cplan.plan(*shelf(), planner=planner, goal=(1.2, -0.4), tip_speed=0.5)
    written = program(ROBOT, SHELF, f"--planner={planner}", "--goal=1.2,-0.4", "--tip-speed=0.5", "--json")
    assert plan.planner == planner and plan.to_json() == written.stdout


def test_an_arm_and_a_world_in_code() -> None:
    arm = cplan.Arm.rr([1.0, 0.8], 0.06, velocity=[2.0, 3.0])
    square = np.array([[1.2, 0.3], [1.5, 0.3], [1.5, 0.6], [1.2, 0.6]])
    world = cplan.World(square, {"circle": {"center": [-1.0, 1.0], "radius": 0.2}, "name": "post"}, start=[-0.5, 0.2], goal=[1.5, 0.1])
    found = cplan.plan(arm, world)
    assert isinstance(found, cplan.Found)
    assert np.array_equal(found.path[[0, -1]], [[-0.5, 0.2], [1.5, 0.1]])
    speed = np.abs(found.trajectory.velocity).max(axis=0)
    assert (speed <= [2.0 + 1e-9, 3.0 + 1e-9]).all() and speed[0] > 1.0
    limited = cplan.Arm.rr([1.0, 0.8], 0.06, limits=[(-1.0, 1.0), (-2.0, 2.0)])
    with pytest.raises(cplan.InputError, match="exceeds its limits"):
        cplan.plan(limited, world)


def test_a_scara_by_its_data_sheet(tmp_path: Path) -> None:
    numbers = ["--links", "0.225,0.2", "--stroke", "0.15", "--limits=-42:222,145", "--speeds", "375,600"]
    limits, velocity = [tuple(ends) for ends in np.radians([(-42, 222), (-145, 145)])], list(np.radians([375, 600]))
    for arm, words in [
        (cplan.Arm.scara([0.225, 0.2], 0.15, limits=limits, velocity=velocity), numbers),
        (cplan.Arm.scara([0.225, 0.2]), numbers[:2]),
        (cplan.Arm.scara(stroke=0.15), numbers[2:4]),
    ]:
        done = program("init", tmp_path, "--force", "--kind", "scara", *words)
        assert done.returncode == 0, done.stderr
        assert arm.urdf == (tmp_path / "arm.urdf").read_text()
        world = cplan.World.from_toml(tmp_path / "world.toml")
        assert isinstance(cplan.plan(arm, world), cplan.Found)
        assert arm.joints(world) == ["axis_1", "axis_2"]
    for refused in [{"links": [225, 225]}, {"stroke": 0.0}, {"limits": [(0.1, 1.0), (-1.0, 1.0)]}]:
        with pytest.raises(ValueError, match=next(iter(refused))):
            cplan.Arm.scara(**refused)


def test_geometries_are_obstacles() -> None:
    shapely = pytest.importorskip("shapely")
    ring = shapely.Point(0.0, 1.4).buffer(0.3).difference(shapely.Point(0.0, 1.4).buffer(0.2))
    wall = shapely.LineString([(-1.6, -0.5), (-1.6, 0.5)])
    feature = {"type": "Feature", "properties": {"name": "ring", "height": [0, 1]}, "geometry": ring.__geo_interface__}
    world = cplan.World(feature, wall, start=[0.0, 0.0], goal=[-1.0, 0.0])
    assert 'name = "ring"' in world.toml and "polyline" in world.toml
    assert isinstance(cplan.plan(cplan.Arm.rr([0.5, 0.4], 0.05), world), cplan.Found)
    assert cplan.World(feature, wall, start=[0.0, 0.0], goal=[-1.0, 0.0]) == world
    with pytest.raises(ValueError, match="Point"):
        cplan.World(shapely.Point(0.0, 0.0))


def test_everything_is_pickled() -> None:
    arm, world = shelf()
    made = cplan.Arm.rr([1.0, 0.8], 0.06)
    for thing in (arm, world, made, cplan.Options(["--planner=first"])):
        assert pickle.loads(pickle.dumps(thing)) == thing
    problem = pickle.loads(pickle.dumps(cplan.Problem(arm, world)))
    assert cplan.plan(problem).to_json() == cplan.plan(arm, world).to_json()
    plan = cplan.plan(arm, world)
    again = pickle.loads(pickle.dumps(plan))
    assert type(again) is cplan.Found and again.to_json() == plan.to_json()


def test_what_is_wrong_is_named_with_its_cure() -> None:
    arm, _ = shelf()
    world = cplan.World.from_text('[start]\njoints = [0.0, 0.0]\n[[obstacle]]\npolygone = [[0, 0]]\n', "mine.toml")
    with pytest.raises(cplan.InputError) as caught:
        cplan.plan(arm, world)
    first = caught.value.diagnostics[0]
    assert (first["file"], first["line"]) == ("mine.toml", 4) and "polygone" in first["message"] and first["help"]
    assert "mine.toml: line 4" in str(caught.value)
    for option, value in [("planner", "best"), ("levels", 80), ("nonsense", 1)]:
        with pytest.raises(ValueError, match=option):
            cplan.plan(*shelf(), **{option: value})
    with pytest.raises(ValueError, match="NaN|nan|JSON"):
        cplan.World(start=[float("nan"), 0.0])
    with pytest.raises(cplan.InputError):
        cplan.Arm.from_urdf("no such file.urdf")


def test_pictures_and_files(tmp_path: Path) -> None:
    plan = cplan.plan(*shelf())
    for name in ("plan.json", "plan.csv", "plan.yaml", "plan.mcap", "plan.svg", "plan.png", "plan.html"):
        plan.save(tmp_path / name)
        assert (tmp_path / name).stat().st_size > 100
    assert (tmp_path / "plan.svg").read_text() == plan.svg()
    page = plan._repr_html_()
    assert page.startswith("<iframe") and re.search(r'srcdoc="[^"]{1000,}"', page)
    with pytest.raises(OSError):
        plan.save(tmp_path / "missing" / "plan.json")


def slow() -> tuple[cplan.Arm, cplan.World]:
    """Returns a problem that takes some seconds."""
    return cplan.Arm.from_urdf(ROBOT), cplan.World.from_toml(ROOT / "workspaces/u_trap.toml")


SLOW = {"planner": "harmonic", "cells": 2048, "levels": 2}


def test_control_c_ends_a_plan() -> None:
    begun = time.monotonic()
    # Background jobs of shells begin with SIGINT ignored.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    with pytest.raises(KeyboardInterrupt):
        threading.Timer(0.5, signal.raise_signal, [signal.SIGINT]).start()
        while time.monotonic() - begun < 60:
            cplan.plan(*slow(), **SLOW)


def test_handlers_of_signals_run_while_a_plan_is_made() -> None:
    """A handler that raises nothing is called long before the plan is finished, and the plan continues."""
    called: list[float] = []
    before = signal.signal(signal.SIGALRM, lambda *_: called.append(time.monotonic()))
    begun = time.monotonic()
    signal.setitimer(signal.ITIMER_REAL, 0.05)
    try:
        cplan.plan(*slow(), **SLOW)
        ended = time.monotonic()
    finally:
        signal.signal(signal.SIGALRM, before)
    assert ended - begun > 0.5, "a problem that takes too little time to tell"
    assert called and called[0] - begun < (ended - begun) / 2


def test_other_threads_run_meanwhile() -> None:
    ticks = []
    done = threading.Event()

    def tick() -> None:
        while not done.wait(0.001):
            ticks.append(time.monotonic())

    thread = threading.Thread(target=tick)
    thread.start()
    begun = time.monotonic()
    cplan.plan(*slow(), planner="harmonic", cells=1024, levels=1)
    took = time.monotonic() - begun
    done.set()
    thread.join()
    assert len([at for at in ticks if begun < at < begun + took]) > 3, took


def test_progress_is_heard_and_what_it_raises_too() -> None:
    heard: list[str] = []
    cplan.plan(*shelf(), planner="visibility", gap=1e-9, levels=1, progress=heard.append)
    assert any("gap" in line for line in heard)

    def refuse(line: str) -> None:
        raise RuntimeError(line)

    with pytest.raises(RuntimeError, match="bound"):
        cplan.plan(*shelf(), planner="visibility", gap=1e-9, levels=1, progress=refuse)


def test_what_progress_raises_ends_a_plan() -> None:
    heard: list[str] = []

    def refuse(line: str) -> None:
        heard.append(line)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        cplan.plan(*shelf(), planner="visibility", gap=1e-9, levels=6, progress=refuse)
    assert len(heard) == 1


def test_control_c_ends_the_program() -> None:
    gantry, rooms = ROOT / "robots/gantry.urdf", ROOT / "workspaces/explore/rooms.toml"
    command = [sys.executable, "-m", "cplan", "explore", str(gantry), str(rooms), "--grid", "900", "--quiet"]
    process = subprocess.Popen(command)
    time.sleep(1.0)
    assert process.poll() is None
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=60) == -signal.SIGINT


def test_warnings_about_the_robot_are_notes() -> None:
    plan = cplan.plan(cplan.Arm.from_urdf(ROOT / "robots/mobile_robot.urdf"), cplan.World(start=[0, 0], goal=[1, 1]))
    assert any("cannot collide" in note for note in plan.notes)


def test_the_program_comes_with_the_package() -> None:
    assert program("--version").stdout.startswith("cplan ")
    assert program("no.urdf", "no.toml").returncode == 1
    assert program("--nonsense").returncode == 2
