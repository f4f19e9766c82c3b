"""Medians, quartiles and how they are written."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence


def median(values: Sequence[float]) -> float:
    """The median; not a number of nothing."""
    return statistics.median(values) if values else math.nan


def quartiles(values: Sequence[float]) -> tuple[float, float]:
    """First and third quartile."""
    if len(values) < 2:
        return (values[0], values[0]) if values else (math.nan, math.nan)
    low, _, high = statistics.quantiles(values, n=4, method="inclusive")
    return low, high


def short(value: float) -> str:
    """Three significant digits, plainly written."""
    if not math.isfinite(value):
        return "-"
    if value == 0:
        return "0"
    digits = max(0, 2 - math.floor(math.log10(abs(value))))
    return f"{value:,.{digits}f}".replace(",", " ")


def spread(values: Sequence[float]) -> str:
    """Median and, in brackets, quartiles."""
    if not values:
        return "-"
    if len(values) == 1:
        return f"{short(values[0])} (once)"
    low, high = quartiles(values)
    return f"{short(median(values))} ({short(low)} to {short(high)})"


def times(ratio: float) -> str:
    """A ratio."""
    return "-" if not math.isfinite(ratio) else f"{short(ratio)}x"
