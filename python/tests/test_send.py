"""The program that sends plans to ROS 2: its check, which needs no ROS."""

import importlib.util
import json
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest
import yaml

ROOT = Path(__file__).parents[2]
PROGRAM = ROOT / "examples/ros2/send.py"
JOINTS = ["shoulder", "elbow"]


@pytest.fixture(scope="module")
def send() -> ModuleType:
    spec = importlib.util.spec_from_file_location("send", PROGRAM)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def plan(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("plan")
    robot, world = ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/shelf.toml"
    files = [folder / "plan.yaml", folder / "plan.json"]
    outputs = [word for file in files for word in ("--output", str(file))]
    done = subprocess.run([sys.executable, "-m", "cplan", str(robot), str(world), "--quiet", *outputs])
    assert done.returncode == 0
    return folder


def check(file: Path, *options: str) -> tuple[int, str]:
    done = subprocess.run([sys.executable, str(PROGRAM), str(file), "--check", *options], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def test_plans_keep_the_rules_of_the_controller(send: ModuleType, plan: Path) -> None:
    motions = [send.read(str(plan / name)) for name in ("plan.yaml", "plan.json")]
    (joints, points), (others, samples) = motions
    assert joints == others == JOINTS and len(points) > 100
    assert [point[:3] for point in points] == [point[:3] for point in samples]
    start = dict(zip(joints, points[0][1]))
    assert send.faults(joints, points, JOINTS[::-1], start) == []
    for name in ("plan.yaml", "plan.json"):
        code, text = check(plan / name, "--joints", "elbow,shoulder")
        assert code == 0 and "no rule is broken" in text, text


def test_each_broken_rule_is_named(send: ModuleType, plan: Path, tmp_path: Path) -> None:
    message = yaml.safe_load((plan / "plan.yaml").read_text())

    def refused(part: str, *options: str, **changes: object) -> None:
        changed = json.loads(json.dumps(message))
        for path, value in changes.items():
            *outer, last = path.split("__")
            inner = changed
            for key in outer:
                inner = inner[int(key) if key.lstrip("-").isdigit() else key]
            inner[int(last) if last.isdigit() else last] = value
        file = tmp_path / "changed.yaml"
        file.write_text(yaml.safe_dump(changed))
        code, text = check(file, *options)
        assert code == 1 and part in text and "Traceback" not in text, text

    refused('no joint "elbow"', "--joints", "shoulder,wrist")
    refused('lacks joint "wrist"', "--joints", "shoulder,elbow,wrist")
    refused("named twice", joint_names__0="elbow")
    refused("point 5 is at 0.0 s", points__4__time_from_start={"sec": 0, "nanosec": 0})
    refused("1 positions for 2 joints", points__3__positions=[0.5])
    refused("1 velocities for 2 joints", points__3__velocities=[0.5])
    refused("not finite", points__3__positions=[float("nan"), 0.0])
    refused('"elbow" has the velocity 0.1 at the end', **{"points__-1__velocities": [0.0, 0.1]})
    refused("no points", points=[])
    refused("names no joints", joint_names=[])
    joints, points = send.read(str(plan / "plan.yaml"))
    start = dict(zip(joints, points[0][1]))
    away = send.faults(joints, points, JOINTS, {**start, "elbow": start["elbow"] + 0.1})
    assert len(away) == 1 and 'joint "elbow" is at' in away[0], away
    assert "is unknown" in send.faults(joints, points, JOINTS, {"elbow": start["elbow"]})[0]


def test_other_files_are_refused(plan: Path, tmp_path: Path) -> None:
    for name, text, part in [
        ("a.yaml", "a: [1", "not YAML"),
        ("a.yaml", "a: 1", "no JointTrajectory"),
        ("a.json", "{}", "no motion"),
        ("a.json", "{", "Expecting"),
    ]:
        (tmp_path / name).write_text(text)
        code, message = check(tmp_path / name)
        assert code == 1 and part in message and "Traceback" not in message, message
    code, message = check(tmp_path / "none.yaml")
    assert code == 1 and "No such file" in message
