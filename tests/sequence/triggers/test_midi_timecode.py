"""MIDI timecode as it is spelled on the wire, at its four rates, whole, damaged and backwards."""

import math

import mido
import pytest
from hypothesis import given
from hypothesis import strategies as st
from midi_sender import full_frame, label_of, quarters, running

from teleop.sequence.triggers.midi_timecode import DROP, RATES, Label, MidiTimecode

HOUR = {0: 86400, 1: 90000, 2: 107892, 3: 108000}  # frames in an hour


def feed(timecode: MidiTimecode, messages) -> None:
    for now, message in messages:
        timecode.quarter(*values(message), now)


def values(message: mido.Message) -> tuple[int, int]:
    """The piece and its four bits."""
    return message.dict()["frame_type"], message.dict()["frame_value"]


@pytest.mark.parametrize("rate", range(4))
@given(st.integers(0, 23 * 86400))
def test_a_label_is_the_time_of_its_frame(rate, count):
    assert Label(*label_of(count, rate)).time(rate) == pytest.approx(count / RATES[rate], abs=1e-6)


def test_dropped_numbers_are_those_that_smpte_drops():
    assert label_of(1799, DROP) == (0, 0, 59, 29)
    assert label_of(1800, DROP) == (0, 1, 0, 2)
    assert label_of(17982, DROP) == (0, 10, 0, 0)
    assert Label(1, 0, 0, 0).time(DROP) == pytest.approx(HOUR[DROP] / RATES[DROP])


@pytest.mark.parametrize("rate", range(4))
def test_running_timecode_is_known_after_two_frames_and_to_the_quarter_frame(rate):
    timecode = MidiTimecode()
    messages = list(running(HOUR[rate], 20, rate, 7.0))
    feed(timecode, messages[:7])
    assert math.isnan(timecode.position(7.1))
    assert not timecode.runs(7.1)
    feed(timecode, messages[7:])
    now = messages[-1][0]
    assert timecode.runs(now)
    assert timecode.position(now) == pytest.approx(HOUR[rate] / RATES[rate] + now - 7.0, abs=1e-6)
    assert timecode.starts == 1
    assert timecode.began == pytest.approx(HOUR[rate] / RATES[rate])
    assert not timecode.runs(now + 0.3)


def test_a_lost_piece_spoils_its_eight_and_the_next_are_read():
    timecode = MidiTimecode()
    messages = list(running(1000, 8, 1, 0.0))
    feed(timecode, messages[:3] + messages[4:16])
    assert timecode.starts == 1
    assert timecode.began == pytest.approx(1002 / 25)


def test_backwards_nothing_runs():
    timecode = MidiTimecode()
    for pair in range(10):
        for quarter, message in enumerate(reversed(list(quarters(1000 - 2 * pair, 1)))):
            timecode.quarter(*values(message), (8 * pair + quarter) / 100)
    assert timecode.starts == 0


def test_a_jump_while_it_runs_is_no_start_and_a_full_frame_stops_it():
    timecode = MidiTimecode()
    feed(timecode, running(0, 10, 3, 0.0))
    feed(timecode, running(900, 10, 3, 1 / 3))
    assert (timecode.starts, timecode.jumps, timecode.began) == (1, 2, 30.0)
    timecode.full(tuple(full_frame(1800, 3).dict()["data"]), 0.7)
    assert not timecode.runs(0.7)
    assert timecode.position(0.7) == timecode.position(99.0) == 60.0


messages = st.one_of(
    st.tuples(st.just("quarter"), st.integers(0, 7), st.integers(0, 15)),
    st.tuples(st.just("full"), st.lists(st.integers(0, 127), max_size=12)),
)


@given(st.lists(messages, max_size=60))
def test_whatever_comes_is_taken_or_left(said):
    timecode = MidiTimecode()
    for number, (kind, *parts) in enumerate(said):
        if kind == "quarter":
            timecode.quarter(parts[0], parts[1], number / 100)
        else:
            timecode.full(tuple(parts[0]), number / 100)
        assert not math.isinf(timecode.position(number / 100))
