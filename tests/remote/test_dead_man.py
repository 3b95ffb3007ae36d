"""The stick of a hand on the network, by what the rig does: how soon it rests when the hand is lost, and what then."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from remote_bench import ANNA, BOB, RemoteBench

from teleop.core.axes import Axis
from teleop.remote.stick import DISARM, RAMP, RemoteStick

LEGAL_RAMP = 60 / 240 + 240 / 2400  # s from full speed to rest within the bench's limits
TICK = 0.01


def test_a_held_stick_moves_its_axis_and_a_released_one_lets_it_rest(held: RemoteBench) -> None:
    held.hold(1.0, pan=0.5)
    assert held.speed() == pytest.approx(30)
    assert held.state["axes"]["pan"]["driver"] == "Anna"
    held.release()
    held.run(1)
    assert held.rests
    assert held.state["sticks"] == {"missed": 0, "age_ms": None, "armed": True, "waits_for": ""}
    held.hold(0.5, pan=-0.5)  # silence after a release is no outage
    assert held.speed() == pytest.approx(-30)


def test_a_hand_that_falls_silent_is_at_rest_after_250_ms_and_the_legal_ramp(held: RemoteBench) -> None:
    held.hold(1.0, pan=1.0)
    last = held.now - 2 * TICK
    held.run(RAMP - 3 * TICK)
    assert held.speed() == pytest.approx(60)
    while not held.rests:
        held.tick()
    assert held.now - last <= RAMP + LEGAL_RAMP + 2 * TICK


def test_a_short_silence_without_a_gap_goes_on_by_itself(held: RemoteBench) -> None:
    held.hold(0.5, pan=0.5)
    held.run(0.6)
    assert held.rests
    assert held.state["sticks"]["age_ms"] > 500
    held.hold(0.5, pan=0.5)
    assert held.speed() == pytest.approx(30)


@pytest.mark.parametrize(("silence", "skip"), [(DISARM + 0.05, 0), (0.4, 5)])
def test_a_long_silence_or_one_with_a_gap_disarms(held: RemoteBench, silence: float, skip: int) -> None:
    held.hold(0.5, pan=0.5)
    held.run(silence)
    held.stick(skip=skip, pan=0.5)
    held.hold(0.5, pan=0.5)
    assert held.rests
    assert "take control again" in held.state["sticks"]["waits_for"]
    assert "ok" in held.ask("take_control")
    held.hold(0.3, pan=0.5)
    assert held.rests  # it has not been seen centered since
    assert held.state["sticks"]["waits_for"] == "center the stick"
    held.release()
    held.hold(0.5, pan=0.5)
    assert held.speed() == pytest.approx(30)


def test_a_gap_while_it_is_heard_is_counted_and_no_more(held: RemoteBench) -> None:
    held.hold(0.3, pan=0.5)
    held.stick(skip=3, pan=0.5)
    held.hold(0.3, pan=0.5)
    assert held.speed() == pytest.approx(30)
    assert held.state["sticks"]["missed"] == 3


def test_a_backlog_that_comes_in_a_burst_moves_nothing(held: RemoteBench) -> None:
    held.hold(0.5, pan=0.5)
    held.run(0.7)
    assert held.rests
    for late in (0.7, 0.6, 0.5, 0.4, 0.3):
        held.stick(late=late, pan=0.5)
    held.run(0.1)
    assert held.rests
    held.hold(0.3, pan=0.5)
    assert held.speed() == pytest.approx(30)


def test_what_comes_late_ages_from_when_it_was_sent(held: RemoteBench) -> None:
    """Wi-Fi that stretches: a message 150 ms under way leaves 100 ms until the ramp."""
    held.hold(0.5, pan=1.0)
    held.run(0.13)
    held.stick(late=0.15, pan=1.0)
    held.run(0.15)
    assert held.speed() < 60


def test_a_clock_that_drifts_stays_known(held: RemoteBench) -> None:
    stick = RemoteStick({Axis.PAN: None}, lambda value: value)
    stick.give(ANNA, "Anna")
    now, drift = 0.0, 1e-4  # 100 ppm, for two hours
    for seq in range(72):
        now += 100.0
        stick.take(ANNA, {"seq": 2 * seq, "axes": {Axis.PAN: 0.0}}, now * (1 - drift), now)
        stick.take(ANNA, {"seq": 2 * seq + 1, "axes": {Axis.PAN: 0.5}}, (now + 0.02) * (1 - drift), now + 0.02)
        assert stick.read(now + 0.03).deflections == {Axis.PAN: 0.5}
        stick.take(ANNA, {"seq": 2 * seq + 2, "axes": {Axis.PAN: 0.0}}, (now + 0.04) * (1 - drift), now + 0.04)


def test_only_the_holders_stick_counts(held: RemoteBench) -> None:
    held.hold(0.5, BOB, pan=1.0)
    assert held.rests
    assert held.state["sticks"]["missed"] == 0


def test_a_finger_that_was_down_before_control_has_to_be_lifted_first(bench: RemoteBench) -> None:
    bench.hold(0.3, pan=1.0)
    assert "ok" in bench.ask("take_control")
    bench.hold(0.3, pan=1.0)
    assert bench.rests
    bench.release()
    bench.hold(0.3, pan=1.0)
    assert bench.speed() > 0


def test_a_closed_connection_stops_the_stick_at_once_and_frees_control_once_the_axes_rest(held: RemoteBench) -> None:
    held.hold(0.5, pan=1.0)
    held.say("closed")
    begin = held.now
    while not held.rests:
        held.tick()
    assert held.now - begin <= LEGAL_RAMP + 3 * TICK
    held.tick(2)
    assert held.state["holder"] is None


def test_a_local_stick_outranks_the_holder(held: RemoteBench) -> None:
    held.pad.hold(pan=-0.5)
    held.hold(0.5, pan=1.0)
    assert held.speed() == pytest.approx(-30)
    assert held.state["axes"]["pan"]["driver"] == "pad"


def test_a_stop_needs_the_stick_centered_after_it_is_cleared(held: RemoteBench) -> None:
    held.hold(0.3, pan=1.0)
    held.say("stop", BOB)
    held.hold(0.5, pan=1.0)
    assert held.rests
    assert (held.state["stopped"], held.state["stopped_by"]) == (True, "Bob")
    held.ask("clear")
    held.hold(0.3, pan=1.0)
    assert held.rests
    held.release()
    held.hold(0.3, pan=1.0)
    assert held.speed() > 0


@settings(max_examples=40, deadline=None)
@given(
    st.lists(
        st.tuples(st.floats(0, 0.6), st.floats(0, 0.5), st.integers(0, 3), st.sampled_from([-1.0, 0.0, 0.5])),
        max_size=30,
    )
)
def test_whatever_a_network_does_a_deflection_is_never_older_than_250_ms(
    messages: list[tuple[float, float, int, float]],
) -> None:
    """By the sender's clock, as far as it can be known: messages are `delay` s under way, in order, with gaps."""
    stick = RemoteStick({Axis.PAN: None}, lambda value: value)
    stick.give(ANNA, "Anna")
    sent, arrived, seq = 0.0, 0.0, 0
    stick.take(ANNA, {"seq": 0, "axes": {Axis.PAN: 0.0}}, 100.0, 0.0)  # none is quicker than this one
    newest = 0.0
    for pause, delay, skip, value in messages:
        sent += 0.02 + pause
        before, arrived = arrived, max(arrived, sent + delay)
        for step in range(int((arrived - before) / TICK)):
            now = before + step * TICK
            if stick.read(now).deflections.get(Axis.PAN):
                assert now - newest <= RAMP + 1e-3 * max(1.0, now)
        seq += 1 + skip
        stick.take(ANNA, {"seq": seq, "axes": {Axis.PAN: value}}, 100.0 + sent, arrived)
        newest = max(newest, sent)
