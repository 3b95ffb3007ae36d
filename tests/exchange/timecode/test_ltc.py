"""LTC, judged by libltc's own encoder: labels, times, and everything that is no LTC."""

from __future__ import annotations

import os
import random

import pytest
from ltc_sound import encoded, is_installed

from teleop.exchange.timecode.ltc import LtcDecoder
from teleop.exchange.timecode.reading import Fault, Reading, frame
from teleop.exchange.timecode.sound import SampleClock
from teleop.exchange.timecode.tracker import Tracker

pytestmark = pytest.mark.skipif(not is_installed(), reason="libltc is not installed")
SAMPLES = 48000


@pytest.mark.parametrize(("fps", "drop"), [(24.0, False), (25.0, False), (29.97, True), (30.0, False)])
def test_labels_and_the_times_of_their_frames_are_those_that_were_encoded(fps: float, drop: bool) -> None:
    decoder = LtcDecoder(SAMPLES, fps)
    whole = round(fps)
    sound = encoded((0, 59, 59, whole - 5), 40, fps, drop)
    found = []
    for first in range(0, len(sound), 960):
        found += decoder.take(sound[first : first + 960])
    decoder.close()
    assert len(found) == 39
    exact = 30000 / 1001 if drop else fps
    begin = frame((0, 59, 59, whole - 5), whole, drop)
    for number, each in enumerate(found):
        assert isinstance(each, Reading)
        assert each.drop is drop
        assert frame(each.label, whole, drop) == begin + number
        assert each.time == pytest.approx(number / exact, abs=2e-4)


def test_it_locks_to_where_the_sound_is_and_says_what_runs_backwards() -> None:
    decoder, tracker = LtcDecoder(SAMPLES, 25.0), Tracker(25.0, (1, 0, 0, 0))
    tracker.offset = 7.0
    for found in decoder.take(encoded((0, 59, 59, 0), 75, 25.0)):
        tracker.take(found, 10.0)
    reference = tracker.reference(9.0)
    assert reference is not None
    assert reference.at == pytest.approx(1.0, abs=1e-3)
    for found in decoder.take(encoded((1, 0, 2, 0), 10, 25.0, back=True)):
        tracker.take(found, 11.0)
    assert tracker.why == "runs backwards"
    assert tracker.reference(11.0) is None
    decoder.close()


def test_another_rate_than_the_profile_has_is_said() -> None:
    decoder, tracker = LtcDecoder(SAMPLES, 25.0), Tracker(25.0, (1, 0, 0, 0))
    whys = set()
    for found in decoder.take(encoded((1, 0, 0, 0), 60, 24.0)):
        tracker.take(found, 3.0)
        whys.add(tracker.why)
    assert any("frames per second, not 25" in why for why in whys)
    decoder.close()


def test_noise_is_no_timecode() -> None:
    decoder, tracker, rng = LtcDecoder(SAMPLES, 25.0), Tracker(25.0, (1, 0, 0, 0)), random.Random(5)
    for _ in range(100):
        block = os.urandom(rng.randrange(0, 4000))
        for found in decoder.take(block):
            assert isinstance(found, Reading | Fault)
            tracker.take(found, 0.0)
    assert not tracker.locked
    decoder.close()


def test_the_clock_of_the_samples_is_that_of_the_quickest_blocks() -> None:
    clock, rng = SampleClock(SAMPLES), random.Random(1)
    for block in range(1, 600):
        clock.add(480, 100.0 + block * 0.01 + 0.002 + 0.008 * rng.random())
    assert clock.offset == pytest.approx(100.0 + 0.002, abs=1e-3)


@pytest.mark.parametrize("late", [0.02, 0.3])
def test_sound_that_a_busy_computer_hears_late_at_first_is_of_the_right_speed(late: float) -> None:
    """The lateness is caught up within a second: by the times of arrival the code would run much too fast."""
    clock, decoder, tracker = SampleClock(SAMPLES), LtcDecoder(SAMPLES, 25.0), Tracker(25.0, (1, 0, 0, 0))
    sound = encoded((1, 0, 0, 0), 75, 25.0)
    for first in range(0, len(sound), 960):
        heard = 50.0 + (first + 960) / (2 * SAMPLES)
        heard += max(0.0, late * (51.0 - heard))
        clock.add(480, heard)
        tracker.offset = clock.offset
        for found in decoder.take(sound[first : first + 960]):
            tracker.take(found, heard)
            assert not tracker.why
    decoder.close()
    reference = tracker.reference(53.0)
    assert reference is not None
    assert reference.at == pytest.approx(3.0, abs=1e-3)
    assert tracker.locks == 1


def test_sound_that_was_interrupted_is_timed_anew_when_it_comes_back() -> None:
    """As from a program that writes nothing while its code is stopped: the rig would run ahead by the whole pause."""
    clock, decoder, tracker = SampleClock(SAMPLES), LtcDecoder(SAMPLES, 25.0), Tracker(25.0, (1, 0, 0, 0))
    heard = 50.0
    for begin, pause in (((1, 0, 0, 0), 3.0), ((1, 0, 7, 0), 0.0)):
        sound = encoded(begin, 50, 25.0)
        for first in range(0, len(sound), 960):
            heard += 0.01
            clock.add(480, heard)
            tracker.offset = clock.offset
            for found in decoder.take(sound[first : first + 960]):
                tracker.take(found, heard)
            tracker.look(heard)
        tracker.look(heard + pause)
        heard += pause
    decoder.close()
    reference = tracker.reference(heard)
    assert reference is not None
    assert reference.at == pytest.approx(9.0, abs=0.02)
