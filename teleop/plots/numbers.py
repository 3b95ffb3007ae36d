"""Numbers as a page's JSON has them."""

from __future__ import annotations

import math


def finite(limit: float) -> float | None:
    return limit if math.isfinite(limit) else None


def short(value: float) -> float:
    """Six digits: finer than a screen, a third of the bytes."""
    return float(f"{value:.6g}")
