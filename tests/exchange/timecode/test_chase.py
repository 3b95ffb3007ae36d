"""A move that chases MIDI timecode: half a frame after two seconds of lock, within the limits, and a legal stop."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import pytest
from chase_bench import LIMITS, ChaseBench, sender
from midi_sender import RATES, quarters
from timecode.timecode import Timecode

from teleop.core.axes import Axis, Limits
from teleop.core.timing import PERIOD
from teleop.exchange.timecode.mtc import MtcDecoder
from teleop.exchange.timecode.reading import Fault, Reading, frame
from teleop.exchange.timecode.tracker import Tracker
from teleop.planner.keyframes.planner import Key

BEGIN = 4.0
HALF, LOCKED = 0.5, 2.0


def assert_within_limits(bench: ChaseBench) -> None:
    for axis, of in LIMITS.items():
        states = [point.axes[axis] for point in bench.points]
        assert max(abs(each.velocity) for each in states) <= of.velocity
        assert max(abs(each.acceleration) for each in states) <= of.acceleration
        for one, two in itertools.pairwise(states):
            assert abs(two.acceleration - one.acceleration) <= of.jerk * PERIOD * 1.001
            moved = (two.position - one.position) / PERIOD
            assert moved == pytest.approx((one.velocity + two.velocity) / 2, abs=0.01)  # nothing jumps


@pytest.mark.parametrize(("speed", "lead"), [(1.0, 0.0), (1.001, 5.0), (0.999, 0.0)])
@pytest.mark.parametrize("rate", range(4))
def test_it_is_within_half_a_frame_after_two_seconds_and_within_the_limits(
    rate: int, speed: float, lead: float
) -> None:
    fps = RATES[rate]
    lead = round(lead * fps / 2) * 2 / fps
    bench = ChaseBench()
    bench.run(16.0, sender(rate, BEGIN, 14, 0.004, speed, lead), lambda now: (now - BEGIN) * speed - lead)
    since = max(BEGIN + LOCKED, BEGIN + lead)
    chased = [point for point in bench.points if point.place is not None and since < point.time and point.code < 19]
    assert len(chased) > 600
    assert max(abs(point.place - point.code) for point in chased if point.place is not None) * fps < HALF
    assert not bench.faults
    assert_within_limits(bench)


@pytest.mark.parametrize("seconds", [2.0, 3.7])
def test_a_code_that_ends_is_a_legal_stop_on_the_path(seconds: float) -> None:
    bench = ChaseBench()
    bench.run(12.0, sender(1, BEGIN, seconds, 0.004), lambda now: now - BEGIN)
    assert bench.rests
    assert bench.source.playback.paused
    assert bench.faults[0][1] == "is lost"
    assert bench.faults[0][0] < BEGIN + seconds + 0.3
    rests = next(
        point.time
        for point in bench.points
        if point.time > BEGIN + seconds and not point.axes["pan"].velocity  # type: ignore[index]
    )
    assert rests < BEGIN + seconds + 2.5
    assert_within_limits(bench)


@pytest.mark.parametrize("told", [False, True])
@pytest.mark.parametrize("seconds", [0.9, 1.5, 2.9, 3.5, 4.7])
def test_a_move_that_rests_soon_after_the_code_has_ended_does_not_begin_anew(seconds: float, told: bool) -> None:
    """It rested before its last word of the code was too old, followed that word, and then played on for good."""
    keys = {Axis.PAN: [Key(0, 0), Key(3, 10), Key(9, -10), Key(12, 0)]}
    bench = ChaseBench(keys=keys, limits={Axis.PAN: Limits(-180, 180, 120, 240, 1200)})
    bench.told = told
    end = BEGIN + seconds
    bench.run(end + 3.0, sender(1, BEGIN, seconds, 0.004), lambda now: now - BEGIN)
    places = [point.place for point in bench.points if point.time > end + 1.5 and point.place is not None]
    assert max(places) == min(places)
    assert bench.rests


def test_it_joins_a_code_that_comes_back_and_one_that_goes_on_elsewhere() -> None:
    bench = ChaseBench()
    bench.run(9.0, sender(1, BEGIN, 3.0, 0.002), lambda now: now - BEGIN)
    again = 9.0
    bench.run(17.0, sender(1, again, 8.0, 0.002, lead=-2.0), lambda now: now - again + 2.0)
    last = bench.points[-1]
    assert last.place == pytest.approx(last.code, abs=HALF / 25)
    bench.run(18.5, iter(()), lambda now: 0.0)
    bench.run(30.0, sender(1, 18.5, 12.0, 0.002), lambda now: now - 18.5)  # back to the hour, from 10 s on
    last = bench.points[-1]
    assert last.place == pytest.approx(last.code, abs=HALF / 25)
    assert_within_limits(bench)


def test_messages_that_a_busy_computer_hears_late_are_no_other_speed() -> None:
    """Three of every twenty by 50 ms."""
    tracker = Tracker(25.0, (1, 0, 0, 0))
    for number in range(300):
        late = 0.05 if number % 20 in (17, 18, 19) else 0.0
        time, (seconds, frames) = 10.0 + number / 25, divmod(number, 25)
        tracker.take(Reading(time + late, (1, 0, seconds, frames), False, 25), time + late)
        assert not tracker.why
        reference = tracker.reference(time)
        if number > 60:
            assert reference is not None
            assert reference.at == pytest.approx(number / 25, abs=HALF / 25)
    assert tracker.locks == 1


def changed(messages: Iterator[tuple[float, bytes]], fault: str) -> Iterator[tuple[float, bytes]]:
    """What is sent, wrong from 3 s after its beginning on."""
    wrong, held = BEGIN + 3.0, []
    for time, data in messages:
        if time < wrong:
            yield time, data
        else:
            held.append((time, data))
    match fault:
        case "backwards":
            back = [data for _, data in held][::-1]
            yield from zip([time for time, _ in held], back, strict=True)
        case "repeated":
            eight = [data for _, data in held[: len(held)]]
            first = next(number for number, data in enumerate(eight) if data[1] >> 4 == 0)
            yield from ((time, eight[first + (number - first) % 8]) for number, (time, _) in enumerate(held))
        case "jumps":
            yield from sender(1, wrong, 2.0, lead=-60.0)
        case "another":
            yield from sender(3, wrong, 2.0, lead=-3.0)
        case "faster":
            yield from ((wrong + (time - wrong) / 1.04, data) for time, data in held)


@pytest.mark.parametrize(
    ("fault", "said"),
    [
        ("backwards", "runs backwards"),
        ("repeated", "stands still"),
        ("jumps", "jumps"),
        ("another", "changes its rate"),
        ("faster", "frames per second, not 25"),
    ],
)
def test_a_code_that_is_none_is_said_and_stops_the_move(fault: str, said: str) -> None:
    bench = ChaseBench()
    bench.run(BEGIN + 4.0, changed(sender(1, BEGIN, 8.0), fault), lambda now: now - BEGIN)
    assert any(said in why for _, why in bench.faults)
    bench.run(20.0, iter(()), lambda now: now - BEGIN)
    assert bench.rests
    assert_within_limits(bench)


def test_a_code_of_another_rate_than_the_profile_has_is_refused() -> None:
    for rate, whole in ((0, 24), (3, 30)):
        tracker = Tracker(25.0, (1, 0, 0, 0))
        tracker.take(Reading(0.0, (1, 0, 0, 0), False, whole), 0.0)
        assert f"counts {whole} frames in a second, not 25" in tracker.why
        bench = ChaseBench(25.0)
        bench.run(8.0, sender(rate, BEGIN, 4.0), lambda now: now - BEGIN)
        assert all(point.place is None for point in bench.points)


@pytest.mark.parametrize("rate", range(4))
def test_labels_are_the_frames_that_another_library_counts(rate: int) -> None:
    names = ("24", "25", "29.97", "30")
    whole, drop = (24, 25, 30, 30)[rate], rate == 2
    for count in (0, 1, 1799, 1800, 17981, 17982, 107891, 107892, 1_000_003):
        decoder, found = MtcDecoder(), None
        for number, message in enumerate(quarters(count, rate)):
            found = decoder.take(bytes(message.bytes()), number / 100)
        assert isinstance(found, Reading)
        assert frame(found.label, whole, drop) == count
        judge = Timecode(names[rate], frames=count + 1, force_non_drop_frame=not drop)
        assert found.label == (judge.hrs, judge.mins, judge.secs, judge.frs)


def test_hostile_quarter_frames_raise_nothing_and_lock_nothing() -> None:
    import random

    rng, decoder, tracker = random.Random(3), MtcDecoder(), Tracker(None, (1, 0, 0, 0))
    now = 0.0
    for _ in range(1000):
        now += rng.random() * 0.02
        data = [rng.choice((0xF1, 0xF1, 0xF1, rng.randrange(256))), rng.randrange(256)][: rng.choice((0, 1, 2, 2, 2))]
        found = decoder.take(data, now)
        if found is not None:
            assert isinstance(found, Reading | Fault)
            tracker.take(found, now)
        tracker.look(now)
        assert tracker.reference(now) is None
