"""The camera: what is said how often when replies are lost, and what a refusal does."""

import pytest
from far_end import FarEnd

from teleop.core.errors import DeviceError
from teleop.core.events import Action, Tick
from teleop.devices.camera import CameraSink
from teleop.dji.gimbal import camera
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.camera import CameraCommand
from teleop.dji.message import Result


def run(far: FarEnd, *actions: Action) -> list[int]:
    """Half a second of ticks, the actions in the first; the commands that arrived."""
    sink = CameraSink(far.connection)
    for number in range(50):
        now = number / 100
        far.connection.poll(now)
        sink.write(Tick(now, {}, {}, actions if number == 0 else (), {}))
        far.serve(now)
    return [message.command for message in far.heard if isinstance(message, camera.Command)]


def test_each_action_is_said_once_when_it_is_answered() -> None:
    far = FarEnd()
    far.replies[camera.Command] = lambda _command: Result(0)
    assert run(far, Action.RECORD, Action.SHUTTER) == [CameraCommand.RECORD, CameraCommand.SHUTTER]


def test_recording_survives_a_lost_reply() -> None:
    far = FarEnd()
    answers = iter([None, None, Result(0)])
    far.replies[camera.Command] = lambda _command: next(answers)
    assert run(far, Action.RECORD) == [CameraCommand.RECORD] * 3


@pytest.mark.parametrize(
    ("action", "times"),
    [(Action.RECORD, 3), (Action.STOP, 3), (Action.SHUTTER, 1), (Action.FOCUS, 3), (Action.END_FOCUS, 3)],
)
def test_a_camera_that_does_not_answer_is_a_fault_and_the_shutter_is_never_said_twice(
    action: Action, times: int
) -> None:
    far = FarEnd()
    with pytest.raises(DeviceError, match=f"the camera did not answer when asked to {action}".replace("_", " ")):
        run(far, action)
    assert len([message for message in far.heard if isinstance(message, camera.Command)]) == times


def test_a_refusal_is_a_fault() -> None:
    far = FarEnd()
    far.replies[camera.Command] = lambda _command: Result(2)
    with pytest.raises(DeviceError, match=r"the camera refused to record \(return code 0x02\)"):
        run(far, Action.RECORD)


def leave(far: FarEnd, sink: CameraSink, now: float) -> float:
    """Release to its end, the other end answering; when that was."""
    again: float | None = now
    while again is not None:
        now = again
        again = sink.release(now)
        far.serve(now)
        far.push(gimbal.VersionPush(version="01.02.03.04"))  # the link itself is alive
        assert now < 10, "it never ends"
    return now


def test_a_camera_that_records_is_stopped_on_leaving_and_once() -> None:
    far = FarEnd()
    far.replies[camera.Command] = lambda _command: Result(0)
    sink = CameraSink(far.connection)
    sink.write(Tick(1.0, {}, {}, (Action.RECORD,), {}))
    far.serve(1.0)
    assert leave(far, sink, 1.01) < 1.1
    assert leave(far, sink, 2.0) == 2.0
    assert [m.command for m in far.heard if isinstance(m, camera.Command)] == [CameraCommand.RECORD, CameraCommand.STOP]


def test_one_that_was_stopped_or_never_recorded_is_left_alone() -> None:
    far = FarEnd()
    far.replies[camera.Command] = lambda _command: Result(0)
    sink = CameraSink(far.connection)
    assert sink.release(0.5) is None
    sink.write(Tick(1.0, {}, {}, (Action.RECORD,), {}))
    sink.write(Tick(1.01, {}, {}, (Action.STOP,), {}))
    far.serve(1.01)
    leave(far, sink, 1.02)
    assert len([m for m in far.heard if isinstance(m, camera.Command)]) == 2


def test_a_focus_that_is_held_is_let_go_on_leaving() -> None:
    far = FarEnd()
    far.replies[camera.Command] = lambda _command: Result(0)
    sink = CameraSink(far.connection)
    sink.write(Tick(1.0, {}, {}, (Action.FOCUS, Action.RECORD), {}))
    far.serve(1.0)
    leave(far, sink, 1.01)
    commands = [m.command for m in far.heard if isinstance(m, camera.Command)]
    assert commands[:2] == [CameraCommand.CENTER_FOCUS, CameraCommand.RECORD]
    assert sorted(commands[2:]) == [CameraCommand.STOP, CameraCommand.END_CENTER_FOCUS]


def test_a_stop_on_leaving_is_said_again_and_then_a_fault() -> None:
    far = FarEnd()
    far.replies[camera.Command] = lambda command: None if command == camera.Command(CameraCommand.STOP) else Result(0)
    sink = CameraSink(far.connection)
    sink.write(Tick(1.0, {}, {}, (Action.RECORD,), {}))
    far.serve(1.0)
    with pytest.raises(DeviceError, match="the camera did not answer when asked to stop"):
        leave(far, sink, 1.01)
    assert [m.command for m in far.heard if isinstance(m, camera.Command)].count(CameraCommand.STOP) == 3
    assert sink.release(3.0) is None
