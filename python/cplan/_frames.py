"""Columns by name, for tables of pandas, polars and similar libraries."""

import importlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cplan._cplan import Trajectory


def of_trajectory(trajectory: Trajectory) -> dict[str, NDArray[np.float64]]:
    """Returns the time, then positions, velocities and accelerations joint by joint, each with its unit."""
    columns = {"time [s]": trajectory.time}
    for what, per, rows in [
        ("", "", trajectory.position),
        (" velocity", "/s", trajectory.velocity),
        (" acceleration", "/s2", trajectory.acceleration),
    ]:
        for joint, unit, column in zip(trajectory.joints, trajectory.units, rows.T):
            columns[f"{joint}{what} [{unit}{per}]"] = column
    return columns


def parts(trajectory: Trajectory) -> tuple[object, ...]:
    """Returns the pickled parts of a trajectory."""
    rows = [trajectory.position, trajectory.velocity, trajectory.acceleration]
    return trajectory.time, rows, trajectory.joints, trajectory.units, trajectory.interpolation


def pandas(columns: dict[str, Any]) -> Any:
    """Returns columns as a DataFrame."""
    try:
        frames = importlib.import_module("pandas")
    except ImportError as error:
        raise ImportError("to_pandas() needs pandas, which is not installed: `pip install pandas`") from error
    return frames.DataFrame(columns)
