"""What clients have the operator do beside moving the rig: presets, marks of the focus, the terminal's other keys."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from teleop.config.device_commands import DRONE, DRONE_COMMANDS
from teleop.config.presets import Presets
from teleop.core.axes import Axis, Limits, Motion
from teleop.core.events import DeviceCommand
from teleop.core.operator_input import Command
from teleop.manual.operator import TARGET, Operator
from teleop.remote.asked import Asked, Refusal
from teleop.remote.desk import Desk

Go = Callable[[str, Asked, dict[Axis, float], float | None], None]
SWITCHED = {True: 1, False: 2}  # `Press.number` of what turns manual control on or off
DRONE_PRESSES: Mapping[str, Command] = {"engage": Command.ENGAGE, "disengage": Command.DISENGAGE}


class OperatorActions:
    """`go` takes axes somewhere, in so many s (`recall` of them for a preset); `motion` is where they are."""

    def __init__(self, limits: Mapping[Axis, Limits], recall: float, go: Go, motion: Callable[[], Motion]) -> None:
        self._limits, self._seconds, self._go, self._motion = limits, recall, go, motion
        self.operator: Operator
        self.presets: Presets
        self.desk: Desk
        self.do: Mapping[str, Callable[[Asked, float], None]] = {
            "preset_recall": self._recall,
            "preset_store": self._store,
            "preset_delete": self._delete,
            "focus_mark_recall": self._recall_mark,
            "focus_mark_store": self._store_mark,
            "focus_mark_delete": self._delete_mark,
            "range": self._range,
            "manual": self._manual,
            "drone": self._drone,
            "mark_target": self._mark_target,
        }

    # --- presets and marks

    def _recall(self, asked: Asked, now: float) -> None:  # noqa: ARG002 - every action gets it
        preset = self.presets.get(asked["number"])
        if preset is None:
            raise Refusal(f"there is no preset {asked['number']} yet")
        known = {axis: to for axis, to in preset.positions.items() if axis in self._limits and not axis.is_stick}
        self._go(f"preset {asked['number']}", asked, self._cut(known), asked.get("seconds", self._seconds))

    def _store(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        where = {axis: state.position for axis, state in self._motion().items() if not axis.is_stick}
        self.presets.store(asked["number"], where, asked.get("name"))
        self._done(asked, f"preset {asked['number']} stored")

    def _delete(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        if not self.presets.delete(asked["number"]):
            raise Refusal(f"there is no preset {asked['number']}")
        self._done(asked, f"preset {asked['number']} deleted")

    def _recall_mark(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        position = self.presets.marks.get(asked["name"])
        if position is None:
            raise Refusal(f"there is no focus mark {asked['name']} yet")
        self._go(f"focus mark {asked['name']}", asked, self._cut({Axis.FOCUS: position}), asked.get("seconds"))

    def _store_mark(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        focus = self._motion().get(Axis.FOCUS)
        if focus is None:
            raise Refusal("this rig has no focus")
        self.presets.mark(asked["name"], focus.position)
        self._done(asked, f"focus mark {asked['name']} set at {focus.position:.3f}")

    def _delete_mark(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        if asked["name"] not in self.presets.marks:
            raise Refusal(f"there is no focus mark {asked['name']}")
        self.presets.mark(asked["name"], None)
        self._done(asked, f"focus mark {asked['name']} deleted")

    def _cut(self, positions: Mapping[Axis, float]) -> dict[Axis, float]:
        """Within the soft limits, which may be nearer than when it was stored."""
        limits = self._limits
        return {
            axis: min(max(to, limits[axis].minimum), limits[axis].maximum) if axis in limits else to
            for axis, to in positions.items()
        }

    def _done(self, asked: Asked, text: str) -> None:
        self.operator.notify(text)
        asked.end()

    # --- keys of the terminal

    def _range(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        ranges = len(self.operator.status.ranges)
        if asked["number"] > ranges:
            raise Refusal(f"there are {ranges} speed ranges")
        self._press(asked, Command.RANGE, asked["number"])

    def _manual(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        self._press(asked, Command.ENABLE, SWITCHED[asked["on"]])

    def _drone(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        word = asked["command"]
        if word not in DRONE_COMMANDS:
            raise Refusal(f"unknown command drone {word}; commands: {', '.join(DRONE_COMMANDS)}")
        if not any(axis.is_stick for axis in self._limits):
            raise Refusal("this rig has no drone")
        self._press(asked, DRONE_PRESSES.get(word, Command.TELL), 0, DeviceCommand(DRONE, word))

    def _mark_target(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        if not self.operator.marks_targets:
            raise Refusal("mark target: start the rig with --targets FILE")
        self._press(asked, Command.TELL, 0, DeviceCommand(TARGET, asked["text"]))

    def _press(self, asked: Asked, command: Command, number: int = 0, device: DeviceCommand | None = None) -> None:
        """What comes of it is a line for everybody."""
        self.desk.press(asked.command.name, command, number, device)
        asked.end()
