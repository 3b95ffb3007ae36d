"""29.97 and its relatives are exact, and timecode and frames agree for a day, each frame of it."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from timecode.timecode import Timecode

from teleop.config.frame_rates import drops, exact, exact_rate, frame_of, is_dropped, shown_rate, whole_rate
from teleop.config.profile import load_profile
from teleop.config.quantities import frame_rate, seconds
from teleop.sequence.compile import load_sequence
from teleop.sequence.triggers.midi_timecode import DROP, Label
from teleop.timelapse.compile import load_timelapse

NTSC = {23.976: 24, 23.98: 24, 29.97: 30, 47.952: 48, 47.95: 48, 59.94: 60, 119.88: 120}
WHOLE = [1, 12, 24, 25, 30, 48, 50, 60, 100, 120]
DAY = 24 * 3600


def day(whole: int, dropped: int, hours: int = 24) -> Iterator[tuple[int, int, int, int]]:
    """The labels of a day, one after the other, as a clock with a rule for its numbers goes through them."""
    for hour in range(hours):
        for minute in range(60):
            for second in range(60):
                first = dropped if second == 0 and minute % 10 else 0
                for frame in range(first, whole):
                    yield hour, minute, second, frame


@pytest.mark.parametrize(("written", "whole"), NTSC.items())
def test_a_rate_is_what_is_meant(written: float, whole: int) -> None:
    rate = Fraction(whole * 1000, 1001)
    assert exact(written) == exact(float(rate)) == exact(exact_rate(written)) == rate
    assert whole_rate(written) == whole
    assert float(shown_rate(exact_rate(written))) == pytest.approx(written, abs=0.005)


@pytest.mark.parametrize("written", [*WHOLE, 12.5, 23.9, 29.9, 33.3, 59.9, 0.1, 1000])
def test_any_other_rate_is_what_is_written(written: float) -> None:
    assert exact(written) == Fraction(written)
    assert drops(written) == 0


@pytest.mark.parametrize(("written", "hours"), [(29.97, 24), (59.94, 24), (119.88, 2)])
def test_each_drop_frame_timecode_of_a_day_is_a_frame_of_its_own(written: float, hours: int) -> None:
    whole, dropped = whole_rate(written), drops(written)
    count = 0
    for label in day(whole, dropped, hours):
        if frame_of(label, whole, dropped) != count:
            raise AssertionError((label, count))
        count += 1
    frames_in_ten_minutes = {29.97: 17982, 59.94: 35964, 119.88: 71928}[written]
    assert count == hours * 6 * frames_in_ten_minutes


@pytest.mark.parametrize("written", [29.97, 59.94, 119.88])
def test_a_number_is_left_out_exactly_where_no_frame_has_it(written: float) -> None:
    whole, dropped = whole_rate(written), drops(written)
    there = set(day(whole, dropped, 1))
    for minute in range(60):
        for frame in range(whole):
            label = (0, minute, 0, frame)
            assert (label in there) is not is_dropped(minute, 0, frame, dropped)
            text = f"00:{minute:02}:00;{frame:02}"
            if label in there:
                assert seconds(text, written) == float(frame_of(label, whole, dropped) * 1001 / Fraction(whole * 1000))
            else:
                with pytest.raises(ValueError, match=f"leaves out; 00:{minute:02}:00;{dropped:02} is the next"):
                    seconds(text, written)


@pytest.mark.parametrize("written", [29.97, 59.94])
def test_a_library_counts_the_same_frames(written: float) -> None:
    """Around each minute of a day, where numbers are dropped, and frame by frame for ten minutes."""
    whole, dropped = whole_rate(written), drops(written)
    labels = [
        (hour, minute, *place)
        for hour in range(24)
        for minute in range(60)
        for place in ((0, dropped), (0, dropped + 1), (30, 7), (59, whole - 1))
    ]
    for label in [*labels, *((0, m, s, f) for h, m, s, f in day(whole, dropped, 1) if m < 10 and s % 20 == 0)]:
        hours, minutes, secs, number = label
        judge = Timecode(f"{written}", f"{hours:02}:{minutes:02}:{secs:02};{number:02}")
        assert judge.frame_number == frame_of(label, whole, dropped), label


def test_a_day_of_drop_frame_timecode_is_a_tenth_of_a_second_off_the_wall_clock() -> None:
    """86.4 ms by its definition; of 29.97 taken literally 86.4 more would come."""
    day_long = seconds("24:00:00;00", 29.97)
    assert day_long - DAY == pytest.approx(-0.0864, abs=1e-9)
    assert seconds("24:00:00;00", 59.94) == day_long
    assert seconds("23:59:59;29", 29.97) == float(Fraction(2589407 * 1001, 30000))
    assert seconds(f"{2589408}f", 29.97) == day_long
    assert Label(24, 0, 0, 0).time(DROP) == day_long
    assert seconds("24:00:00:00", 23.976) == pytest.approx(DAY * 1.001, abs=1e-9)


@given(st.sampled_from([*NTSC, *WHOLE]), st.integers(0, 20 * DAY))
def test_frames_are_seconds_and_back(written: float, count: int) -> None:
    time = seconds(f"{count}f", written)
    assert time == float(Fraction(count) / exact(written))
    assert round(time * exact(written)) == count


@given(st.integers(0, 2589407))
def test_midi_and_a_sequence_say_the_same_of_a_label(count: int) -> None:
    tens, rest = divmod(count, 17982)
    minute = max(0, (rest - 2) // 1798)
    number = count + 18 * tens + 2 * minute
    label = number // 108000, number // 1800 % 60, number // 30 % 60, number % 30
    assert frame_of(label, 30, 2) == count
    hours, minutes, secs, frame = label
    written = f"{hours:02}:{minutes:02}:{secs:02};{frame:02}"
    assert Label(*label).time(DROP) == seconds(written, 29.97) == float(Fraction(count * 1001, 30000))


def test_a_sequence_and_a_timelapse_run_at_the_exact_rate(tmp_path: Path) -> None:
    profile = load_profile("sim")
    (tmp_path / "move.yaml").write_text('fps: 23.976\nkeyframes: [{at: 0, pan: 0}, {at: "01:00:00:00", pan: 10}]\n')
    move = load_sequence(str(tmp_path / "move.yaml"), profile.limits, profile.name)
    assert move.fps == exact_rate(23.976)
    assert move.move.duration == pytest.approx(3603.6, abs=1e-9)
    (tmp_path / "lapse.yaml").write_text(
        "fps: 29.97\nkeyframes: [{at: 0, pan: 0}, {at: 29, pan: 5}]\n"
        "timelapse: {frames: 30, interval: 45f, exposure: 0.1s}\n"
    )
    lapse = load_timelapse(str(tmp_path / "lapse.yaml"), profile.limits, profile.name)
    assert lapse is not None
    assert lapse.clip == pytest.approx(1.001, abs=1e-12)
    assert lapse.slots.at(20) - lapse.slots.at(0) == pytest.approx(20 * 45 * 1001 / 30000, abs=1e-9)
    assert frame_rate(59.94) == exact_rate(59.94)
