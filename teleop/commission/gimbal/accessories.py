"""What hangs on the gimbal: the focus motor and the camera."""

from __future__ import annotations

from teleop.commission.findings import Findings, Subject
from teleop.commission.gimbal.base import GimbalStep, answered
from teleop.commission.gimbal.motion import answer, wait
from teleop.commission.step import Question, Script
from teleop.dji.gimbal import camera, focus
from teleop.dji.gimbal.camera import CameraCommand, CameraState
from teleop.dji.gimbal.focus import EndpointState

COUNTS, SMALL = 4095, 200  # from end to end, and how far the motor is turned (5 %)
FOCUS = Subject("focus.present", "A focus motor answers (0E 12)", True)
CALIBRATED = Subject("focus.calibrated", "The focus motor is calibrated", True)
FOCUS_MOVES = Subject("focus.moves", "The focus motor goes where it is sent", True)
DIRECTION = Subject("focus.direction", "A higher position focuses", "further away")
ZERO = Subject("focus.zero", "The focus motor goes to position 0", True)
STATUS = Subject("camera.status", "The camera says whether it records (0D 01)", True)
RECORD = Subject("camera.record", "Record starts a recording (0D 00)", True)
STOPS = Subject("camera.stop", "Stop ends it", True)
SHUTTER = Subject("camera.shutter", "The shutter is released", True)


class FocusStep(GimbalStep):
    """Turns the lens by 5 % and back, and where the operator agrees to its near end and back."""

    key, title = "focus", "Focus motor"
    about = (
        "The focus motor is asked for its state. If there is one that is calibrated, it",
        "turns the lens by 5 % of its way and back. You are asked which way it focused.",
    )
    subjects = (FOCUS, CALIBRATED, FOCUS_MOVES, DIRECTION, ZERO)

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        reply = yield from answer(self.bench, focus.Get())
        rest = (CALIBRATED, FOCUS_MOVES, DIRECTION, ZERO)
        if not isinstance(reply, focus.GetReply) or reply.return_code:
            code = getattr(reply, "return_code", None)
            return [
                FOCUS.found(False, answered(code, "no answer")),
                *(each.not_seen("there is no focus motor") for each in rest),
            ]
        facts = [FOCUS.found(True, f"it is at {reply.position}")]
        if reply.calibration != EndpointState.CALIBRATED:
            facts.append(CALIBRATED.found(False, f"state {int(reply.calibration)}"))
            return [*facts, *(each.not_seen("calibrate it on the gimbal first") for each in rest[1:])]
        facts.append(CALIBRATED.found(True, f"state {int(reply.calibration)}"))
        return [*facts, *(yield from self._turned(reply.position))]

    def _turned(self, begin: int) -> Script:
        way = SMALL if begin + SMALL <= COUNTS else -SMALL
        there = yield from self._go(begin + way)
        moves = abs(there - begin - way) <= SMALL // 4
        facts = [FOCUS_MOVES.found(moves, f"sent from {begin} to {begin + way}, it is at {there}")]
        if not moves:
            return [*facts, *(each.not_seen("it does not go where it is sent") for each in (DIRECTION, ZERO))]
        seen = yield Question("Which way did it focus?", {"f": "further away", "c": "closer", "u": "could not see"})
        yield from self._go(begin)
        if seen == "u":
            facts.append(DIRECTION.not_seen("the operator could not see"))
        else:
            further = (seen == "f") == (way > 0)
            facts.append(DIRECTION.found("further away" if further else "closer", "the operator saw it"))
        return [*facts, *(yield from self._to_zero(begin))]

    def _to_zero(self, begin: int) -> Script:
        text = "May it turn to its near end and back? Some motors ignore position 0."
        if (yield Question(text, {"y": "yes", "n": "no"})) != "y":
            return [ZERO.not_seen("the operator did not agree")]
        at = yield from self._go(0)
        yield from self._go(begin)
        return [ZERO.found(at < 20, f"sent to 0, it is at {at}")]

    def _go(self, position: int):
        """Where the motor is once it had the time to get there."""
        bench = self.bench
        bench.stream(focus.Set(position))
        at = -1
        for _ in range(10):
            yield from wait(bench, 0.4, f"the focus motor goes to {position}")
            reply = yield from answer(bench, focus.Get())
            before, at = at, reply.position if isinstance(reply, focus.GetReply) else at
            if before == at:
                break
        return at


class CameraStep(GimbalStep):
    """Records for two seconds, and releases the shutter once."""

    key, title = "camera", "Camera"
    about = (
        "The camera records for 2 s, and stops; then its shutter is released once.",
        "What it answers is noted, and you are asked what it did.",
    )
    subjects = (STATUS, RECORD, STOPS, SHUTTER)

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        bench = self.bench
        code = yield from self._order(CameraCommand.RECORD)
        yield from wait(bench, 2.0, "recording")
        during = yield from answer(bench, camera.Status())
        stopped = yield from self._order(CameraCommand.STOP)
        yield from wait(bench, 1.0, "stopped")
        after = yield from answer(bench, camera.Status())
        states = [int(each.state) if isinstance(each, camera.StatusReply) else None for each in (during, after)]
        how = f"record {_code(code)}, stop {_code(stopped)}; status {states[0]} while it records, {states[1]} after"
        tells = states == [CameraState.RECORDING, CameraState.IDLE]
        facts = [STATUS.found(tells, how) if states[0] is not None else STATUS.not_seen("it does not answer")]
        recorded = yield Question("Did the camera record, and stop?", {"y": "yes", "n": "no"})
        facts += [RECORD.found(recorded == "y", how), STOPS.found(recorded == "y", how)]
        released = yield from self._order(CameraCommand.SHUTTER)
        yield from wait(bench, 0.5, "shutter")
        yield from self._order(CameraCommand.STOP_SHUTTER)
        took = yield Question("Did it take a photo?", {"y": "yes", "n": "no, or it makes films only"})
        return [*facts, SHUTTER.found(took == "y", f"shutter {_code(released)}; the operator saw it")]

    def _order(self, command: CameraCommand):
        reply = yield from answer(self.bench, camera.Command(command), tries=1)  # a second one is another photo
        return getattr(reply, "return_code", None)


def _code(code: int | None) -> str:
    return "not answered" if code is None else f"answered {int(code):#04x}"
