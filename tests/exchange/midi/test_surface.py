"""What a controller's messages ask for: presses, faders that are picked up, clicks, wheels with a spring."""

from __future__ import annotations

import random
from typing import Any

import mido
import pytest
from midi_bench import LIMITS, OWN, section, state

from teleop.config.exchange.midi import Control, control
from teleop.exchange.midi.feedback import Feedback
from teleop.exchange.midi.messages import clicks, light, motor, read
from teleop.exchange.midi.surface import Surface


def sent(surface: Surface, *messages: mido.Message, now: float = 0.0) -> list[Any]:
    return [surface.take(message.bytes(), now) for message in messages]


def cc(number: int, value: int, channel: int = 0) -> mido.Message:
    return mido.Message("control_change", control=number, value=value, channel=channel)


def note(number: int, velocity: int = 100) -> mido.Message:
    return mido.Message("note_on", note=number, velocity=velocity)


def test_a_button_is_pressed_once_by_a_note_or_by_a_controller_that_rises() -> None:
    surface = Surface(section(), LIMITS)
    assert sent(surface, note(2), note(2, 0), note(2)) == [{"do": "record"}, None, {"do": "record"}]
    play = {"do": "play", "move": "reveal"}
    assert sent(surface, cc(20, 127), cc(20, 100), cc(20, 0), cc(20, 64)) == [play, None, None, play]
    assert surface.stops(note(1).bytes())
    assert not surface.stops(note(1, 0).bytes())
    assert sent(surface, note(99), cc(99, 5), mido.Message("program_change", program=3)) == [None] * 3


def test_a_fader_takes_its_axis_over_only_where_the_two_meet() -> None:
    surface = Surface(section(), LIMITS)
    here = state(pan=0.0)
    for value in (20, 40, 60):  # from below: the axis is at 63.5
        sent(surface, cc(7, value), now=0.1)
        assert surface.goto(here, 0.1, OWN) is None
    sent(surface, cc(7, 66), now=0.2)
    goto = surface.goto(here, 0.2, OWN)
    assert goto is not None
    assert goto["axes"] == {"pan": pytest.approx(180 * 66 / 127 - 90)}
    sent(surface, cc(7, 127), now=0.3)
    assert surface.goto(here, 0.3, OWN) == {"do": "goto", "axes": {"pan": 90.0}}
    sent(surface, cc(7, 126), now=5.0)  # taken hold of anew, and the axis is elsewhere by now
    assert surface.goto(here, 5.0, OWN) is None
    sent(surface, cc(7, 60), now=5.1)
    assert surface.goto(here, 5.1, OWN) is not None


@pytest.mark.parametrize(
    "fields", [{"stopped": True}, {"holder_session": "anna"}, {"move": {"title": "x", "phase": "playing"}}]
)
def test_a_fader_lets_go_of_an_axis_that_is_not_its_own(fields: dict[str, Any]) -> None:
    surface = Surface(section(), LIMITS)
    sent(surface, cc(7, 64), now=0.0)
    assert surface.goto(state(), 0.0, OWN) is not None
    surface.goto(state(**fields), 0.05, OWN)
    sent(surface, cc(7, 100), now=0.1)
    assert surface.goto(state(pan=-40.0), 0.1, OWN) is None


def test_two_faders_at_a_time_send_both_axes_on_their_way() -> None:
    surface = Surface(section(), LIMITS)
    sent(surface, cc(7, 64), mido.Message("pitchwheel", channel=1, pitch=0), now=0.0)
    goto = surface.goto(state(), 0.0, OWN)
    assert goto is not None
    assert set(goto["axes"]) == {"pan", "tilt"}
    sent(surface, cc(7, 70), now=0.2)
    goto = surface.goto(state(), 0.2, OWN)
    assert goto is not None
    assert set(goto["axes"]) == {"pan", "tilt"}
    sent(surface, cc(7, 80), now=0.65)
    goto = surface.goto(state(tilt=goto["axes"]["tilt"]), 0.65, OWN)
    assert goto is not None
    assert set(goto["axes"]) == {"pan"}  # tilt has arrived


def test_a_fader_of_14_bits_is_as_fine_as_both_controllers_and_waits_for_the_second() -> None:
    surface = Surface(section(), LIMITS)
    sent(surface, cc(1, 0), cc(33, 0), now=0.0)
    assert surface.goto(state(), 0.0, OWN) is not None
    sent(surface, cc(1, 3), now=0.1)
    assert surface.goto(state(), 0.1, OWN) is None
    sent(surface, cc(33, 5), now=0.101)
    goto = surface.goto(state(), 0.101, OWN)
    assert goto is not None
    assert goto["axes"]["focus"] == pytest.approx((3 * 128 + 5) / 16383)
    sent(surface, cc(1, 4), now=0.2)  # a controller that sends no lower bits
    assert surface.goto(state(), 0.22, OWN) is not None


@pytest.mark.parametrize(("way", "back"), [("twos", 127), ("sign", 65), ("offset", 63)])
def test_a_wheel_without_ends_jogs_by_its_clicks_to_both_sides(way: str, back: int) -> None:
    forward = 65 if way == "offset" else 1
    assert (clicks(forward, way), clicks(back, way)) == (1, -1)
    surface = Surface(section(), LIMITS)
    sent(surface, cc(60, 1), cc(60, 2), cc(60, 127))
    assert surface.jogs()["tilt"]["by"] == pytest.approx(0.5)
    assert not surface.jogs()


def test_a_wheel_with_a_spring_counts_for_as_long_as_it_or_its_controller_is_heard() -> None:
    surface = Surface(section(), LIMITS)
    sent(surface, mido.Message("pitchwheel", pitch=8191), now=0.0)
    assert surface.deflections(0.2)["pan"] == 1.0
    assert surface.deflections(0.3)["pan"] == 0.0
    sent(surface, mido.Message("pitchwheel", pitch=8000), now=0.4)  # not seen in its center
    assert surface.deflections(0.41)["pan"] == 0.0
    sent(surface, mido.Message("pitchwheel", pitch=0), mido.Message("pitchwheel", pitch=-4096), now=0.5)
    for tenth in range(5, 30):
        surface.take([0xFE], tenth / 10)
        assert surface.deflections(tenth / 10)["pan"] == pytest.approx(-0.5, abs=1e-3)
    assert surface.deflections(3.4)["pan"] == 0.0


def test_lights_and_motors_say_what_goes_on_and_only_what_has_changed() -> None:
    surface = Surface(section(), LIMITS)
    feedback = Feedback(surface)
    unread = state()
    for axis in unread["axes"].values():
        axis["measured"] = None
    assert list(feedback.messages(unread, 0.0)) == []
    first = [mido.Message.from_bytes(each) for each in feedback.messages(state(pan=90.0, focus=1.0), 0.0)]
    assert mido.Message("note_off", note=1, velocity=0) in first
    assert cc(7, 127) in first
    assert first.index(cc(33, 127)) == first.index(cc(1, 127)) + 1
    assert mido.Message("pitchwheel", channel=1, pitch=0) in first
    assert list(feedback.messages(state(pan=90.0, focus=1.0), 0.1)) == []
    stopped = state(
        pan=90.0, focus=1.0, stopped=True, recording=True, range=2, move={"title": "reveal", "phase": "playing"}
    )
    lit = [mido.Message.from_bytes(each) for each in feedback.messages(stopped, 0.2)]
    assert lit == [note(1, 127), note(2, 127), cc(20, 127), note(3, 127)]
    assert len(list(feedback.messages({**stopped, "age_ms": 5000.0}, 0.3))) == 4  # a rig that hangs has no light
    sent(surface, cc(7, 5), now=1.0)
    surface.goto(state(), 1.0, OWN)
    assert all(message[:2] != (0xB0, 7) for message in feedback.messages(state(pan=-90.0), 1.2))  # a hand is on it
    assert (0xB0, 7, 0) in list(feedback.messages(state(pan=-90.0), 1.6))


def test_messages_are_those_that_mido_knows() -> None:
    for control_, share in ((Control("cc14", 3, 2), 0.37), (Control("bend", 0, 5), 1.0), (Control("cc", 9, 0), 0.5)):
        for data in motor(control_, share):
            assert mido.Message.from_bytes(data).bytes() == list(data)
            assert read(data) is not None
    assert mido.Message.from_bytes(light(Control("note", 5, 1), True)) == mido.Message(
        "note_on", channel=1, note=5, velocity=127
    )


@pytest.mark.parametrize(
    "text", ["cc", "cc 128", "cc14 32", "note", "bend 3", "cc 1 ch 0", "cc 1 ch 17", "CC 1", "cc -1"]
)
def test_a_control_that_is_none_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="must be note 60"):
        control(text)


@pytest.mark.parametrize(
    ("fields", "why"),
    [
        ({"sends": "cc 1"}, "needs one of press, position"),
        ({"sends": "cc 1", "press": "stop", "jog": "pan"}, "needs one of"),
        ({"sends": "cc 1", "speed": "pan"}, "speed needs bend"),
        ({"sends": "note 1", "position": "pan"}, "position needs cc"),
        ({"sends": "note 1", "press": "jump"}, "must be one of"),
        ({"sends": "note 1", "press": "play ../x"}, "must be one of"),
        ({"sends": "cc 1", "position": "pan", "low": 1.0, "high": 1.0}, "must differ"),
    ],
)
def test_a_control_that_makes_no_sense_is_refused(fields: dict[str, Any], why: str) -> None:
    with pytest.raises(ValueError, match=why):
        section([fields])


def test_a_controller_has_each_message_once() -> None:
    with pytest.raises(ValueError, match="is there twice"):
        section([{"sends": "cc14 1", "position": "pan"}, {"sends": "cc 33", "press": "stop"}])


def test_hostile_bytes_raise_nothing() -> None:
    rng, surface = random.Random(7), Surface(section(), LIMITS)
    for _ in range(1000):
        data = [rng.randrange(256) for _ in range(rng.choice((0, 1, 2, 3, 3, 3, 4, 9)))]
        surface.stops(data)
        surface.take(data, rng.random())
        surface.goto(state(), rng.random() * 2, OWN)
        surface.jogs()
