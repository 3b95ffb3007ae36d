"""How the gimbal says where it is: noise, rate, frame, and its pushes."""

from __future__ import annotations

from statistics import pstdev

from teleop.commission.findings import Fact, Findings, Subject
from teleop.commission.gimbal.base import GimbalStep
from teleop.commission.gimbal.motion import answer, moving_part, wait
from teleop.commission.step import Script
from teleop.config.wiring import half_turn
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.enums import AngleKind

LOOKS = 1.5  # s at rest
PUSHED = 2.3  # s in which pushes are counted
REPLY_BIT = 0x20

RATE = Subject("angles.rate", "Replies with angles", None, "per s")
NOISE = Subject("angles.noise", "Noise of an angle at rest (standard deviation)", 0.0, "deg")
JOINT = Subject("angles.joint", "Joint angles can be asked for too", True)
FRAME = Subject("angles.frame", "Attitude less joint angle of yaw", None, "deg")
PUSHES = Subject("push.seen", "Pushes come once they are on", True)
PUSH_RATE = Subject("push.rate", "Rate of the pushes", None, "Hz")
PUSH_BIT = Subject("push.reply_bit", "Pushes have the reply bit", False)
PUSH_LENGTH = Subject("push.length", "Length of a push", 40, "bytes")
PUSH_OFF = Subject("push.off", "Pushes end once they are off", True)


class Readings(GimbalStep):
    """Listens to the angles at rest."""

    key, title = "readings", "The angles at rest"
    about = ("The angles are read for 1.5 s: their noise, how many arrive, and their frame.", "Nothing moves.")
    subjects = (RATE, NOISE, JOINT, FRAME)
    moves = True

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        bench, begin = self.bench, self.bench.now
        yield from wait(bench, LOOKS, "reading")
        seen = bench.since(begin)
        noise = max((pstdev(place for _, place in moving_part(seen, index)) for index in range(3)), default=0.0)
        bench.noise = noise if noise > 0.04 else 0.0
        if bench.begin is None:
            bench.mark_begin()
        how = f"{len(seen)} readings in {LOOKS:g} s"
        return [
            RATE.found(round(len(seen) / LOOKS, 1), f"{how}, asked 50 times a second"),
            NOISE.found(round(noise, 3), f"{how}, the largest of the three angles", within=0.06),
            *(yield from self._frame()),
        ]

    def _frame(self) -> Script:
        attitude = self.bench.mean()
        reply = yield from answer(self.bench, gimbal.Angles(AngleKind.JOINT))
        if not isinstance(reply, gimbal.AnglesReply) or reply.return_code or reply.kind != AngleKind.JOINT:
            why = "no answer to a question for joint angles (0E 02)"
            return [JOINT.found(False, why), FRAME.not_seen(why)]
        offset = round(half_turn(attitude[0] - reply.yaw), 1)
        how = "both kinds asked one after the other (0E 02)"
        return [JOINT.found(True, how), FRAME.found(offset, how)]


class Pushes(GimbalStep):
    """Switches the pushes on and off again."""

    key, title = "push", "Pushes of the gimbal"
    about = ("The gimbal is asked to push its angles for 2.3 s, then to end that.", "Nothing moves.")
    subjects = (PUSHES, PUSH_RATE, PUSH_BIT, PUSH_LENGTH, PUSH_OFF)

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        bench = self.bench
        bench.frames, bench.keeps_frames = [], True
        try:
            yield from answer(bench, gimbal.PushSettings(gimbal.Switch.ON))
            yield from wait(bench, PUSHED, "pushes are on")
            on = self._pushes()
            if bench.pushes_on:  # it answers no questions: without pushes nothing is known of it
                return [*self._facts(on), PUSH_OFF.not_seen("pushes stay on: questions are not answered")]
            yield from answer(bench, gimbal.PushSettings(gimbal.Switch.OFF))
            yield from wait(bench, 0.2)
            bench.frames = []
            yield from wait(bench, 1.2, "pushes are off")
            off = self._pushes()
        finally:
            bench.keeps_frames = False
        if not on:
            return [*self._facts(on), PUSH_OFF.not_seen("there are none")]
        return [*self._facts(on), PUSH_OFF.found(not off, f"{len(off)} pushes in 1.2 s after 0E 07 with 2")]

    def _pushes(self) -> list[tuple[float, int, int]]:
        """The time, the type and the length of each push's frame."""
        kinds = gimbal.Push, gimbal.ShortPush
        pushes = [(at, each.frame) for at, each in self.bench.frames if isinstance(each.message, kinds)]
        return [(at, frame.cmd_type, len(frame.encode())) for at, frame in pushes]

    def _facts(self, pushes: list[tuple[float, int, int]]) -> list[Fact]:
        if not pushes:
            none = f"none in {PUSHED:g} s"
            return [PUSHES.found(False, none), *(each.not_seen(none) for each in (PUSH_RATE, PUSH_BIT, PUSH_LENGTH))]
        how = f"{len(pushes)} pushes in {PUSHED:g} s"
        (first, kind, length), last = pushes[0], pushes[-1][0]
        rate = (len(pushes) - 1) / (last - first) if last > first else 1 / PUSHED
        return [
            PUSHES.found(True, how),
            PUSH_RATE.found(round(rate, 1), how),
            PUSH_BIT.found(bool(kind & REPLY_BIT), f"type {kind:#04x}"),
            PUSH_LENGTH.found(length, how),
        ]
