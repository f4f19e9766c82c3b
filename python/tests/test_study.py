"""Studies: the same rows as in the program, on this machine and on a Ray cluster."""

import copy
import csv
import io
import json
import os
import pickle
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import cplan
from cplan.studies import BATCH

ROOT = Path(__file__).parents[2]

WORLD = """
[start]
joints = [-0.9, 0.4]
[goal]
joints = [1.55, -0.35]
[[obstacle]]
name = "shelf"
polygon = [[1.15, 0.18], [1.6, 0.18], [1.6, 0.3], [1.15, 0.3]]
[[obstacle]]
name = "crate"
polygon = [[-0.15, -0.15], [0.15, -0.15], [0.15, 0.15], [-0.15, 0.15]]
"""


def written(folder: Path, head: str, steps: int = 5) -> Path:
    (folder / "world.toml").write_text(WORLD)
    places = "".join(
        f'[[parameter]]\nname = "{axis}"\nunit = "m"\nsets = "world.obstacle.crate.at[{k}]"\nfrom = -1.5\nto = 1.5\nsteps = {steps}\n'
        for k, axis in enumerate("xy")
    )
    path = folder / "study.toml"
    path.write_text(f'robot = "{(ROOT / "robots/planar_2r.urdf").as_posix()}"\nworld = "world.toml"\n{head}\n{places}')
    return path


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> cplan.Study:
    return cplan.Study(written(tmp_path_factory.mktemp("study"), 'objective = "least duration"\n[search]\nlayouts = 20'))


@pytest.fixture(scope="module")
def results(study: cplan.Study) -> cplan.Results:
    return study.run(jobs=2)


def test_the_table_is_the_programs(study: cplan.Study, results: cplan.Results, tmp_path: Path) -> None:
    path = written(tmp_path, 'objective = "least duration"\n[search]\nlayouts = 20')
    program = [sys.executable, "-m", "cplan", "study", str(path), "--quiet", "--json"]
    said = subprocess.run([*program, "--output", str(tmp_path / "t.csv"), "--output", str(tmp_path / "t.parquet")], check=True, capture_output=True)
    for ending in ["csv", "parquet", "html", "json"]:
        results.save(tmp_path / f"own.{ending}")
    for ending in ["csv", "parquet"]:
        assert (tmp_path / f"own.{ending}").read_bytes() == (tmp_path / f"t.{ending}").read_bytes()
    assert json.loads(said.stdout) == results.figures
    # The search plans no layout twice, so there are as many of its 20 layouts as differ.
    assert results.figures["layouts"] == len(results) and 25 < len(results) <= 45
    assert "Best layouts" in (tmp_path / "own.html").read_text()
    with pytest.raises(ValueError, match="results are saved as"):
        results.save(tmp_path / "own.xlsx")


def test_parquet_is_read_by_arrow_as_the_csv(results: cplan.Results, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    results.save(tmp_path / "t.parquet")
    results.save(tmp_path / "t.csv")
    table = parquet.read_table(tmp_path / "t.parquet").to_pydict()
    rows = list(csv.DictReader(io.StringIO((tmp_path / "t.csv").read_text())))
    assert list(table) == list(rows[0])
    assert len(rows) == len(results)
    for k, row in enumerate(rows):
        for name, text in row.items():
            value = table[name][k]
            match value:
                case None:
                    assert text == ""
                case bool():
                    assert text == str(value).lower()
                case str():
                    assert text == value
                case _:
                    assert float(text) == value


def test_columns_and_the_best_layout(study: cplan.Study, results: cplan.Results) -> None:
    columns = results.to_columns()
    assert list(columns)[:3] == ["layout", "x", "y"]
    assert [study.values(k)["x"] for k in range(25)] == list(columns["x"][:25])
    found = np.array([outcome == "found" for outcome in columns["outcome"]])
    durations = results.column("duration")
    assert np.array_equal(np.isnan(durations), ~found)
    best = results.best
    assert best is not None and best["measured"]["duration"] == np.nanmin(durations)
    plan = results.plan(best["layout"])
    assert isinstance(plan, cplan.Found) and plan.duration == best["measured"]["duration"]
    frame = pytest.importorskip("pandas") and results.to_pandas()
    assert frame.shape == (len(results), len(columns))
    assert "best (least duration)" in results.summary()
    assert results._repr_html_().startswith("<iframe")


def test_a_row_is_planned_with_the_options_of_its_study(tmp_path: Path) -> None:
    head = 'options = ["--clearance=0.03", "--planner", "first"]\nmeasure = ["length", "clearance"]'
    results = cplan.Study(written(tmp_path, head)).run()
    for row in np.flatnonzero(results.to_columns()["fits"]):
        plan = results.plan(int(row))
        assert isinstance(plan, cplan.Found) and plan.length == results.column("length")[row]
        assert plan.clearance == results.column("clearance")[row] >= 0.03
        other = results.plan(int(row), planner="shortest", clearance=0.01)
        assert isinstance(other, cplan.Found) and other.length < plan.length


def test_a_file_that_cannot_be_written_is_named(results: cplan.Results, tmp_path: Path) -> None:
    path = tmp_path / "nowhere" / "t.csv"
    with pytest.raises(FileNotFoundError) as raised:
        results.save(path)
    assert raised.value.filename == str(path)


def test_a_study_and_its_rows_are_pickled(study: cplan.Study, results: cplan.Results) -> None:
    again = pickle.loads(pickle.dumps(study))
    assert isinstance(again, cplan.Study) and len(again) == 25
    rows = pickle.loads(pickle.dumps(results.rows))
    assert rows == results.rows and again.rows(3, 7) == results.rows.split(7)[0].split(3)[1]
    assert copy.deepcopy(results) == results


def test_a_run_that_is_stopped_goes_on(study: cplan.Study, results: cplan.Results, tmp_path: Path) -> None:
    class Enough(Exception):
        pass

    def stop(done: int, total: int) -> None:
        raise Enough

    big = cplan.Study(written(tmp_path, 'measure = ["length"]', steps=30))
    journal = tmp_path / "rows.part"
    with pytest.raises(Enough):
        big.run(jobs=1, journal=journal, progress=stop)
    kept = len(journal.read_text().splitlines()) - 1
    assert 0 < kept < len(big)
    heard: list[tuple[int, int]] = []
    assert big.run(jobs=2, journal=journal, progress=lambda *both: heard.append(both)) == big.run(jobs=1)
    assert heard[0][0] > kept and heard[-1] == (900, 900)
    assert not journal.exists()
    journal.write_text("notes")
    with pytest.raises(OSError, match="another study"):
        study.run(journal=journal)
    with pytest.raises(OSError, match="another study"):
        study.run(journal=journal, fresh=True)
    assert journal.read_text() == "notes"


def test_a_study_of_texts_is_that_of_the_files(study: cplan.Study, results: cplan.Results) -> None:
    arm = cplan.Arm.from_urdf(ROOT / "robots/planar_2r.urdf")
    world = cplan.World.from_text(WORLD)
    text = 'objective = "least duration"\n[search]\nlayouts = 20\n'
    for k, axis in enumerate("xy"):
        text += f'[[parameter]]\nname = "{axis}"\nsets = "world.obstacle.crate.at[{k}]"\nfrom = -1.5\nto = 1.5\nsteps = 5\n'
    of_text = cplan.Study.from_text(text, arm, world)
    assert isinstance(of_text, cplan.Study) and of_text.run().rows == results.rows
    with pytest.raises(ValueError, match="made in code"):
        cplan.Study.from_text(text, cplan.Arm.rr([1.0, 0.8], width=0.06), world)


def test_bad_studies_say_where(tmp_path: Path) -> None:
    with pytest.raises(cplan.InputError, match="line 3, column 1"):
        cplan.Study(written(tmp_path, "size = 3"))
    with pytest.raises(cplan.InputError, match="none.toml"):
        cplan.Study(tmp_path / "none.toml")


@pytest.fixture(scope="module")
def cluster():
    """Provides two workers on this machine."""
    ray = pytest.importorskip("ray")
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, logging_level="ERROR")
    yield ray
    ray.shutdown()


def workers() -> list[int]:
    """Returns the processes that do tasks of a study."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            name = (folder / "cmdline").read_bytes()
        except OSError:
            continue
        if name.startswith(b"ray::_batch"):
            found.append(int(folder.name))
    return found


@pytest.mark.skipif(not Path("/proc").exists(), reason="finds workers by /proc")
def test_a_worker_that_is_killed_loses_nothing(cluster, tmp_path: Path) -> None:
    study = cplan.Study(written(tmp_path, 'measure = ["length", "duration"]\noptions = ["--planner=first"]', steps=80))
    assert len(study) == 6400 > 4 * BATCH
    killed: list[int] = []

    def kill(done: int, total: int) -> None:
        if not killed:
            for _ in range(2000):
                at_work = workers()
                if at_work:
                    os.kill(at_work[0], signal.SIGKILL)
                    killed.append(at_work[0])
                    return
                time.sleep(0.001)

    journal = tmp_path / "rows.part"
    by_ray = study.run(engine="ray", batch=BATCH, journal=journal, progress=kill)
    assert killed, "no worker was at work"
    assert by_ray == study.run()
    assert not journal.exists()


def test_a_run_on_ray_goes_on_where_one_on_this_machine_was_stopped(cluster, tmp_path: Path) -> None:
    study = cplan.Study(written(tmp_path, 'measure = ["length"]\n[search]\nlayouts = 10', steps=40))
    journal = tmp_path / "rows.part"

    def stop(done: int, total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        study.run(jobs=1, journal=journal, progress=stop)
    by_ray = study.run(engine="ray", batch=300, journal=journal)
    by_ray.save(tmp_path / "ray.csv")
    study.run().save(tmp_path / "local.csv")
    assert (tmp_path / "ray.csv").read_bytes() == (tmp_path / "local.csv").read_bytes()
