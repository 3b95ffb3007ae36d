"""Nothing is sent before the first reading, nor of a gimbal that no longer reports."""

from __future__ import annotations

import time

import fake_served
import pytest
from fake_served import LIMITS, FakeServed

from teleop.core.axes import Axis, Limits, Reading
from teleop.core.errors import TeleopError
from teleop.exchange import attitude
from teleop.exchange.attitude import LENS, OLD, AttitudeFeed

FOCUS = {**LIMITS, Axis.FOCUS: Limits(0.0, 1.0, 1.0, 1.0, 1.0)}


class Clock:
    def __init__(self) -> None:
        self.now = time.monotonic()

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch):
    clock = Clock()
    for module in (attitude, fake_served):
        monkeypatch.setattr(module, "monotonic", clock)
    return clock


def test_there_is_nothing_before_the_first_reading_of_every_angle(clock):
    fake = FakeServed()
    feed = AttitudeFeed(fake.served, "freed", 0.0)
    assert feed.at(clock.now) is None
    fake.door.measure(pan=10.0)
    assert feed.at(clock.now + 0.01) is None
    fake.door.measure(pan=10.0, tilt=-5.0)
    assert feed.at(clock.now + 0.01) == (10.0, -5.0, 0.0, None)
    assert fake.lines == []


def test_old_readings_are_not_sent_and_both_ends_of_that_are_told_once(clock):
    fake = FakeServed()
    feed = AttitudeFeed(fake.served, "freed", 0.0)
    fake.door.measure(pan=10.0, tilt=-5.0)
    assert feed.at(clock.now + 0.01) is not None
    for _ in range(3):
        clock.now += OLD + 0.1
        assert feed.at(clock.now) is None
    assert fake.lines == ["freed: the newest reading is 0.6 s old: nothing is sent until the gimbal reports again"]
    fake.door.measure(pan=11.0, tilt=-5.0)
    clock.now += 0.01
    assert feed.at(clock.now + 0.01) is not None
    assert fake.lines[1:] == ["freed: the gimbal reports again: messages go on"]


def test_one_axis_that_hangs_is_enough_to_send_nothing(clock):
    fake = FakeServed()
    feed = AttitudeFeed(fake.served, "freed", 0.0)
    fake.door.measure(pan=10.0, tilt=-5.0)
    assert feed.at(clock.now + 0.01) is not None
    clock.now += OLD + 0.1
    fake.door.measure(pan=11.0)
    assert feed.at(clock.now) is None


def test_a_focus_is_waited_for_and_then_done_without(clock):
    fake = FakeServed(FOCUS)
    feed = AttitudeFeed(fake.served, "freed", 0.0)
    fake.door.measure(pan=10.0, tilt=-5.0)
    found = feed.at(clock.now + 0.01)
    assert found is None
    for _ in range(4):
        clock.now += LENS / 4
        fake.door.measure(pan=10.0, tilt=-5.0)
        found = feed.at(clock.now)
    assert found == (10.0, -5.0, 0.0, None)
    fake.door.measure(pan=10.0, tilt=-5.0, focus=0.5)
    assert feed.at(clock.now + 0.01) == (10.0, -5.0, 0.0, 0.5)


def test_a_latency_that_is_too_short_is_told_once(clock):
    fake = FakeServed()
    feed = AttitudeFeed(fake.served, "freed", 0.01)
    fake.door.measure(pan=10.0, tilt=-5.0)
    for _ in range(600):
        assert feed.at(clock.now + 0.01) is not None
    assert len(fake.lines) == 1
    assert "100% of the messages are ahead of the newest reading" in fake.lines[0]


def test_a_rig_without_angles_is_refused():
    with pytest.raises(TeleopError, match="no pan, tilt or roll"):
        AttitudeFeed(FakeServed({Axis.FOCUS: FOCUS[Axis.FOCUS]}).served, "freed", 0.1)


def test_an_angle_that_the_run_does_not_move_is_sent_as_it_was_measured(clock):
    """As in a move of pan and tilt: the gimbal reports its roll all the same."""
    fake = FakeServed({**LIMITS, Axis.ROLL: LIMITS[Axis.PAN]})
    feed = AttitudeFeed(fake.served, "freed", 0.0)
    fake.door.measure(pan=10.0, tilt=-5.0)
    assert feed.at(clock.now + 0.01) is None
    fake.door.beside[Axis.ROLL] = Reading(1.5, clock.now)
    fake.door.measure(pan=10.0, tilt=-5.0)
    assert feed.at(clock.now + 0.01) == (10.0, -5.0, 1.5, None)
