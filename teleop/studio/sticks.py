"""A joystick and keys of this machine on a distant rig: a stream of deflections, under the dead man of its door.

The rig judges by its own clock how old the newest message is. So nothing is sent that the hand does not do just now: a
stick at rest is three zeros and then silence, a device in trouble is at rest.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from time import monotonic
from types import TracebackType
from typing import Any, Self

from teleop.core.axes import Axis
from teleop.core.errors import TeleopError
from teleop.core.operator_input import Command, Held, Input, Press
from teleop.studio.fleet import Fleet
from teleop.studio.stopping import stop

PERIOD = 0.02  # s between two messages while a stick is deflected
ZEROS = 3  # messages of a stick that was released
JOG = 0.3  # s in which a step of a key is made
SIMPLE: Mapping[Command, str] = {
    Command.CLEAR: "clear",
    Command.RECENTER: "recenter",
    Command.SHUTTER: "shutter",
    Command.ENABLE: "take_control",
}
NUMBERED: Mapping[Command, str] = {
    Command.RECALL: "preset_recall",
    Command.STORE: "preset_store",
    Command.DELETE: "preset_delete",
}


class RigSticks:
    """The rig called `name`; `inputs` are read at each `turn`, and `notify` takes lines for the operator."""

    def __init__(self, fleet: Fleet, name: str, inputs: Sequence[Input], notify: Callable[[str], object]) -> None:
        self._fleet, self._name, self._inputs, self._notify = fleet, name, inputs, notify
        self._rig = fleet.rig(name)
        self._seq, self._zeros = 0, ZEROS  # zeros still to send
        self._axes: set[Axis] = set()  # that the stick has moved
        self._send: Callable[[dict[str, Any]], None] | None = None
        self._commands = ThreadPoolExecutor(2, thread_name_prefix="sticks")
        self._stopping = ThreadPoolExecutor(1, thread_name_prefix="stop")
        self.over = False  # the operator has ended it

    def __enter__(self) -> Self:
        """Take control. Raises TeleopError where another one has it or the rig is not there."""
        if self._rig.link is None or not self._rig.alive:
            raise TeleopError(f"{self._name} is not there")
        answer = self._fleet.command(self._name, {"do": "take_control"})
        if "error" in answer:
            raise TeleopError(f"{self._name}: {answer['error']}")
        self._send = self._rig.link.stick(self._name)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """The stick is released, and control with it."""
        with suppress(TeleopError):
            for _ in range(ZEROS):
                self._put({})
        self._commands.shutdown(cancel_futures=True)
        self._stopping.shutdown()
        self._fleet.left(self._name)

    def turn(self) -> float:
        """Read the inputs and send what they say; when to call it next, on the monotonic clock."""
        now = monotonic()
        deflections: dict[Axis, float] = {}
        at_rest = True
        for each in self._inputs:
            held = each.read(now)
            for press in held.presses:
                self._press(press)
            self._step(held)
            usable = not held.trouble and held.enabled is not False
            at_rest = at_rest and (not held.deflected or not usable)
            for axis, value in held.deflections.items() if usable else ():
                deflections[axis] = max(-1.0, min(1.0, deflections.get(axis, 0.0) + value))
        if any(deflections.values()):
            self._zeros = ZEROS
            self._put(deflections)
        elif at_rest and self._zeros:
            self._zeros -= 1
            self._put({})
        return now + PERIOD

    @property
    def waits_for(self) -> str:
        """What the rig waits for before the stick moves it, "" for nothing."""
        return str((self._rig.state.get("sticks") or {}).get("waits_for") or "")

    def _put(self, deflections: Mapping[Axis, float]) -> None:
        if self._send is None:
            return
        self._axes |= set(deflections)
        axes = {axis.value: round(deflections.get(axis, 0.0), 5) for axis in self._axes or {Axis.PAN}}
        self._seq += 1
        self._send({"session": self._fleet.session, "seq": self._seq, "time": monotonic() * 1000, "axes": axes})

    def _step(self, held: Held) -> None:
        for axis, units in held.steps.items():
            self._do({"do": "jog", "axis": axis.value, "by": units, "within": JOG})

    def _press(self, press: Press) -> None:
        command = press.command
        if command is Command.QUIT:
            self.over = True
        elif command is Command.STOP:
            self._stopping.submit(self._stop)
        elif command is Command.RECORD:
            self._do({"do": "stop_recording" if self._rig.state.get("recording") else "record"})
        elif command in NUMBERED:
            self._do({"do": NUMBERED[command], "number": press.number})
        elif command in (Command.SLOWER, Command.FASTER, Command.RANGE):
            self._do({"do": "range", "number": self._range(command)})
        elif command in SIMPLE:
            if command is Command.ENABLE:
                self._zeros = ZEROS
            self._do({"do": SIMPLE[command]})
        else:
            self._notify(f"{command.value}: only at the rig itself")

    def _range(self, command: Command) -> int:
        known, number = len(self._rig.state.get("ranges") or [1]), int(self._rig.state.get("range") or 1)
        if command is Command.RANGE:
            return number % known + 1
        return max(1, min(known, number + (1 if command is Command.FASTER else -1)))

    def _do(self, message: dict[str, Any]) -> None:
        self._commands.submit(self._ask, message)

    def _ask(self, message: dict[str, Any]) -> None:
        answer = self._fleet.command(self._name, message)
        if "error" in answer:
            self._notify(f"{message['do']}: {answer['error']}")

    def _stop(self) -> None:
        if stop(self._fleet, [self._name]):
            self._notify(f"{self._name} NOT REACHED: its state does not show the STOP; switch it off")
