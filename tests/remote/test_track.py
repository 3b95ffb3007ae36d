"""An aim that follows a tracker's stream: within the limits, as long as the stream lives, and with a hand's consent."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from remote_bench import ANNA, BOB, RemoteBench, remote_bench

from teleop.core.axes import Axis, State
from teleop.core.events import DeviceCommand
from teleop.core.operator_input import Command
from teleop.core.timing import PERIOD
from teleop.door.messages import packed
from teleop.remote.aims import AimStream

V, A, J = 60.0, 240.0, 2400.0  # of the bench's axes


class Tracker:
    """A stream of 50 aims a second while time passes on the bench."""

    def __init__(self, bench: RemoteBench, way: Callable[[float], tuple[float, float]]) -> None:
        self.bench, self.way = bench, way
        self.begin = bench.now
        self.rows: list[tuple[float, float, float, float]] = []  # time, target, commanded, speed of pan

    def run(self, seconds: float, silent: bool = False) -> None:
        for tick in range(round(seconds / PERIOD)):
            now = self.bench.now
            if tick % 2 == 0 and not silent:
                self.send(now)
            self.bench.tick()
            pan = self.bench.state["axes"]["pan"]
            time = self.bench.state["time"]
            self.rows.append((time, self.way(time - self.begin)[0], pan["commanded"], pan["speed"]))

    def send(self, now: float, source: int = 1) -> None:
        pan, tilt = self.way(now - self.begin)
        message = {"do": "aim", "id": 0, "session": "gateway", "source": source, "time": now * 1000}
        self.bench.send(packed({**message, "axes": {"pan": math.remainder(pan, 360), "tilt": tilt}}))

    def track(self, **fields: Any) -> dict:
        assert "ok" in self.bench.ask("take_control")
        self.run(0.3)
        answer = self.bench.ask("track", **fields)
        self.bench.seen[ANNA] = 0.0  # its page lives
        return answer

    def errors(self, last: float) -> list[float]:
        return [abs(target - at) for _, target, at, _ in self.rows[-round(last / PERIOD) :]]

    def assert_legal(self) -> None:
        speeds = [speed for *_, speed in self.rows]
        assert max(map(abs, speeds)) <= V * 1.0001
        assert max(abs(after - before) for before, after in pairwise(speeds)) <= A * PERIOD * 1.01


def sway(time: float) -> tuple[float, float]:
    return 30 * math.sin(time), 10 * math.cos(time)


@contextmanager
def followed(
    tmp_path: Path, way: Callable[[float], tuple[float, float]] = sway, **fields: Any
) -> Iterator[tuple[RemoteBench, Tracker]]:
    """A bench that follows the stream from now on."""
    with remote_bench(tmp_path) as bench:
        tracker = Tracker(bench, way)
        assert "ok" in tracker.track(**fields)
        yield bench, tracker


def test_a_moving_target_is_met_and_kept_within_the_limits(tmp_path):
    with followed(tmp_path) as (bench, tracker):
        tracker.run(2.0)
        tracker.run(4.0)
        assert max(tracker.errors(4.0)) < 0.1
        assert bench.state["axes"]["tilt"]["driver"] == "track"
        tracker.assert_legal()


def test_following_needs_control_and_a_stream_that_lives(tmp_path):
    with remote_bench(tmp_path) as bench:
        tracker = Tracker(bench, sway)
        tracker.run(0.3)
        assert "error" in bench.ask("track", BOB)
        bench.ask("take_control")
        assert bench.ask("track", BOB)["kind"] == "busy"
        assert bench.ask("track", source=2)["error"] == "nothing arrives from tracking source 2"
        tracker.run(0.3, silent=True)
        assert bench.ask("track")["error"] == "nothing arrives from tracking source 1"
        assert bench.rests


def test_a_stream_alone_moves_nothing(tmp_path):
    with remote_bench(tmp_path) as bench:
        Tracker(bench, sway).run(2.0)
        assert bench.at() == 0.0


def test_a_silence_of_a_quarter_second_is_a_legal_stop_and_the_stream_may_go_on(tmp_path):
    with followed(tmp_path) as (bench, tracker):
        tracker.run(2.6)
        tracker.run(0.8, silent=True)
        assert bench.rests
        tracker.run(2.0)
        assert max(tracker.errors(0.5)) < 0.1
        tracker.assert_legal()


def test_a_stream_that_ends_ends_following_and_it_has_to_be_asked_for_again(tmp_path):
    with followed(tmp_path) as (bench, tracker):
        tracker.run(2.0)
        tracker.run(1.2, silent=True)
        assert bench.rests
        where = bench.at()
        tracker.run(1.0)
        assert bench.at() == where
        assert "tracking ends: nothing has arrived from tracking source 1 for 1 s: track again" in bench.lines
        assert list(bench.ends.values())[-1]["error"].startswith("nothing has arrived")
        tracker.assert_legal()


def test_a_soft_limit_keeps_it_from_the_target_and_says_so_once(tmp_path):
    with followed(tmp_path, lambda time: (150 + 40 * math.sin(time), 0.0)) as (bench, tracker):
        tracker.run(9.0)
        assert max(at for _, _, at, _ in tracker.rows) <= 180.0
        told = [line for line in bench.lines if "beyond the soft limit of pan (180)" in line]
        assert len(told) == 2  # the target was beyond twice
        assert "track: pan has its target again" in bench.lines
        tracker.assert_legal()


def test_a_target_that_is_too_fast_is_followed_at_the_limit_and_said(tmp_path):
    with followed(tmp_path, lambda time: (0.0 if time < 2 else min(100 * (time - 2), 170.0), 0.0)) as (bench, tracker):
        tracker.run(5.5)
        assert any(line.startswith("track: pan is ") and "too fast for its limits" in line for line in bench.lines)
        assert max(tracker.errors(0.2)) < 0.1
        tracker.assert_legal()


def test_a_target_behind_the_camera_is_on_the_turn_that_the_limits_allow(tmp_path):
    with remote_bench(tmp_path) as bench:
        bench.ask("take_control")
        bench.ask("goto", axes={"pan": 170.0})
        bench.run(6)
        tracker = Tracker(bench, lambda _time: (-175.0, 0.0))  # 185 is nearer, and beyond the limit
        tracker.track()
        tracker.run(8.0)
        assert tracker.errors(0.2) == pytest.approx(20 * [0.0], abs=0.01)
        tracker.assert_legal()


def pan_by_hand(bench: RemoteBench, tracker: Tracker) -> None:
    """With the stick at the rig, which is let go again."""
    bench.pad.deflections = {Axis.PAN: 1.0}
    tracker.run(0.3)
    bench.pad.deflections = {}
    tracker.run(1.5)
    assert bench.rests


def test_the_stick_at_the_rig_outranks_it_and_ends_it(tmp_path):
    with followed(tmp_path) as (bench, tracker):
        tracker.run(1.0)
        pan_by_hand(bench, tracker)
        assert list(bench.ends.values())[-1]["error"] == "an operator moved pan"


def test_stop_ends_it_and_clear_does_not_begin_it_again(tmp_path):
    with followed(tmp_path) as (bench, tracker):
        tracker.run(1.0)
        bench.ask("stop", BOB)
        tracker.run(0.6)
        assert bench.rests
        bench.ask("clear")
        tracker.run(1.0)
        assert bench.rests
        tracker.assert_legal()


def test_abort_ends_it_legally(tmp_path):
    with followed(tmp_path) as (bench, tracker):
        tracker.run(1.0)
        assert "ok" in bench.ask("abort")
        tracker.run(0.7)
        assert bench.rests
        tracker.assert_legal()


@pytest.mark.parametrize("attended", [True, False])
def test_it_ends_when_its_console_is_gone_unless_it_is_unattended(tmp_path, attended):
    with followed(tmp_path, attended=attended) as (bench, tracker):
        tracker.run(1.0)
        bench.seen[ANNA] = 3000.0
        tracker.run(3.0)
        bench.seen[ANNA] = 3000.0
        tracker.run(1.0)
        assert bench.rests is attended


TRACKER = 'exchange: [{type: freed, listen: "127.0.0.1:40001", camera: 2, as: target}]'
NAME = "freed at 127.0.0.1:40001"


def test_the_state_has_each_source_what_is_followed_and_why_it_waits(tmp_path):
    with remote_bench(tmp_path, more=TRACKER) as bench:
        tracker = Tracker(bench, lambda time: (150 + 40 * math.sin(time), 0.0))
        assert bench.state["tracking"] == {"sources": {"1": {"name": NAME, "age_ms": None}}, "follows": None, "why": ""}
        tracker.track()
        tracker.run(1.2)
        shown = bench.state["tracking"]
        assert shown["sources"]["1"]["age_ms"] < 30
        assert (shown["follows"], shown["why"]) == (1, "pan waits at its soft limit")
        tracker.run(0.4, silent=True)
        assert bench.state["tracking"]["why"] == "nothing arrives: it waits"
        bench.ask("abort")
        tracker.run(1.2, silent=True)
        assert bench.state["tracking"]["follows"] is None
        assert bench.state["tracking"]["sources"]["1"]["age_ms"] is None


def test_a_rig_that_no_tracker_sends_to_has_none_in_its_state(tmp_path):
    with remote_bench(tmp_path) as bench:
        assert bench.state["tracking"] is None
        press(bench, 1)
        assert bench.lines[0] == "track: this rig has no tracking source: see exchange in its profile"


def press(bench, number):
    """The keys `a` and a digit, at the rig."""
    bench.pad.press(Command.TELL, number, DeviceCommand("track", str(number)))
    bench.tick(2)


def test_the_key_at_the_rig_follows_a_source_with_no_control_and_no_page_and_ends_it(tmp_path):
    with remote_bench(tmp_path, more=TRACKER) as bench:
        tracker = Tracker(bench, sway)
        press(bench, 1)
        assert bench.lines[0] == "track: nothing arrives from tracking source 1"
        tracker.run(0.3)
        press(bench, 1)
        assert bench.lines[0] == "source 1 is followed: a 0 ends it"
        tracker.run(2.0)
        assert max(tracker.errors(0.3)) < 0.1
        press(bench, 0)
        assert bench.lines[0] == "tracking ends: aborted by keys"
        tracker.run(0.7)
        assert bench.rests
        press(bench, 0)
        assert bench.lines[0] == "track: no source is followed"
        tracker.assert_legal()


def test_following_that_a_key_began_ends_by_a_stick_and_says_so(tmp_path):
    with remote_bench(tmp_path, more=TRACKER) as bench:
        tracker = Tracker(bench, sway)
        tracker.run(0.3)
        press(bench, 1)
        tracker.run(1.0)
        pan_by_hand(bench, tracker)
        assert "tracking ends: an operator moved pan" in bench.lines
        bench.ask("stop", BOB)
        press(bench, 1)
        assert "track: STOP is not cleared" in bench.lines


def test_noise_is_averaged():
    stream = AimStream()
    for index in range(20):
        stream.take(index * 0.02, {Axis.PAN: 50 * index * 0.02 + (0.05 if index % 2 else -0.05)}, index * 0.02)
    position, speed, _ = stream.at(Axis.PAN, 0.40)
    assert position == pytest.approx(20.0, abs=0.2)
    assert speed == pytest.approx(50.0, abs=3)


def test_samples_out_of_order_and_from_the_future_are_dropped():
    stream = AimStream()
    stream.take(1.0, {Axis.PAN: 10.0}, 1.0)
    stream.take(0.9, {Axis.PAN: 50.0}, 1.0)
    stream.take(5.0, {Axis.PAN: 70.0}, 1.0)
    assert stream.at(Axis.PAN, 1.0) == State(10.0)
    assert stream.fresh(1.2)
    assert not stream.fresh(1.3)
