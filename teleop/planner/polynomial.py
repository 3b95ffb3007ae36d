"""Quintic pieces: their bases, and their exact extremes.

A piece is fixed by position, velocity and acceleration at both ends (Hermite), so pieces that share knots are C2 by
construction. A polynomial never leaves the hull of its Bernstein coefficients, so bounding those of its derivatives
bounds them in continuous time with a few linear rows. Extremes are found by descending the derivatives: between the
turning points of one the next is monotone, and bisection cannot miss, where closed formulas lose leading coefficients
that are nearly 0. All of it on u = 0..1 within the piece, which keeps pieces of 10 ms and 10 h equally well scaled.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Columns: p, v h, a h2 at u = 0, then the same at u = 1. Rows: powers of u.
HERMITE: Array = np.array(
    [
        [1, 0, 0, 0, 0, 0],
        [0, 1, 0, 0, 0, 0],
        [0, 0, 0.5, 0, 0, 0],
        [-10, -6, -1.5, 10, -4, 0.5],
        [15, 8, 1.5, -15, 7, -1],
        [-6, -3, -0.5, 6, -3, 0.5],
    ]
)

# The same columns. Rows: Bernstein coefficients.
_BERNSTEIN: Array = np.array(
    [
        [1, 0, 0, 0, 0, 0],
        [1, 1 / 5, 0, 0, 0, 0],
        [1, 2 / 5, 1 / 20, 0, 0, 0],
        [0, 0, 0, 1, -2 / 5, 1 / 20],
        [0, 0, 0, 1, -1 / 5, 0],
        [0, 0, 0, 1, 0, 0],
    ]
)

# BERNSTEIN[k]: Hermite values -> the Bernstein coefficients of the k-th derivative by u.
BERNSTEIN: tuple[Array, ...] = (
    _BERNSTEIN,
    5 * np.diff(_BERNSTEIN, axis=0),
    20 * np.diff(_BERNSTEIN, n=2, axis=0),
    60 * np.diff(_BERNSTEIN, n=3, axis=0),
)

BISECTIONS = 34  # of u: an extreme is off by the square of what is left


def _gram(order: int) -> Array:
    """The integral of the squared derivative over u, as a quadratic form of the Hermite values."""
    power = np.arange(6)
    factor = np.prod([np.clip(power - k, 0, None) for k in range(order)], axis=0)
    left = np.maximum(power - order, 0)
    integral = np.outer(factor, factor) / (left[:, None] + left[None, :] + 1)
    return HERMITE.T @ integral @ HERMITE


GRAM_VELOCITY: Array = _gram(1)
GRAM_ACCELERATION: Array = _gram(2)
GRAM_JERK: Array = _gram(3)


def derivative(coefficients: Array) -> Array:
    """Of polynomials with ascending powers in the last axis; a constant's is empty."""
    return coefficients[..., 1:] * np.arange(1, coefficients.shape[-1])


def evaluate(coefficients: Array, at: Array) -> Array:
    """Row by row: coefficients (n, k) ascending at points (n, m), giving (n, m)."""
    value = np.zeros_like(at)
    for column in coefficients.T[::-1]:
        value = value * at + column[:, None]
    return value


def _sign_changes(coefficients: Array, edges: Array) -> Array:
    """Where each polynomial (n, k) crosses 0 within each span of edges (n, m + 1); (n, m), an end where it does not."""
    low, high = edges[:, :-1].copy(), edges[:, 1:].copy()
    rising = evaluate(coefficients, high) > evaluate(coefficients, low)
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        below = (evaluate(coefficients, middle) < 0) == rising
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return (low + high) / 2


def extremes(coefficients: Array, widths: Array) -> tuple[Array, Array]:
    """Least and greatest (4, n) of position, velocity, acceleration and jerk over each piece.

    `coefficients` (n, 6) are in local time, ascending; `widths` (n,) are the durations of the pieces in seconds.
    """
    orders = [coefficients * widths[:, None] ** np.arange(6)]
    for _ in range(4):
        orders.append(derivative(orders[-1]))
    ends = np.tile([0.0, 1.0], (len(widths), 1))
    points = ends
    least, greatest = np.empty((4, len(widths))), np.empty((4, len(widths)))
    for order in (3, 2, 1, 0):
        points = np.hstack([ends[:, :1], _sign_changes(orders[order + 1], points), ends[:, 1:]])
        value = evaluate(orders[order], points) / widths[:, None] ** order
        least[order], greatest[order] = value.min(axis=1), value.max(axis=1)
    return least, greatest
