"""Tables by the frame as keys: a common run-up, few keys, and why a table cannot be followed."""

from __future__ import annotations

import numpy as np
import pytest

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.frame_keys import Frames
from teleop.planner.keyframes.frames import FrameFitter, NoRoomError, TooFastError
from teleop.planner.keyframes.keys import Key
from teleop.planner.keyframes.planner import plan

LIMITS = Limits(-180, 180, 120, 240, 1200)
TIMES = np.arange(120) / 24


def fitter(positions: np.ndarray, tolerance: float = 0.1) -> FrameFitter:
    return FrameFitter([Frames(Axis.PAN, positions, tolerance, LIMITS)], 24)


def test_a_table_at_rest_is_one_key() -> None:
    found = fitter(np.full(120, 3.0)).fit()
    assert (list(found.keys[Axis.PAN].values()), found.runs.up, found.runs.out) == ([3.0], 0, 0)


def test_one_frame_is_enough() -> None:
    assert fitter(np.array([3.0])).fit().keys[Axis.PAN] == {0: 3.0}


def test_a_smaller_tolerance_needs_no_fewer_keys() -> None:
    wave = 20 * np.sin(TIMES) + 3 * np.sin(4 * TIMES)
    counts = [len(fitter(wave, tolerance).fit().keys[Axis.PAN]) for tolerance in (1.0, 0.1, 0.02)]
    assert counts == sorted(counts)
    assert counts[0] < counts[-1] < 40


@pytest.mark.parametrize("seed", range(4))
def test_random_tracks_are_met_at_every_frame(seed: int) -> None:
    random = np.random.default_rng(seed)
    wave = sum(random.normal(0, 8) / k * np.sin(k * TIMES + random.uniform(0, 6)) for k in (1, 2, 3))
    noisy = wave + random.uniform(-0.04, 0.04, 120)
    found = fitter(noisy).fit()
    lead = found.runs.up / 24
    keys = [Key(lead + place / 24, position, tension=0.0) for place, position in found.keys[Axis.PAN].items()]
    track = plan({Axis.PAN: keys}, {Axis.PAN: LIMITS}).tracks[Axis.PAN]
    assert np.abs(track.sample(lead + TIMES)[0] - noisy).max() <= 0.1


def test_a_corner_is_too_fast_and_how_much_slower_would_do_is_known() -> None:
    corner = np.maximum(0.0, 40 * (TIMES - 2))
    with pytest.raises(TooFastError) as error:
        fitter(corner).fit()
    assert (error.value.axis, abs(error.value.place - 48) < 5) == (Axis.PAN, True)
    assert error.value.factor is not None
    slower = fitter(corner).fit(may_stretch=True)
    assert slower.factor == pytest.approx(error.value.factor)


def test_no_room_before_and_after() -> None:
    for positions, after in ((179.9 - 40 * TIMES[:60], False), (-179.9 + 40 * TIMES[:60][::-1], True)):
        with pytest.raises(NoRoomError) as error:
            fitter(positions).fit()
        assert error.value.after is after
