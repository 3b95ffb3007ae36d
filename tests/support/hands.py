"""Inputs without devices: a hand that holds what a test says, and an operator with such hands on a planner or a rig."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from teleop.config.operator_settings import SticksSection
from teleop.config.presets import Presets
from teleop.core.axes import Axis, Limits, Motion, Reading, State
from teleop.core.events import DeviceCommand, SourceEvent
from teleop.core.interfaces import Feedback, Source
from teleop.core.operator_input import Command, Held, Press
from teleop.core.setpoints import Demand
from teleop.core.timing import PERIOD
from teleop.manual.operator import Operator
from teleop.manual.status import OperatorStatus
from teleop.manual.target_marks import TargetMarks
from teleop.planner.live import Live

LIMITS = {
    Axis.PAN: Limits(-180, 180, 120, 240, 1200),
    Axis.TILT: Limits(-56, 146, 90, 180, 900),
    Axis.FOCUS: Limits(0, 1, 0.5, 2, 10),
}


class FakeInput:
    """Holds `held` until it is changed; presses and steps are said once."""

    def __init__(self, name: str = "pad", enabled: bool | None = None) -> None:
        self.name = name
        self.enabled = enabled
        self.deflections: dict[Axis, float] = {}
        self.dial = 0.0
        self.trouble = ""
        self.positions: dict[Axis, float] = {}
        self.notes: list[str] = []  # said once
        self.stop: str | None = None
        self.click: dict[Axis, float] = {}
        self._presses: list[Press] = []
        self._steps: dict[Axis, float] = {}

    def hold(self, **deflections: float) -> None:
        self.deflections = {Axis(axis): deflection for axis, deflection in deflections.items()}

    def press(self, command: Command, number: int = 0, device_command: DeviceCommand | None = None) -> None:
        self._presses.append(Press(command, number, device_command))

    def turn(self, axis: Axis, units: float) -> None:
        self._steps[axis] = self._steps.get(axis, 0.0) + units

    def read(self, now: float) -> Held:
        presses, self._presses = self._presses, []
        steps, self._steps = self._steps, {}
        notes, self.notes = self.notes, []
        held = dict(self.deflections)
        places = dict(self.positions)
        return Held(
            held, steps, self.dial, presses, self.enabled, self.trouble, places, notes, dict(self.click), self.stop
        )


class Desk:
    """An operator whose demands a planner carries out, tick by tick, as the loop would."""

    def __init__(
        self,
        file: Path,
        *inputs: FakeInput,
        beneath: Source | None = None,
        limits: Mapping[Axis, Limits] = LIMITS,
        presets: Presets | None = None,
        marks: TargetMarks | None = None,
        **sticks: object,
    ) -> None:
        self.inputs = inputs or (FakeInput(),)
        self.limits = limits
        self.presets = presets or Presets(file)
        shaping = SticksSection.model_validate(sticks)
        self.operator = Operator(limits, self.inputs, self.presets, shaping, 3.0, beneath, marks)
        self.readings: Mapping[Axis, Reading] = {}
        self.planner = Live(limits, PERIOD)
        self.motion: Motion = {axis: State(max(0.0, of.minimum)) for axis, of in limits.items()}
        self.planner.reset(self.motion)
        self.now = 10.0
        self.demand: Demand = {}
        self.actions: list[SourceEvent] = []
        self.history: list[Motion] = []
        self.operator.start(self.now, self.motion)

    @property
    def pad(self) -> FakeInput:
        return self.inputs[0]

    @property
    def status(self) -> OperatorStatus:
        return self.operator.status

    @property
    def messages(self) -> Sequence[str]:
        return [message.text for message in self.operator.status.messages]

    def tick(self, ticks: int = 1) -> None:
        for _ in range(ticks):
            self.now += PERIOD
            self.demand, actions = self.operator.read(self.now, Feedback(self.motion, self.readings))
            self.actions += actions
            self.motion = self.planner.step(self.demand)
            self.history.append(self.motion)

    def run(self, seconds: float) -> None:
        self.tick(round(seconds / PERIOD))

    def press(self, command: Command, number: int = 0, device_command: DeviceCommand | None = None) -> None:
        """On the first input, and the tick in which it counts."""
        self.pad.press(command, number, device_command)
        self.tick()

    def velocity(self, axis: Axis) -> float:
        return self.motion[axis].velocity

    @property
    def rests(self) -> bool:
        return all(state.velocity == 0 and state.acceleration == 0 for state in self.motion.values())
