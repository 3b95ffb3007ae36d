"""An operator's inputs: several devices become one demand, by rules that are the same for all of them.

`Arbitration` decides what moves; here are the presses, and what overrules all motion: STOP, latched, and the end. An
input that is locked (see `interlock`) moves nothing, but its STOP always works.

`status` is a new immutable value each tick, so that a view may read it from another thread.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence

from teleop.config.device_commands import DRONE
from teleop.config.operator_settings import SticksSection
from teleop.config.presets import Presets
from teleop.core.axes import Axis, Limits, Motion, Reading, moves
from teleop.core.events import Action, DeviceCommand, DialInput, SourceEvent
from teleop.core.interfaces import Feedback, Source
from teleop.core.operator_input import Command, Input, Press
from teleop.core.setpoints import Demand, PositionTarget, Setpoint, Stop
from teleop.manual.arbitration import Arbitration
from teleop.manual.interlock import Interlock
from teleop.manual.recall import Recall, reachable
from teleop.manual.status import InputStatus, MessageLog, OperatorStatus
from teleop.manual.target_marks import TargetMarks

CENTERED = (Axis.PAN, Axis.TILT, Axis.ROLL)  # what a recenter takes to 0
TRACK = "track"  # an aim follows a tracking source
UNTRACKED = "track: this rig has no tracking source: see exchange in its profile"
TARGET = "target"  # what is typed for one is told to it
FOLLOW = "follow "  # begins the name of the gimbal's command
CENTERED_STICK = PositionTarget(0.0)  # of a drone: nothing moves, and there is an input


class Operator:
    """`inputs` in the order of their priority, `recall` in s: how long a preset takes.

    `beneath` drives the axes that no input moves, and its end is the run's; after a STOP it is locked as an input is,
    until it was seen at rest. `marks` takes the targets that the operator marks.
    """

    def __init__(
        self,
        limits: Mapping[Axis, Limits],
        inputs: Sequence[Input],
        presets: Presets,
        sticks: SticksSection,
        recall: float,
        beneath: Source | None = None,
        marks: TargetMarks | None = None,
    ) -> None:
        self._limits, self._presets, self._sticks, self._seconds = limits, presets, sticks, recall
        self._locks = [Interlock(device) for device in inputs]
        self._arbitration = Arbitration(limits, self._locks, sticks, self.notify)
        self._beneath, self._marks = beneath, marks
        self._readings: Mapping[Axis, Reading] = {}
        self._motion: Motion = {}
        self._now = -math.inf
        self._range = sticks.start_range - 1
        self._stopped = self._done = False
        self._recording = False  # what the camera was asked for last
        self._filming = False  # what it has confirmed
        self.reason = ""  # that the run is stopped, for its report if it ends now
        self.stopped_by = ""  # whose STOP is not cleared
        self._manual_control = self._beneath_unlocked = True
        self._dial = 0.0
        self._follow = ""
        self._actions: list[SourceEvent] = []
        self._log = MessageLog()
        self._commands: Mapping[Command, Callable[[Interlock, Press], None]] = {
            Command.STOP: self._stop,
            Command.CLEAR: self._clear,
            Command.ENABLE: self._enable,
            Command.SLOWER: lambda _hand, _press: self._set_range(max(self._range - 1, 0)),
            Command.FASTER: lambda _hand, _press: self._set_range(min(self._range + 1, len(sticks.ranges) - 1)),
            Command.RANGE: lambda _hand, press: self._set_range(
                press.number - 1 if press.number else (self._range + 1) % len(sticks.ranges)
            ),
            Command.RECALL: self._recall_preset,
            Command.STORE: self._store,
            Command.DELETE: self._delete,
            Command.RECENTER: self._recenter,
            Command.RECORD: self._record,
            Command.SHUTTER: lambda _hand, _press: self._actions.append(Action.SHUTTER),
            Command.TELL: self._send_command,
            Command.ENGAGE: lambda _hand, _press: self._send_to_drone(DeviceCommand(DRONE, "engage")),
            Command.DISENGAGE: lambda _hand, _press: self._send_to_drone(DeviceCommand(DRONE, "disengage")),
            Command.QUIT: self._quit,
        }
        self.track: Callable[[int, float], object] = lambda _number, _now: self.notify(UNTRACKED)
        self.begin = math.inf  # when the run begins, on the loop's clock
        self.status = self._snapshot()

    def start(self, now: float, motion: Motion) -> None:
        self._now = self.begin = now
        self._motion = motion
        self._log.begin(now)
        if self._beneath:
            self._beneath.start(now, motion)

    def notify(self, text: str) -> None:
        """Tell the operator something, now."""
        self._log.notify(self._now, text)

    def confirmed(self, command: DeviceCommand) -> None:
        """The gimbal has confirmed this command."""
        if command.device == "gimbal" and command.name.startswith(FOLLOW):
            self._follow = command.name.removeprefix(FOLLOW)

    def camera_answered(self, action: Action, done: bool) -> None:
        """The camera has done this, or it did not: it refused, is silent, or there is none."""
        if action is Action.RECORD:
            self._filming = done
            self._recording = self._recording and done
        elif action is Action.STOP and done:
            self._filming = False
        elif action is Action.STOP:
            self._recording = self._filming  # the next press asks it to stop once more

    def read(self, now: float, feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:
        self._motion, self._readings = feedback.motion, feedback.readings
        seconds, self._now, self._actions = now - self._now, now, []
        presses = [(lock, press) for lock in self._locks for press in lock.read(now, self._manual_control).presses]
        notes = [note for lock in self._locks for note in lock.held.notes]
        for text in (*self._log.changes(self._locks, self._arbitration.drivers), *notes, *self._presets.new_messages()):
            self.notify(text)
        for lock, press in sorted(presses, key=_is_stop):
            self._commands.get(press.command, self._unavailable)(lock, press)
        beneath = self._read_beneath(now, feedback)
        if self._stopped or self._done:
            demand: dict[Axis, Setpoint] = {axis: Stop() for axis in self._motion}
            self._arbitration.drop_all()
        else:
            share = self._sticks.speed * self._sticks.ranges[self._range]
            demand = {**beneath, **self._arbitration.setpoints(now, seconds, self._motion, share)}
        self._turn_dial()
        self.status = self._snapshot()
        return demand, self._actions

    def next_change(self, now: float) -> float:
        return math.inf if self._done else now

    @property
    def marks_targets(self) -> bool:
        return self._marks is not None

    @property
    def taken(self) -> Collection[Axis]:
        """The axes that inputs moved in the last tick, or sent somewhere."""
        return self._arbitration.taken

    def _read_beneath(self, now: float, feedback: Feedback) -> Demand:
        if self._beneath is None:
            return {}
        demand, actions = self._beneath.read(now, feedback)
        self._actions += actions
        for action in actions:
            if action in (Action.RECORD, Action.STOP):
                self._recording = action is Action.RECORD
        self._done = self._done or math.isinf(self._beneath.next_change(now))
        rests = all(setpoint == CENTERED_STICK for setpoint in demand.values())
        self._beneath_unlocked = not self._stopped and (self._beneath_unlocked or rests)
        return demand if self._beneath_unlocked else {}

    def _turn_dial(self) -> None:
        """The gimbal's own dial: each tick while it turns, and once when it rests."""
        turning = [lock.held.dial for lock in self._locks if lock.unlocked and lock.held.dial]
        speed = turning[0] if turning and not self._stopped and not self._done else 0.0
        if speed or self._dial:
            self._actions.append(DialInput(speed))
        self._dial = speed

    def _stop(self, lock: Interlock, press: Press) -> None:
        if not self._stopped:
            name = press.by or lock.name
            self.notify(f"STOP by {name}. Press c to clear, then center all sticks.")
            self.reason, self.stopped_by = f"ended while stopped: STOP by {name}", name
        self._stopped = True
        self._relock_all()

    def _clear(self, _hand: Interlock, _press: Press) -> None:
        if self._stopped:
            self.notify("STOP cleared: center all sticks")
            self._stopped, self.reason, self.stopped_by = False, "", ""
            self._relock_all()

    def _enable(self, _hand: Interlock, press: Press) -> None:
        on = press.number == 1 if press.number else not self._manual_control
        if on == self._manual_control:
            return
        self._manual_control = on
        self.notify(
            "manual control on"
            if self._manual_control
            else "manual control off: inputs without an enable button are locked"
        )
        for lock in self._locks:
            if lock.held.enabled is None:
                lock.relock()

    def _relock_all(self) -> None:
        for lock in self._locks:
            lock.relock()

    def _set_range(self, index: int) -> None:
        self._range = index
        self.notify(f"speed range {index + 1}: {self._sticks.ranges[index]:.0%}")

    def _recall_preset(self, lock: Interlock, press: Press) -> None:
        preset = self._presets.get(press.number)
        if preset is None:
            self.notify(f"there is no preset {press.number} yet")
            return
        known = {axis: to for axis, to in preset.positions.items() if axis in self._limits and not axis.is_stick}
        self._send(lock, f"preset {press.number}", known)

    def _recenter(self, lock: Interlock, _press: Press) -> None:
        self._send(lock, "recenter", {axis: 0.0 for axis in CENTERED if axis in self._limits})

    def _send(self, lock: Interlock, title: str, positions: Mapping[Axis, float]) -> None:
        """Begin to take the axes somewhere, if the input that asks may."""
        held = [each.held.deflections for each in self._locks if each.unlocked]
        deflected = any(value for held in held for axis, value in held.items() if not axis.is_stick)
        refusal = "STOP is not cleared" if self._stopped else lock.waits_for
        refusal = refusal or ("release the stick first" if deflected else "")
        if refusal:
            self.notify(f"{title} refused: {refusal}")
        elif not positions:
            self.notify(f"{title} has no axis of this rig")
        else:
            here = {axis: self._motion[axis].position for axis in positions}
            targets = {axis: reachable(to, self._limits[axis], here[axis]) for axis, to in positions.items()}
            self._arbitration.begin(Recall(title, lock, targets, self._now, self._seconds))
            self.notify(f"{title} in {self._seconds:g} s")

    def _store(self, _hand: Interlock, press: Press) -> None:
        where = {axis: state.position for axis, state in self._motion.items() if not axis.is_stick}
        self._presets.store(press.number, where)
        self.notify(f"preset {press.number} stored")

    def _delete(self, _hand: Interlock, press: Press) -> None:
        known = self._presets.delete(press.number)
        self.notify(f"preset {press.number} deleted" if known else f"there is no preset {press.number}")

    def _record(self, _hand: Interlock, _press: Press) -> None:
        self._recording = not self._recording
        self._actions.append(Action.RECORD if self._recording else Action.STOP)

    def _send_to_drone(self, command: DeviceCommand) -> None:
        if command.name == "engage" and self._stopped:
            self.notify("drone: not engaged: STOP is not cleared")
        else:
            self._actions.append(command)

    def _send_command(self, _hand: Interlock, press: Press) -> None:
        command = press.device_command
        assert command is not None, "TELL has a command"
        if command.device == DRONE:
            self._send_to_drone(command)
        elif command.device == TARGET:
            self._mark(command.name)
        elif command.device == TRACK:
            self.track(press.number, self._now)
        elif moves(self._motion):
            self.notify(f"{command} refused: an axis is moving")
        else:
            self._actions.append(command)

    def _mark(self, typed: str) -> None:
        pan, tilt = (self._readings.get(axis) for axis in (Axis.PAN, Axis.TILT))
        if self._marks is None:
            self.notify("mark target: start teleop live with --targets FILE")
        elif pan is None or tilt is None:
            self.notify("mark target: needs a rig that measures pan and tilt")
        elif moves(self._motion):
            self.notify("mark target refused: an axis is moving")
        else:
            self.notify(self._marks.mark(typed, pan.position, tilt.position))

    def _unavailable(self, _hand: Interlock, press: Press) -> None:
        self.notify(f"{press.command}: works only while a sequence plays")

    def _quit(self, _hand: Interlock, _press: Press) -> None:
        self._done = True
        if self._recording:
            self._recording = False
            self._actions.append(Action.STOP)

    def _snapshot(self) -> OperatorStatus:
        recall = self._arbitration.recall
        locks = [
            InputStatus(
                lock.name,
                [axis for axis, driver in self._arbitration.drivers.items() if driver is lock],
                lock.waits_for,
                lock.held.trouble,
            )
            for lock in self._locks
        ]
        return OperatorStatus(
            locks,
            self._sticks.ranges,
            self._range,
            self._stopped,
            self._manual_control,
            recall.title if recall else "",
            recall.end if recall else 0.0,
            self._filming,
            self._follow,
            self._arbitration.deflections,
            self._presets.names,
            self._log.messages,
        )


def _is_stop(pressed: tuple[Interlock, Press]) -> bool:
    """Sorts a stop behind whatever else was pressed in the same tick: a clear among it must not undo it."""
    return pressed[1].command is Command.STOP
