"""A gimbal's own commands and its dial by hand: what arrives, what is refused and said, and that a dial ends at 0."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import pytest
from far_end import FarEnd
from hypothesis import given
from hypothesis import strategies as st

from teleop.core.events import DeviceCommand, DialInput, Tick, TickEvent
from teleop.devices.gimbal.commands import CommandSink, Unheard
from teleop.dji.gimbal import camera
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.enums import FollowMode
from teleop.dji.message import Result


class Bench:
    def __init__(self) -> None:
        self.far = FarEnd()
        self.said: list[str] = []
        self.done: list[DeviceCommand] = []  # what the gimbal has confirmed
        self.dials: list[tuple[float, int]] = []
        self.sink = CommandSink(self.far.connection, self.said.append, self.done.append)
        self.now = 1.0

    def tick(self, *acts: TickEvent) -> None:
        self.now += 0.01
        self.far.connection.poll(self.now)
        self.sink.write(Tick(self.now, {}, {}, acts, {}))
        self._serve()

    def _serve(self) -> None:
        self.dials += [(self.now, m.speed) for m in self.far.serve(self.now) if isinstance(m, gimbal.Dial)]

    def leave(self) -> None:
        assert self.sink.release(self.now) is None
        self._serve()


def test_words_arrive_as_the_gimbals_command_and_its_answer_is_said() -> None:
    bench = Bench()
    bench.far.replies[gimbal.Mode] = lambda _mode: Result(0)
    bench.tick(DeviceCommand("gimbal", "follow lock"))
    bench.tick(DeviceCommand("gimbal", "follow sport"))
    bench.tick()
    modes = [message.mode for message in bench.far.heard if isinstance(message, gimbal.Mode)]
    assert modes == [FollowMode.LOCK, FollowMode.SPORT]
    assert bench.said == ["gimbal follow lock: done", "gimbal follow sport: done"]
    assert bench.done == [DeviceCommand("gimbal", "follow lock"), DeviceCommand("gimbal", "follow sport")]


def test_a_refusal_and_silence_are_said_and_are_no_fault() -> None:
    bench = Bench()
    bench.far.replies[gimbal.Mode] = lambda _mode: Result(3)
    bench.tick(DeviceCommand("gimbal", "follow lock"))
    bench.tick(DeviceCommand("camera", "center focus"))
    for _ in range(20):
        bench.tick()
    assert bench.said == ["gimbal follow lock: refused (return code 0x03)", "camera center focus: no answer"]
    assert bench.done == []
    assert [type(m) for m in bench.far.heard] == [gimbal.Mode, camera.Command]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("gimbal folow lock", "unknown command gimbal folow lock; did you mean gimbal follow lock?"),
        ("gimbal recenter", "refused: it would disturb the commands of the run"),
        ("gimbal selfie", "refused: it would disturb the commands of the run"),
        ("gimbal speed yaw=10 roll=0 pitch=0", "refused: it would disturb the commands of the run"),
        ("focus set position=5", "refused: it would disturb the commands of the run"),
        ("gimbal dial speed=9999", "speed"),
    ],
)
def test_a_command_that_cannot_be_sent_is_refused_with_the_reason(words: str, said: str) -> None:
    device, name, *arguments = words.split()
    bench = Bench()
    bench.tick(DeviceCommand(device, name, tuple(arguments)))
    assert bench.far.heard == []
    assert said in bench.said[0]


@pytest.mark.parametrize(
    ("gimbal", "drone", "said"),
    [
        (True, True, []),
        (True, False, ["drone engage: this rig has no drone"]),
        (False, True, ["gimbal follow lock: this rig has no gimbal"]),
    ],
)
def test_what_is_told_to_a_device_that_is_not_there_is_said(gimbal: bool, drone: bool, said: list[str]) -> None:
    heard: list[str] = []
    Unheard(gimbal, drone, heard.append).observe(
        Tick(1.0, {}, {}, (DeviceCommand("drone", "engage"), DeviceCommand("gimbal", "follow lock")), {})
    )
    assert heard == said


@given(st.lists(st.floats(-1.5, 1.5), min_size=1, max_size=60), st.booleans())
def test_a_dial_keeps_its_rate_and_always_ends_at_zero(speeds: Sequence[float], let_go: bool) -> None:
    bench = Bench()
    for speed in speeds:
        bench.tick(DialInput(speed))
    if let_go:
        bench.tick(DialInput(0.0))
        for _ in range(3):
            bench.tick()
    bench.leave()
    bench.leave()
    assert all(-2048 <= speed <= 2048 for _, speed in bench.dials)
    moving = [time for time, speed in bench.dials if speed]
    assert all(after - before > 0.0199 for before, after in pairwise(moving))
    assert not bench.dials or bench.dials[-1][1] == 0
    assert [speed for _, speed in bench.dials].count(0) <= [round(2048 * speed) for speed in speeds].count(0) + 1


def test_a_dial_that_turns_steadily_is_said_fifty_times_a_second() -> None:
    bench = Bench()
    for _ in range(100):
        bench.tick(DialInput(0.5))
    assert len(bench.dials) == 50
    assert {speed for _, speed in bench.dials} == {1024}


def test_what_has_no_reply_is_sent_and_none_is_missed() -> None:
    bench = Bench()
    bench.tick(DeviceCommand("gimbal", "version push", ("version=01.02.03.04",)))
    for _ in range(20):
        bench.tick()
    assert gimbal.VersionPush("01.02.03.04") in bench.far.heard
    assert bench.said == ["gimbal version push version=01.02.03.04: sent; this command has no reply"]
    assert bench.far.connection.counts["lost_replies"] == 0
