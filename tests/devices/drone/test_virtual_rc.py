"""The virtual RC as a way to hold a drone: docs/protocol-facts.md, 05 00, 05 01 and "Flying safely"."""

from __future__ import annotations

import pytest
from fake_drone_link import FakeConnection, FakeTelemetry

from teleop.core.axes import STICKS
from teleop.devices.drone.virtual_rc import VirtualRcControl
from teleop.dji.drone.broadcast_parts import ControlSource
from teleop.dji.drone.enums import CurrentMode, FlightStatus
from teleop.dji.drone.virtual_rc import NEUTRAL, Sticks

CENTERED = dict.fromkeys(STICKS, 0.0)
GESTURE = Sticks(364, 364, 364, 1684)


def control_part(virtual_rc: bool) -> ControlSource:
    return ControlSource(CurrentMode.ATTI_STOP, 0, virtual_rc=virtual_rc)


class Bench:
    def __init__(self, go_home: int | None = None) -> None:
        self.link, self.seen, self.now = FakeConnection(), FakeTelemetry(), 10.0
        self.control = VirtualRcControl(self.link.real, True, go_home)

    def drive(self, **sticks: float) -> Sticks:
        given = {axis: sticks.get(axis.value.rpartition("_")[2], 0.0) for axis in STICKS}
        self.control.drive(given, self.seen.real, self.now)
        sent = self.link.streamed[-1]
        assert isinstance(sent, Sticks)
        return sent

    def command(self, word: str) -> str:
        return self.control.tell(word, self.seen.real, self.now)

    def notify(self, **parts: object) -> None:
        """The drone says this, now."""
        self.seen.parts, self.seen.since = parts, self.now


def test_taking_and_giving_back_are_one_message_each_that_leave_it_to_its_rc() -> None:
    bench = Bench()
    bench.control.take(bench.seen.real, bench.now)
    bench.control.give_back(bench.now + 1)
    bench.control.give_back_again(bench.now + 2)
    assert [message.encode() for message in bench.link.streamed] == [b"\x03", b"\x02"]
    assert bench.link.requests == []


def test_full_sticks_are_660_from_the_middle_and_no_more() -> None:
    bench = Bench()
    assert bench.drive() == NEUTRAL
    assert bench.drive(roll=1, pitch=-1, throttle=0.5, yaw=-7) == Sticks(1684, 364, 1354, 364)


def test_a_switch_stays_until_neutral_resets_it() -> None:
    bench = Bench(go_home=1684)
    assert (bench.command("mode-f"), bench.command("gear-up"), bench.command("home")) == tuple(
        f"{word}: set" for word in ("mode-f", "gear-up", "home")
    )
    sent = bench.drive()
    assert (sent.mode, sent.gear, sent.go_home) == (496, 1684, 1684)
    bench.control.neutral(bench.seen.real, bench.now)
    assert bench.drive() == NEUTRAL


def test_without_a_value_in_the_profile_nothing_is_sent_home() -> None:
    bench = Bench()
    assert "no channel value" in bench.command("home")
    assert bench.drive() == NEUTRAL
    with pytest.raises(KeyError):
        bench.command("fly")


def test_the_gesture_that_would_cut_the_motors_is_not_made_in_the_air() -> None:
    bench = Bench()
    for status in (FlightStatus.IN_AIR, None):
        bench.notify(status=status)
        assert "refused" in bench.command("arm")
        assert bench.drive() == NEUTRAL


@pytest.mark.parametrize("end", ["late", "stick", "airborne"])
def test_the_gesture_ends_after_2_s_or_with_a_stick_or_when_it_flies(end: str) -> None:
    bench = Bench()
    bench.notify(status=FlightStatus.STANDBY)
    bench.command("arm")
    assert bench.drive() == GESTURE
    if end == "late":
        bench.now += 2.0
        bench.notify(status=FlightStatus.STANDBY)
        assert bench.drive() == NEUTRAL
    elif end == "stick":
        assert bench.drive(throttle=0.1) == Sticks(throttle=1090)
    else:
        bench.notify(status=FlightStatus.IN_AIR)
        assert bench.drive() == NEUTRAL
    bench.notify(status=FlightStatus.STANDBY)
    assert bench.drive() == NEUTRAL, "it does not begin again"


def test_another_programs_enable_is_waited_out_for_2_s() -> None:
    bench = Bench()
    bench.notify(control=control_part(True))
    bench.control.watch(bench.seen.real, bench.now)
    assert "on already" in next(bench.control.refusals(bench.seen.real, bench.now))
    bench.now += 0.5
    bench.notify(control=control_part(False))
    assert next(bench.control.refusals(bench.seen.real, bench.now)).startswith("wait 1.5 s")
    bench.now += 1.6
    bench.notify(control=control_part(False))
    assert list(bench.control.refusals(bench.seen.real, bench.now)) == []


def test_its_own_enable_is_no_others() -> None:
    bench = Bench()
    bench.control.take(bench.seen.real, bench.now)
    bench.now += 0.1
    bench.notify(control=control_part(True))
    bench.control.watch(bench.seen.real, bench.now)
    bench.notify(control=control_part(False))
    assert list(bench.control.refusals(bench.seen.real, bench.now)) == []


def test_a_bit_from_before_the_last_change_says_nothing() -> None:
    bench = Bench()
    bench.notify(control=control_part(False))
    bench.now += 0.1
    bench.control.take(bench.seen.real, bench.now)
    assert bench.control.held(bench.seen.real, bench.now + 0.05) is None
    bench.now += 0.1
    bench.notify(control=control_part(True))
    assert bench.control.held(bench.seen.real, bench.now) is True
