"""The splines of a correction: what they are at their ends and waits, and that bounds on coefficients bound them."""

from __future__ import annotations

import numpy as np
import pytest

from teleop.learning.basis import ORDERS, Basis

EDGES = [-0.3, 2.0, 5.3]


def drawn(basis: Basis, seed: int = 0) -> np.ndarray:
    found = np.zeros(basis.count)
    found[basis.free] = np.random.default_rng(seed).normal(size=len(basis.free))
    return found


def test_a_correction_is_nothing_at_rest_at_both_ends_and_at_a_wait():
    basis = Basis(EDGES)
    track = basis.track(drawn(basis))
    for edge in EDGES:
        assert tuple(track.at(edge)) == pytest.approx((0, 0, 0), abs=1e-9)
    assert track.at(-1.0).position == track.at(9.0).position == 0.0


def test_its_track_is_what_its_matrix_says():
    basis, times = Basis(EDGES), np.linspace(-0.3, 5.3, 700)
    found = drawn(basis)
    assert basis.track(found).sample(times)[0] == pytest.approx(basis.values(times) @ found, abs=1e-9)


def test_its_coefficients_are_found_again_from_its_track():
    basis = Basis(EDGES)
    found = drawn(basis)
    assert basis.coefficients(basis.track(found)) == pytest.approx(found, abs=1e-9)


@pytest.mark.parametrize("order", range(ORDERS))
def test_a_derivative_never_leaves_the_hull_of_its_coefficients(order: int):
    basis = Basis(EDGES)
    found = drawn(basis, 1)
    coefficients = basis.derivative(order) @ found
    times = np.linspace(-0.299, 5.299, 3000)
    values = basis.track(found).sample(times)[order]
    first, last = basis.supports(order)
    span = np.searchsorted(basis.knots, times, side="right") - 1
    for index in range(0, len(times), 7):
        reaching = coefficients[(first <= span[index]) & (span[index] < last)]
        slack = 1e-7 * np.abs(coefficients).max()
        assert reaching.min() - slack <= values[index] <= reaching.max() + slack
