"""An operator with inputs in the hand: what several devices say becomes one demand, by rules that hold for all of them.

What moves is the affair of `Arbitration`; here is what is pressed, and what overrules all motion: STOP, latched, and
the end. An input that is not trusted (see `arming`) moves nothing, but its stop always counts.

What an operator has to know is in `status`, a new immutable one each tick, so that a view may read it from another
thread.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from teleop.config.inputs_section import DRONE
from teleop.config.operator_settings import SticksSection
from teleop.config.presets import Presets
from teleop.core.axes import Axis, Limits, Motion
from teleop.core.events import Action, DeviceCommand, DialInput, TickEvent
from teleop.core.interfaces import Feedback, Source
from teleop.core.operator_input import Command, Input, Press
from teleop.core.setpoints import Demand, PositionTarget, Setpoint, Stop
from teleop.manual.arbitration import Arbitration
from teleop.manual.interlock import Interlock
from teleop.manual.recall import Recall, reachable
from teleop.manual.status import InputStatus, MessageLog, OperatorStatus

CENTRED = (Axis.PAN, Axis.TILT, Axis.ROLL)  # what a recentre takes to 0
FOLLOW = "gimbal follow "
CENTRED_STICK = PositionTarget(0.0)  # of a drone: nothing moves, but somebody is there


class Operator:
    """`inputs` in the order of their priority, `recall` in s: how long a preset takes.

    `beneath` drives the axes that no hand does, and its end is the run's; after a STOP it is taken for a hand, and
    must be seen at rest once.
    """

    def __init__(
        self,
        limits: Mapping[Axis, Limits],
        inputs: Sequence[Input],
        presets: Presets,
        sticks: SticksSection,
        recall: float,
        beneath: Source | None = None,
    ) -> None:
        self._limits, self._presets, self._sticks, self._seconds = limits, presets, sticks, recall
        self._hands = [Interlock(device) for device in inputs]
        self._driving = Arbitration(limits, self._hands, sticks, self.say)
        self._beneath = beneath
        self._motion: Motion = {}
        self._now = -math.inf
        self._range = sticks.start_range - 1
        self._stopped = self._done = False
        self._recording = False  # what the camera was asked for last
        self._filming = False  # what it has confirmed
        self.reason = ""  # that the run is stopped, for its report if it ends now
        self._hands_on = self._beneath_trusted = True
        self._dial = 0.0
        self._follow = ""
        self._actions: list[TickEvent] = []
        self._log = MessageLog()
        self._commands: Mapping[Command, Callable[[Interlock, Press], None]] = {
            Command.STOP: self._stop,
            Command.CLEAR: self._clear,
            Command.ENABLE: self._enable,
            Command.SLOWER: lambda _hand, _press: self._set_range(max(self._range - 1, 0)),
            Command.FASTER: lambda _hand, _press: self._set_range(min(self._range + 1, len(sticks.ranges) - 1)),
            Command.RANGE: lambda _hand, _press: self._set_range((self._range + 1) % len(sticks.ranges)),
            Command.RECALL: self._recall_preset,
            Command.STORE: self._store,
            Command.DELETE: self._delete,
            Command.RECENTER: self._recenter,
            Command.RECORD: self._record,
            Command.SHUTTER: lambda _hand, _press: self._actions.append(Action.SHUTTER),
            Command.TELL: self._tell,
            Command.ENGAGE: lambda _hand, _press: self._tell_drone("engage"),
            Command.DISENGAGE: lambda _hand, _press: self._tell_drone("disengage"),
            Command.QUIT: self._quit,
        }
        self.begin = math.inf  # when the run begins, on the loop's clock
        self.status = self._look()

    def start(self, now: float, motion: Motion) -> None:
        self._now = self.begin = now
        self._motion = motion
        if self._beneath:
            self._beneath.start(now, motion)

    def say(self, text: str) -> None:
        """Tell the operator something, now."""
        self._log.say(self._now, text)

    def confirmed(self, words: str) -> None:
        """The gimbal has done what it was told in these words."""
        if words.startswith(FOLLOW):
            self._follow = words.removeprefix(FOLLOW)

    def camera_answered(self, action: Action, done: bool) -> None:
        """The camera has done this, or it did not: it refused, is silent, or there is none."""
        if action is Action.RECORD:
            self._filming = done
            self._recording = self._recording and done
        elif action is Action.STOP and done:
            self._filming = False
        elif action is Action.STOP:
            self._recording = self._filming  # the next press asks it to stop once more

    def read(self, now: float, feedback: Feedback) -> tuple[Demand, Sequence[TickEvent]]:
        self._motion = feedback.motion
        seconds, self._now, self._actions = now - self._now, now, []
        presses = [(hand, press) for hand in self._hands for press in hand.read(now, self._hands_on).presses]
        notes = [note for hand in self._hands for note in hand.said.notes]
        for text in (*self._log.changes(self._hands, self._driving.drivers), *notes, *self._presets.heard()):
            self.say(text)
        for hand, press in sorted(presses, key=_last_word):
            self._commands.get(press.command, self._refuse)(hand, press)
        beneath = self._read_beneath(now, feedback)
        if self._stopped or self._done:
            demand: dict[Axis, Setpoint] = {axis: Stop() for axis in self._motion}
            self._driving.let_go()
        else:
            share = self._sticks.speed * self._sticks.ranges[self._range]
            demand = {**beneath, **self._driving.wishes(now, seconds, self._motion, share)}
        self._turn_dial()
        self.status = self._look()
        return demand, self._actions

    def next_change(self, now: float) -> float:
        return math.inf if self._done else now

    def _read_beneath(self, now: float, feedback: Feedback) -> Demand:
        if self._beneath is None:
            return {}
        demand, actions = self._beneath.read(now, feedback)
        self._actions += actions
        self._done = self._done or math.isinf(self._beneath.next_change(now))
        rests = all(wish == CENTRED_STICK for wish in demand.values())
        self._beneath_trusted = not self._stopped and (self._beneath_trusted or rests)
        return demand if self._beneath_trusted else {}

    def _turn_dial(self) -> None:
        """The gimbal's own dial, said each tick while it turns and once when it rests."""
        turning = [hand.said.dial for hand in self._hands if hand.trusted and hand.said.dial]
        speed = turning[0] if turning and not self._stopped and not self._done else 0.0
        if speed or self._dial:
            self._actions.append(DialInput(speed))
        self._dial = speed

    @property
    def _moving(self) -> bool:
        moved = (state for axis, state in self._motion.items() if not axis.is_stick)
        return any(state.velocity or state.acceleration for state in moved)

    def _stop(self, hand: Interlock, _press: Press) -> None:
        if not self._stopped:
            self.say(f"STOP by {hand.name}. Press c to clear, then center all sticks.")
            self.reason = f"ended while stopped: STOP by {hand.name}"
        self._stopped = True
        self._distrust_all()

    def _clear(self, _hand: Interlock, _press: Press) -> None:
        if self._stopped:
            self.say("STOP cleared: center all sticks")
            self._stopped, self.reason = False, ""
            self._distrust_all()

    def _enable(self, _hand: Interlock, _press: Press) -> None:
        self._hands_on = not self._hands_on
        self.say(
            "manual control on" if self._hands_on else "manual control off: inputs without an enable button are locked"
        )
        for hand in self._hands:
            if hand.said.enabled is None:
                hand.distrust()

    def _distrust_all(self) -> None:
        for hand in self._hands:
            hand.distrust()

    def _set_range(self, index: int) -> None:
        self._range = index
        self.say(f"speed range {index + 1}: {self._sticks.ranges[index]:.0%}")

    def _recall_preset(self, hand: Interlock, press: Press) -> None:
        preset = self._presets.get(press.number)
        if preset is None:
            self.say(f"there is no preset {press.number} yet")
            return
        known = {axis: to for axis, to in preset.positions.items() if axis in self._limits and not axis.is_stick}
        self._send(hand, f"preset {press.number}", known)

    def _recenter(self, hand: Interlock, _press: Press) -> None:
        self._send(hand, "recenter", {axis: 0.0 for axis in CENTRED if axis in self._limits})

    def _send(self, hand: Interlock, title: str, positions: Mapping[Axis, float]) -> None:
        """Begin to take the axes somewhere, if the hand that asks may."""
        held = [each.said.deflections for each in self._hands if each.trusted]
        deflected = any(value for said in held for axis, value in said.items() if not axis.is_stick)
        refusal = "STOP is not cleared" if self._stopped else hand.waits_for
        refusal = refusal or ("release the stick first" if deflected else "")
        if refusal:
            self.say(f"{title} refused: {refusal}")
        elif not positions:
            self.say(f"{title} has no axis of this rig")
        else:
            here = {axis: self._motion[axis].position for axis in positions}
            targets = {axis: reachable(to, self._limits[axis], here[axis]) for axis, to in positions.items()}
            self._driving.begin(Recall(title, hand, targets, self._now, self._seconds))
            self.say(f"{title} in {self._seconds:g} s")

    def _store(self, _hand: Interlock, press: Press) -> None:
        where = {axis: state.position for axis, state in self._motion.items() if not axis.is_stick}
        self._presets.store(press.number, where)
        self.say(f"preset {press.number} stored")

    def _delete(self, _hand: Interlock, press: Press) -> None:
        known = self._presets.delete(press.number)
        self.say(f"preset {press.number} deleted" if known else f"there is no preset {press.number}")

    def _record(self, _hand: Interlock, _press: Press) -> None:
        self._recording = not self._recording
        self._actions.append(Action.RECORD if self._recording else Action.STOP)

    def _tell_drone(self, word: str) -> None:
        if word == "engage" and self._stopped:
            self.say("drone: not engaged: STOP is not cleared")
        else:
            self._actions.append(DeviceCommand(f"{DRONE}{word}"))

    def _tell(self, _hand: Interlock, press: Press) -> None:
        if press.words.startswith(DRONE):
            self._tell_drone(press.words.removeprefix(DRONE).strip())
        elif self._moving:
            self.say(f"{press.words} refused: an axis is moving")
        else:
            self._actions.append(DeviceCommand(press.words))

    def _refuse(self, _hand: Interlock, press: Press) -> None:
        self.say(f"{press.command}: works only while a sequence plays")

    def _quit(self, _hand: Interlock, _press: Press) -> None:
        self._done = True
        if self._recording:
            self._recording = False
            self._actions.append(Action.STOP)

    def _look(self) -> OperatorStatus:
        recall = self._driving.recall
        hands = [
            InputStatus(
                hand.name,
                [axis for axis, driver in self._driving.drivers.items() if driver is hand],
                hand.waits_for,
                hand.said.trouble,
            )
            for hand in self._hands
        ]
        return OperatorStatus(
            hands,
            self._sticks.ranges,
            self._range,
            self._stopped,
            self._hands_on,
            recall.title if recall else "",
            recall.end if recall else 0.0,
            self._filming,
            self._follow,
            self._driving.deflections,
            self._presets.names,
            self._log.messages,
        )


def _last_word(pressed: tuple[Interlock, Press]) -> bool:
    """Sorts a stop behind whatever else was pressed in the same tick: a clear among it must not undo it."""
    return pressed[1].command is Command.STOP
