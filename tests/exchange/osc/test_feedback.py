"""What a receiver of feedback gets, and when."""

from __future__ import annotations

from typing import Any

from teleop.exchange.osc.feedback import Feedback
from teleop.links.osc_packets import messages


def state(pan: float | None = 0.0, age: float = 10.0, **more: Any) -> dict[str, Any]:
    axes = {"pan": {"measured": pan, "measured_age_ms": None if pan is None else age}}
    base = {"age_ms": 8.0, "stopped": False, "recording": False, "holder": None, "move": None}
    return {**base, "axes": axes, **more}


def sent(feedback: Feedback, state: dict[str, Any], now: float) -> dict[str, Any]:
    packets = [messages(data) for data in feedback.due(state, now)]
    assert all(len(each) == 1 for each in packets)  # single messages, no bundles
    return {message.address: message.arguments[0] for (message,) in packets}


def test_nothing_is_sent_before_the_first_reading():
    feedback = Feedback()
    assert sent(feedback, {}, 0.0) == {}
    assert sent(feedback, state(None), 0.1) == {}
    first = sent(feedback, state(1.5), 0.2)
    assert first == {
        "/teleop/axis/pan/position": 1.5,
        "/teleop/stopped": 0,
        "/teleop/recording": 0,
        "/teleop/holder": "",
        "/teleop/playing": 0,
        "/teleop/paused": 0,
        "/teleop/move": "",
    }


def test_positions_come_ten_times_a_second_and_when_they_change():
    feedback, rest, moving = Feedback(), 0, 0
    for tick in range(200):
        rest += "/teleop/axis/pan/position" in sent(feedback, state(1.0), tick / 100)
    assert rest == 20
    sent(feedback, state(1.0), 2.0)
    assert sent(feedback, state(2.0), 2.02) == {"/teleop/axis/pan/position": 2.0}
    for tick in range(100):
        moving += bool(sent(feedback, state(2.0 + tick / 10), 2.03 + tick / 100))
    assert moving == 50


def test_a_button_is_told_at_once_and_again():
    feedback = Feedback()
    sent(feedback, state(), 0.0)
    assert sent(feedback, state(stopped=True, holder="Anna"), 0.01) == {"/teleop/stopped": 1, "/teleop/holder": "Anna"}
    playing = {"title": "reveal", "phase": "playing"}
    assert sent(feedback, state(stopped=True, holder="Anna", move=playing), 0.02) == {
        "/teleop/playing": 1,
        "/teleop/move": "reveal",
    }
    later = sent(feedback, state(stopped=True, holder="Anna", move={**playing, "phase": "paused"}), 1.5)
    assert later["/teleop/paused"] == 1
    assert later["/teleop/stopped"] == 1
    feedback.again()
    assert len(sent(feedback, state(), 1.51)) == 7


def test_nothing_old_is_sent():
    feedback = Feedback()
    sent(feedback, state(), 0.0)
    assert "/teleop/axis/pan/position" not in sent(feedback, state(5.0, age=1500.0), 1.0)
    assert sent(feedback, state(5.0, age_ms=1500.0), 3.0) == {}
