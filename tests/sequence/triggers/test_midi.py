"""Starts by MIDI timecode through an injected port: in time at each rate, and never by what is not it."""

from contextlib import ExitStack

import mido
import pytest
from midi_sender import Port, full_frame, running

from teleop.core.errors import DeviceError, TeleopError, UsageError
from teleop.sequence.triggers import midi as midi_triggers
from teleop.sequence.triggers.midi import StartTrigger, TimecodeTrigger, open_port
from teleop.sequence.triggers.midi_timecode import RATES, Label

HOUR = {0: 86400, 1: 90000, 2: 107892, 3: 108000}
TARGET = Label(1, 0, 0, 0)


def at_the_hour(port: Port) -> TimecodeTrigger:
    trigger = TimecodeTrigger(TARGET, "", lambda: port.now, port.opened)
    trigger.open(ExitStack())
    trigger.arm(0.0)
    return trigger


def at_start(port: Port) -> StartTrigger:
    trigger = StartTrigger("Tascam", lambda: port.now, port.opened)
    trigger.open(ExitStack())
    trigger.arm(0.0)
    return trigger


@pytest.mark.parametrize("rate", range(4))
def test_it_fires_on_the_tick_at_which_the_timecode_comes(rate):
    port = Port()
    trigger = at_the_hour(port)
    assert trigger.waits_for(0.0) == "timecode 01:00:00:00; none received yet"
    fired = port.play(running(HOUR[rate] - 40, 100, rate, 1.0), trigger, 10.0)
    assert fired == pytest.approx(1.0 + 40 / RATES[rate], abs=0.011)


def test_it_fires_for_timecode_that_begins_there_and_not_for_what_is_past_it():
    port = Port()
    assert port.play(running(HOUR[1], 50, 1, 1.0), at_the_hour(port), 4.0) == pytest.approx(1.08, abs=0.02)
    port = Port()
    trigger = at_the_hour(port)
    assert port.play(running(HOUR[1] + 10, 50, 1, 1.0), trigger, 2.0) is None
    assert trigger.waits_for(port.now) == "timecode 01:00:00:00; already past"


def test_a_parked_timecode_is_not_a_start_and_a_jump_over_the_time_neither():
    port = Port()
    trigger = at_the_hour(port)
    assert port.play([(1.0, full_frame(HOUR[1], 1))], trigger, 3.0) is None
    assert trigger.waits_for(port.now).endswith("stopped")
    assert port.play(running(HOUR[1], 50, 1, 3.0), trigger, 6.0) == pytest.approx(3.08, abs=0.02)
    port = Port()
    trigger = at_the_hour(port)
    jumps = [*running(HOUR[1] - 500, 20, 1, 1.0), *running(HOUR[1] + 300, 100, 1, 1.8)]
    assert port.play(jumps, trigger, 8.0) is None


def test_what_came_before_it_was_armed_does_not_count():
    port = Port()
    trigger = at_the_hour(port)
    assert port.play(running(HOUR[1] - 4, 50, 1, 0.0), trigger, 2.0) is not None
    trigger.arm(port.now)
    assert port.play([], trigger, 4.0) is None


@pytest.mark.parametrize("kind", [at_start, at_the_hour])
@pytest.mark.parametrize("before", range(1, 9))
def test_a_start_that_began_before_it_was_armed_does_not_count(kind, before):
    """`before` of the eight quarter frames that spell the first timecode have come by then."""
    port = Port()
    trigger = kind(port)
    coming = list(running(HOUR[1], 100, 1, 1.0))
    for port.now, each in coming[:before]:
        port._listener(each)
    trigger.arm(port.now)
    assert port.play(coming[before:200], trigger, port.now + 2) is None
    port.play([], trigger, port.now + 1)
    assert port.play(running(HOUR[1], 50, 1, port.now + 1), trigger, port.now + 3) is not None


def test_a_label_that_comes_in_the_very_tick_of_arming_counts():
    port = Port()
    trigger = at_the_hour(port)
    coming = list(running(HOUR[1] - 10, 100, 1, 0.0))
    due = 10 / RATES[1] - 0.004
    played = [each for each in coming if each[0] <= due]
    for port.now, each in played:
        port._listener(each)
    trigger.arm(due)
    assert port.play(coming[len(played) :], trigger, 2.0) == pytest.approx(due, abs=0.011)


def test_a_start_is_a_start_and_timecode_that_runs_already_has_to_stop_first():
    port = Port()
    trigger = at_start(port)
    assert port.name == "Tascam"
    assert trigger.waits_for(0.0) == "MIDI timecode to start"
    noise = [(0.5, mido.Message("note_on", note=60)), (0.6, mido.Message("quarter_frame", frame_type=3))]
    assert port.play(noise, trigger, 1.0) is None
    assert port.play(running(0, 20, 3, 1.0), trigger, 2.0) == pytest.approx(1.06, abs=0.02)
    port = Port()
    trigger = at_start(port)
    coming = list(running(0, 200, 1, 0.0))
    for now, message in coming[:100]:
        port.now = now
        port._listener(message)
    trigger.arm(port.now)
    assert trigger.waits_for(port.now) == "MIDI timecode to stop and start again"
    assert port.play(coming[100:150], trigger, port.now + 0.5) is None
    assert port.play(running(9000, 20, 1, port.now), trigger, port.now + 1) is None  # a jump is no start
    assert port.play(running(0, 50, 1, 4.0), trigger, 6.0) == pytest.approx(4.07, abs=0.02)


def test_the_port_is_closed_when_the_run_is_over():
    port = Port()
    with ExitStack() as stack:
        StartTrigger("", lambda: 0.0, port.opened).open(stack)
        assert not port.closed
    assert port.closed


def test_a_computer_without_midi_is_said_before_alsa_says_it(monkeypatch):
    monkeypatch.setattr(midi_triggers, "SEQUENCER", "/dev/snd/not-here")
    monkeypatch.setattr(midi_triggers.sys, "platform", "linux")
    with pytest.raises(DeviceError, match="has no MIDI"):
        open_port("", lambda _message: None)


@pytest.mark.parametrize(
    ("names", "asked", "said"),
    [
        ([], "", "there is none"),
        (["Launchpad", "Tascam 1"], "", "there are Launchpad, Tascam 1"),
        (["Launchpad"], "Tascam", "there are Launchpad"),
    ],
)
def test_which_input_is_asked_for_when_it_is_not_clear(monkeypatch, names, asked, said):
    monkeypatch.setattr(midi_triggers.sys, "platform", "darwin")
    monkeypatch.setattr(mido, "get_input_names", lambda: names, raising=False)
    with pytest.raises(UsageError, match=said):
        open_port(asked, lambda _message: None)


def test_a_missing_extra_is_a_line_that_says_what_to_install(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "rtmidi", None)
    with pytest.raises(TeleopError, match=r"pip install 'rs-teleop\[midi\]'"):
        open_port("", lambda _message: None)
