"""The exact extremes against dense samples, and the hull property the planner's proof rests on."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial import Polynomial

from teleop.planner.polynomial import BERNSTEIN, GRAM_JERK, GRAM_VELOCITY, HERMITE, extremes

hermite_values = st.lists(st.floats(-10, 10), min_size=6, max_size=6).map(np.array)
widths = st.sampled_from([0.01, 0.5, 3.0, 86400.0])


def derivatives(coefficients):
    return [Polynomial(coefficients).deriv(k) if k else Polynomial(coefficients) for k in range(4)]


@given(hermite_values, widths)
def test_extremes_are_those_of_dense_samples(values, width):
    coefficients = (HERMITE @ values) / width ** np.arange(6)
    least, greatest = extremes(coefficients[None], np.array([width]))
    times = np.linspace(0, width, 2001)
    for order, polynomial in enumerate(derivatives(coefficients)):
        samples = polynomial(times)
        size = max(np.abs(samples).max(), 1e-12)
        assert least[order, 0] <= samples.min() + 1e-9 * size
        assert greatest[order, 0] >= samples.max() - 1e-9 * size
        assert least[order, 0] >= samples.min() - 1e-3 * size  # no more than 2001 samples can miss
        assert greatest[order, 0] <= samples.max() + 1e-3 * size


def test_pieces_are_independent():
    pieces = np.array([[0, 1, 0, 0, 0, 0], [5, 0, -1, 0, 0, 0]], dtype=float)
    least, greatest = extremes(pieces, np.array([2.0, 1.0]))
    assert greatest[0].tolist() == [2.0, 5.0]
    assert least[0].tolist() == [0.0, 4.0]
    assert least[2].tolist() == [0.0, -2.0]


@given(hermite_values)
def test_hermite_values_are_met_at_both_ends(values):
    position, velocity, acceleration, _ = derivatives(HERMITE @ values)
    ends = [f(u) for u in (0.0, 1.0) for f in (position, velocity, acceleration)]
    np.testing.assert_allclose(ends, values, atol=1e-9)


@given(hermite_values)
def test_a_derivative_stays_in_the_hull_of_its_bernstein_coefficients(values):
    u = np.linspace(0, 1, 501)
    for order, polynomial in enumerate(derivatives(HERMITE @ values)):
        hull = BERNSTEIN[order] @ values
        assert polynomial(u).max() <= hull.max() + 1e-9
        assert polynomial(u).min() >= hull.min() - 1e-9


@given(hermite_values)
def test_grams_are_the_integrals_of_squares(values):
    _, velocity, _, jerk = derivatives(HERMITE @ values)
    for polynomial, gram in ((velocity, GRAM_VELOCITY), (jerk, GRAM_JERK)):
        integral = (polynomial**2).integ()
        expected = integral(1.0) - integral(0.0)
        np.testing.assert_allclose(values @ gram @ values, expected, rtol=1e-9, atol=1e-9)
