"""The code of the book that draws a configuration space draws it."""

import re
import subprocess
import sys
from pathlib import Path

import cplan
import pytest

ROOT = Path(__file__).parents[2]


def test_the_six_lines_draw_the_picture(tmp_path: Path) -> None:
    image = pytest.importorskip("matplotlib.image")
    [code] = re.findall(r"```python\n(.*?)```", (ROOT / "docs/cspace.md").read_text(), re.DOTALL)
    arm = cplan.Arm.from_urdf(ROOT / "robots/planar_2r.urdf")
    world = cplan.World.from_toml(ROOT / "workspaces/shelf.toml")
    cplan.plan(arm, world, planner="trapezoid").save(tmp_path / "cspace.json")
    command = [sys.executable, "-c", f"import matplotlib\nmatplotlib.use('Agg')\n{code}"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    pixels = image.imread(tmp_path / "cspace.png")[..., :3]
    red, blue = pixels[..., 0], pixels[..., 2]
    # Both C-obstacles.
    assert (blue > red + 0.2).sum() > 1000 and (red > blue + 0.2).sum() > 1000
