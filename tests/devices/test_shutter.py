"""The shutter of a timelapse: pressed once for each frame whatever is lost, and let go on leaving."""

from __future__ import annotations

import pytest
from far_end import FarEnd

from teleop.core.events import Exposure, ShutterResult, ShutterStep, Tick
from teleop.devices.shutter import ShutterSink
from teleop.dji.gimbal import camera
from teleop.dji.gimbal.camera import CameraCommand as C
from teleop.dji.message import Result


class Bench:
    """`results` is what came of each press; the far end answers with `code`, None for not at all."""

    def __init__(self, code: int | None = 0) -> None:
        self.far = FarEnd()
        self.results: list[ShutterResult] = []
        self.code = code
        self.far.replies[camera.Command] = lambda _command: None if self.code is None else Result(self.code)
        self.sink = ShutterSink(self.far.connection, self.results.append)
        self.now = 0.0

    def shoot(self, *steps: ShutterStep, frame: int = 7) -> list[int]:
        """Each step in a tick, for less than makes a silent far end lost; the commands that arrived."""
        before = len(self.far.heard)
        for number in range(45):
            self.now += 0.01
            self.far.connection.poll(self.now)
            step = steps[number : number + 1]
            self.sink.write(Tick(self.now, {}, {}, [Exposure(frame, each) for each in step], {}))
            self.far.serve(self.now)
        return self.commands(before)

    def leave(self) -> list[int]:
        before = len(self.far.heard)
        for _ in range(100):
            again = self.sink.release(self.now)
            self.far.serve(self.now)
            if again is None:
                return self.commands(before)
            self.now = again
        raise AssertionError("it never leaves")

    def commands(self, start: int) -> list[int]:
        return [message.command for message in self.far.heard[start:] if isinstance(message, camera.Command)]


def test_a_frame_is_focused_pressed_and_let_go_each_once() -> None:
    bench = Bench()
    commands = bench.shoot(ShutterStep.FOCUS, ShutterStep.PRESS, ShutterStep.RELEASE)
    assert commands == [C.CENTER_FOCUS, C.SHUTTER, C.END_CENTER_FOCUS, C.STOP_SHUTTER]
    assert bench.results == [ShutterResult(7, 0)]
    assert bench.leave() == [], "nothing is held"


def test_without_focus_none_is_let_go() -> None:
    assert Bench().shoot(ShutterStep.PRESS, ShutterStep.RELEASE) == [C.SHUTTER, C.STOP_SHUTTER]


@pytest.mark.parametrize("code", [2, None])
def test_a_press_without_success_is_reported_and_never_repeated(code: int | None) -> None:
    """A lost reply is no lost command: a second press may be a second frame."""
    bench = Bench(code)
    assert bench.shoot(ShutterStep.PRESS) == [C.SHUTTER]
    assert bench.results == [ShutterResult(7, code)]


def test_a_lost_answer_to_focusing_repeats_nothing() -> None:
    assert Bench(None).shoot(ShutterStep.FOCUS) == [C.CENTER_FOCUS]


def test_letting_go_is_repeated_three_times_at_most() -> None:
    bench = Bench(None)
    assert bench.shoot(ShutterStep.RELEASE) == [C.STOP_SHUTTER] * 3
    assert bench.results == []


def test_leaving_lets_go_what_is_pressed_and_waits_for_the_answer_to_the_press() -> None:
    bench = Bench()
    bench.sink.write(Tick(0.0, {}, {}, [Exposure(3, ShutterStep.FOCUS), Exposure(3, ShutterStep.PRESS)], {}))
    assert set(bench.leave()) == {C.CENTER_FOCUS, C.SHUTTER, C.STOP_SHUTTER, C.END_CENTER_FOCUS}
    assert bench.results == [ShutterResult(3, 0)]
