"""Wavefronts and harmonic fields, against plain loops and direct solutions on cells that are computed by hand."""

from collections import deque

import cplan
import numpy as np
import pytest
from judged import is_graded
from oracle import around, harmonic, wave

WAVES, FIELDS = cplan.grading.exercise("waves 1"), cplan.grading.exercise("fields 1")
GOAL = (18, 7)


def cells_by_hand() -> np.ndarray:
    """Returns the cells of 0.1 m that meet the three bars of the U, grown by 0.1 m along x and 0.05 m along y."""
    bars = [(0.52, 1.52, 0.28, 0.48), (0.52, 1.52, 1.02, 1.22), (1.22, 1.52, 0.28, 1.22)]
    low_x, low_y = np.meshgrid(np.arange(20) / 10, np.arange(15) / 10, indexing="ij")
    meets = [(low_x <= x2) & (low_x + 0.1 >= x1) & (low_y <= y2) & (low_y + 0.1 >= y1) for x1, x2, y1, y2 in bars]
    blocked: np.ndarray = np.any(meets, axis=0)
    return blocked


BLOCKED = cells_by_hand()
WAVE = wave(BLOCKED, GOAL)
FIELD = harmonic(BLOCKED, GOAL)
START = (10, 7)


def changed(values: np.ndarray, cell: tuple[int, int], value: float) -> np.ndarray:
    other = values.copy()
    other[cell] = value
    return other


def diagonal_wave() -> np.ndarray:
    steps, queue = np.full(BLOCKED.shape, np.nan), deque([GOAL])
    steps[GOAL] = 0
    while queue:
        i, j = queue.popleft()
        for near in [(i + a, j + b) for a in (-1, 0, 1) for b in (-1, 0, 1)]:
            if 0 <= near[0] < 20 and 0 <= near[1] < 15 and not BLOCKED[near] and np.isnan(steps[near]):
                steps[near] = steps[i, j] + 1
                queue.append(near)
    return steps


def round_wave() -> np.ndarray:
    """Returns the wave on a torus."""
    tiled = wave(np.tile(BLOCKED, (3, 3)), (GOAL[0] + 20, GOAL[1] + 15))
    return np.nanmin(tiled.reshape(3, 20, 3, 15), axis=(0, 2), where=~np.isnan(tiled.reshape(3, 20, 3, 15)), initial=1e9)


def relaxed(sweeps: int, mirrored: bool = False, diagonal: bool = False) -> np.ndarray:
    """Returns the field after Gauss-Seidel sweeps."""
    field = np.zeros(BLOCKED.shape)
    field[GOAL] = -1
    free = [(int(i), int(j)) for i, j in np.argwhere(~BLOCKED) if (i, j) != GOAL]
    near = {cell: around(cell, BLOCKED.shape) for cell in free}
    if diagonal:
        near = {(i, j): near[i, j] + [(a, b) for a in (i - 1, i + 1) for b in (j - 1, j + 1) if 0 <= a < 20 and 0 <= b < 15] for i, j in free}
    for _ in range(sweeps):
        for cell in free:
            count = len(near[cell]) if mirrored else 8 if diagonal else 4
            field[cell] = sum(field[other] for other in near[cell]) / count
    return field


def attraction() -> np.ndarray:
    """Returns a potential of the distance to the goal, scaled to -1 at the goal and 0 far away: it has minima."""
    i, j = np.indices(BLOCKED.shape)
    field = -np.exp(-np.hypot(i - GOAL[0], j - GOAL[1]) / 4)
    field[BLOCKED] = 0
    return field


CONVERGED = relaxed(1500)

NUMBERED = {
    "NaN where there is none": WAVE,
    "-1 where there is none": np.where(np.isnan(WAVE), -1, WAVE).astype(int),
    "infinity where there is none": np.where(np.isnan(WAVE), np.inf, WAVE),
    "a list": WAVE.tolist(),
    "upside down, which is the same": WAVE[:, ::-1],
    "a negative fraction where there is none": np.where(np.isnan(WAVE), -0.5, WAVE),
}
MISNUMBERED = {
    "one more everywhere": (WAVE + 1, "number"),
    "one cell off by one": (changed(WAVE, START, WAVE[START] + 1), "number"),
    "a nearly whole number": (changed(WAVE, START, WAVE[START] + 1e-6), "number"),
    "diagonal moves": (diagonal_wave(), "number"),
    "around the limits": (np.where(BLOCKED, np.nan, round_wave()), "number"),
    "through obstacles": (np.abs(np.indices(WAVE.shape) - np.array(GOAL)[:, None, None]).sum(axis=0), "number"),
    "from the start": (wave(BLOCKED, START), "number"),
    "ended at the start": (np.where(WAVE < WAVE[START], WAVE, np.nan), "missing"),
    "a number in the corner of a bar": (changed(WAVE, (5, 2), 12.0), "blocked"),
    "a number in a wall": (changed(WAVE, (13, 7), 5.0), "blocked"),
    "the goal without a number": (changed(WAVE, GOAL, np.nan), "missing"),
    "negative numbers": (-WAVE, "missing"),
    "lengths in metres": (WAVE / 10, "number"),
    "axes exchanged": (WAVE.T, "shape"),
    "a row too few": (WAVE[1:], "shape"),
    "left and right exchanged": (WAVE[::-1], "number"),
    "an empty cell": (None, "shape"),
}
RELAXED = {
    "a direct solution": FIELD,
    "relaxed": CONVERGED,
    "a list": FIELD.tolist(),
    "in single precision": FIELD.astype(np.float32),
    "a few parts in ten million off": FIELD * (1 + 2e-7 * np.cos(np.indices(FIELD.shape).sum(axis=0)) * (FIELD > -1)),
}
NOT_HARMONIC = {
    "the sign": (-FIELD, "boundary"),
    "from 0 at the goal to 1 at obstacles": (1 + FIELD, "boundary"),
    "1 at obstacles": (np.where(BLOCKED, 1.0, FIELD), "boundary"),
    "the goal free": (changed(FIELD, GOAL, FIELD[17, 7]), "boundary"),
    "one value too high by 1e-5": (changed(FIELD, START, FIELD[START] * (1 - 1e-5)), "residual"),
    "one value too low by 1e-5": (changed(FIELD, (15, 13), FIELD[15, 13] * (1 + 1e-5)), "residual"),
    "a pit": (changed(FIELD, START, -0.5), "minimum"),
    "twenty sweeps": (relaxed(20), "minimum"),
    "sweeps until changes are small in absolute terms": (np.where(FIELD > -1e-6, 0.0, FIELD), "minimum"),
    "sixty sweeps": (relaxed(60), "residual"),
    "mirrors instead of walls": (relaxed(1500, mirrored=True), "residual"),
    "means of eight neighbours": (relaxed(1500, diagonal=True), "residual"),
    "twice as deep, cut at -1": (np.maximum(2 * FIELD, -1), "residual"),
    "an attractive potential": (attraction(), "minimum"),
    "a wavefront": (np.where(BLOCKED, 0.0, -1 / (1 + np.nan_to_num(WAVE))), "residual"),
    "the goal alone": (changed(np.zeros(FIELD.shape), GOAL, -1.0), "minimum"),
    "nothing": (np.zeros(FIELD.shape), "boundary"),
    "not a number": (changed(FIELD, START, np.nan), "shape"),
    "axes exchanged": (FIELD.T, "shape"),
    "an empty cell": (None, "shape"),
}


def test_cells_and_values_are_those_by_hand() -> None:
    assert np.array_equal(WAVES.blocked, BLOCKED) and WAVES.goal == GOAL
    assert np.array_equal(WAVES.grid.values, WAVE, equal_nan=True)
    assert not BLOCKED[START] and WAVE[START] == 32


@pytest.mark.parametrize("answer", NUMBERED.values(), ids=list(NUMBERED))
def test_a_right_wave_is_right(answer: object) -> None:
    is_graded("waves 1", answer, "right")


@pytest.mark.parametrize("answer, reason", MISNUMBERED.values(), ids=list(MISNUMBERED))
def test_a_wrong_wave_is_wrong_for_its_reason(answer: object, reason: str) -> None:
    is_graded("waves 1", answer, reason)


@pytest.mark.parametrize("answer", RELAXED.values(), ids=list(RELAXED))
def test_a_right_field_is_right(answer: object) -> None:
    is_graded("fields 1", answer, "right")


@pytest.mark.parametrize("answer, reason", NOT_HARMONIC.values(), ids=list(NOT_HARMONIC))
def test_a_wrong_field_is_wrong_for_its_reason(answer: object, reason: str) -> None:
    is_graded("fields 1", answer, reason)


def test_a_closed_pocket_has_no_numbers_and_no_field() -> None:
    # The whole U with a lid: its inside is free, but closed.
    bars = [(0.62, 1.42, 0.33, 0.43), (0.62, 1.42, 1.07, 1.17), (1.32, 1.42, 0.33, 1.17), (0.62, 0.72, 0.33, 1.17)]
    obstacles = [{"name": f"bar {k}", "polygon": [[a, c], [b, c], [b, d], [a, d]]} for k, (a, b, c, d) in enumerate(bars)]
    world = cplan.World(*obstacles, start=[0.1, 0.1], goal=[1.85, 0.75])
    waves, fields = (kind(WAVES.arm, world, (20, 15)) for kind in (cplan.grading.Wavefront, cplan.grading.Harmonic))
    steps, field = wave(waves.blocked, GOAL), harmonic(waves.blocked, GOAL)
    assert not waves.blocked[START] and np.isnan(steps[START]) and field[START] == 0
    assert waves.grade(steps) and fields.grade(field)
    assert waves.grade(changed(steps, START, 7)).reason == "not reached"
    assert fields.grade(changed(field, START, -1e-12)).reason == "residual"
