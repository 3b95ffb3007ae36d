"""What the camera answers an operator, in a line: only what it has confirmed, and that a rig has no camera."""

from __future__ import annotations

import pytest
from far_end import FarEnd

from teleop.core.errors import DeviceError
from teleop.core.events import Action, Tick
from teleop.devices.camera import CameraSink
from teleop.devices.camera_answers import CameraAnswers
from teleop.dji.gimbal import camera
from teleop.dji.message import Result


def lines(far: FarEnd, *actions: Action, lenient: bool = False) -> list[str]:
    """What is said in half a second, the actions one after the other."""
    said: list[str] = []
    sink = CameraSink(far.connection)
    answers = CameraAnswers(sink, said.append, lenient=lenient)
    for number in range(50):
        tick = Tick(number / 100, {}, {}, actions[number // 10 : number // 10 + 1] if number % 10 == 0 else (), {})
        answers.observe(tick)
        sink.write(tick)
        far.serve(tick.time)
    return said


def test_what_was_done_is_said_once_it_is_confirmed() -> None:
    far = FarEnd()
    far.replies[camera.Command] = lambda _command: Result(0)
    said = lines(far, Action.RECORD, Action.SHUTTER, Action.STOP)
    assert said == ["camera: recording", "camera: shutter released", "camera: stopped"]


def test_a_lost_answer_is_waited_for_and_a_refusal_is_never_called_done() -> None:
    far = FarEnd()
    answers = iter([None, Result(0)])
    far.replies[camera.Command] = lambda _command: next(answers)
    assert lines(far, Action.RECORD) == ["camera: recording"]
    far = FarEnd()
    far.replies[camera.Command] = lambda _command: Result(2)
    said: list[str] = []
    with pytest.raises(DeviceError, match="refused to record"):
        said += lines(far, Action.RECORD)
    assert said == []


def test_a_rig_without_a_camera_says_so() -> None:
    said: list[str] = []
    answers = CameraAnswers(None, said.append)
    answers.observe(Tick(1.0, {}, {}, (Action.SHUTTER, Action.RECORD), {}))
    assert said == ["shutter: this rig has no camera", "record: this rig has no camera"]


def test_where_a_hand_moves_the_rig_a_camera_that_does_not_record_ends_nothing() -> None:
    far = FarEnd()
    answers = iter([Result(2), Result(0), Result(0)])
    far.replies[camera.Command] = lambda _command: next(answers)
    said = lines(far, Action.RECORD, Action.RECORD, Action.STOP, lenient=True)
    assert said == ["the camera refused to record (return code 0x02)", "camera: recording", "camera: stopped"]
    far = FarEnd()
    far.replies[camera.Command] = lambda _command: None
    assert lines(far, Action.SHUTTER, lenient=True) == ["the camera did not answer when asked to shutter"]
