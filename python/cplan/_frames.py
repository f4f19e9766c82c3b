"""Motions in time, tests of polygons, and columns by name for tables of pandas, polars and similar libraries."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

# Only arrays need numpy, so a plan can be made before it is loaded.
if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, eq=False, repr=False)
class Trajectory:
    """A motion in time. Arrays are read-only: n samples, two joints, base to tip."""

    time: NDArray[np.float64]
    """Seconds from the start, shape (n,)."""
    position: NDArray[np.float64]
    """Joint values, shape (n, 2), radians or metres."""
    velocity: NDArray[np.float64]
    """Joint velocities, shape (n, 2), rad/s or m/s."""
    acceleration: NDArray[np.float64]
    """Joint accelerations at the beginning of each interval, shape (n, 2), rad/s2 or m/s2."""
    joints: list[str]
    """Names of the joints, base to tip."""
    units: list[str]
    """Units of the joints' values: rad or m."""
    interpolation: str | None
    """Description of the motion between samples."""

    def __post_init__(self) -> None:
        for rows in (self.time, self.position, self.velocity, self.acceleration):
            if len(rows) != len(self.time):
                raise ValueError("a trajectory has as many positions, velocities and accelerations as times")
            rows.flags.writeable = False

    def __len__(self) -> int:
        return len(self.time)

    def __repr__(self) -> str:
        return f"<cplan.Trajectory: {len(self)} samples of {', '.join(self.joints)}>"

    def __reduce__(self) -> tuple[Any, ...]:
        # Restored by the constructor, arrays are read-only again.
        return Trajectory, tuple(vars(self).values())

    def to_dict(self) -> dict[str, NDArray[np.float64]]:
        """Returns the columns by name with joint and unit, such as "time [s]" and "elbow velocity [rad/s]", as
        `pandas.DataFrame` and `polars.DataFrame` accept them."""
        columns = {"time [s]": self.time}
        for what, per, rows in [
            ("", "", self.position),
            (" velocity", "/s", self.velocity),
            (" acceleration", "/s2", self.acceleration),
        ]:
            for joint, unit, column in zip(self.joints, self.units, rows.T):
                columns[f"{joint}{what} [{unit}{per}]"] = column
        return columns

    def to_pandas(self) -> Any:
        """Returns the trajectory as a pandas DataFrame; needs pandas."""
        return pandas(self.to_dict())


@dataclass(frozen=True, repr=False)
class PolygonTest:
    """The result of the polygon penetration test."""

    meet: bool
    """True if the polygons have a point in common: exact, touching counts."""
    a_inside: list[int]
    """Numbers of the corners of a in b."""
    b_inside: list[int]
    """Numbers of the corners of b in a."""
    crossings: list[tuple[int, int]]
    """Sides of a and of b that cross properly."""

    def __repr__(self) -> str:
        return f"<cplan.PolygonTest: {', '.join(f'{name}={value}' for name, value in vars(self).items())}>"


def listed(rows: Any) -> Any:
    """Returns rows of numbers as nested lists."""
    import numpy as np

    return np.asarray(rows, float).tolist()


def pandas(columns: dict[str, Any]) -> Any:
    """Returns columns as a DataFrame."""
    try:
        frames = importlib.import_module("pandas")
    except ImportError as error:
        raise ImportError("to_pandas() needs pandas, which is not installed: `pip install pandas`") from error
    return frames.DataFrame(columns)
