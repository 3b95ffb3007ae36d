"""Where a recorded axis stands still, and where its speed is even."""

from __future__ import annotations

import numpy as np

from teleop.core.axes import Axis
from teleop.recording.to_keyframes.rests import Span, aligned, even_ways, rests


def speeds(*parts: tuple[int, float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Velocity and acceleration of parts (places, from, to), a speed changing evenly within each."""
    velocity = np.concatenate([np.linspace(first, last, count, endpoint=False) for count, first, last in parts])
    return velocity, np.gradient(velocity, 0.01)


def test_rests_are_spans_without_motion_and_both_ends() -> None:
    velocity, acceleration = speeds((50, 0, 0), (50, 0, 10), (50, 10, 0), (60, 0, 0), (50, 0, 10))
    found = rests(velocity, acceleration)
    assert [found[0].begin, found[-1]] == [0, Span(259, 259)]
    assert any(150 <= rest.begin <= 152 and 207 <= rest.end <= 209 for rest in found)


def test_an_axis_that_only_turns_back_does_not_rest_there() -> None:
    time = np.arange(201) / 100
    velocity = 10 * np.sin(np.pi * time)  # through 0 at 1 s, with its greatest acceleration
    assert [rest for rest in rests(velocity, 10 * np.pi * np.cos(np.pi * time)) if 50 < rest.begin < 150] == []


def test_a_momentary_stop_is_one_place() -> None:
    time = np.arange(201) / 100 - 1
    velocity, acceleration = 10 * time**2, 20 * time
    assert Span(100, 100) in rests(velocity, acceleration)


def test_an_even_way_is_where_a_stick_is_held() -> None:
    velocity, acceleration = speeds((50, 0, 0), (50, 0, 10), (100, 10, 10), (50, 10, 0), (50, 0, 0))
    [way] = even_ways(velocity, acceleration)
    assert 100 <= way.begin <= 102
    assert 197 <= way.end <= 199


def test_rests_that_nearly_begin_together_are_made_to() -> None:
    found = aligned({Axis.PAN: [Span(0, 50), Span(100, 200)], Axis.TILT: [Span(0, 50), Span(120, 200)]})
    assert found[Axis.PAN] == [Span(0, 50), Span(120, 200)]
    far = aligned({Axis.PAN: [Span(0, 50), Span(100, 200)], Axis.TILT: [Span(0, 50), Span(150, 200)]})
    assert far[Axis.PAN] == [Span(0, 50), Span(100, 200)]
