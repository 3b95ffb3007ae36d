"""Whose hand set an axis off: judged by the devices' own values, without the code that is tested."""

from __future__ import annotations

from collections.abc import Sequence

from teleop.config.inputs_section import ControlSection
from teleop.core.axes import Axis, Motion
from teleop.inputs.hid.descriptor.identity import MULTI_AXIS
from teleop.inputs.hid.device import HidInput
from teleop.inputs.hid.reader import Plugged
from teleop.inputs.hid.state import Sample
from teleop.manual.status import OperatorStatus

NEAR = 0.17  # of the way to an end: a center is learned within 0.1 of the middle, and has a dead zone around it


class Oracle:
    """Sees every tick of a run of these inputs."""

    def __init__(self, inputs: Sequence[HidInput]) -> None:
        self._inputs = inputs
        self._rested: dict[Plugged, set[str]] = {}  # the controls of a device that were seen at their rest
        self._first: dict[tuple[Plugged, str], float] = {}  # where sliders and counters were first seen
        self._touched: set[tuple[Plugged, str]] = set()  # those that were elsewhere since

    def judge(self, status: OperatorStatus, before: Motion, after: Motion) -> int:
        """How many axes set off in this tick; AssertionError for one that may not have."""
        plugged = [each._reader.plugged for each in self._inputs]
        for each in plugged:
            if each is not None:
                rested = self._rested.setdefault(each, set())
                for name, _, sample in _sticks(each):
                    if self._first.setdefault((each, name), sample.value) != sample.value:
                        self._touched.add((each, name))
                rested.update(
                    name for name, section, sample in _sticks(each) if abs(_deflection(each, section, sample)) < NEAR
                )
        started = [axis for axis in after if after[axis].velocity and not any(before[axis][1:])]
        for axis in started:
            moved = [name for each in plugged if each is not None for name in self._deflected(each, axis)]
            assert moved or status.recall, f"{axis} set off without a hand: {_state(plugged)}"
        return len(started)

    def _deflected(self, plugged: Plugged, axis: Axis) -> Sequence[str]:
        return [
            name
            for name, section, sample in _sticks(plugged)
            if section.axis is axis and self._is_moved(plugged, name, section, sample)
        ]

    def _is_moved(self, plugged: Plugged, name: str, section: ControlSection, sample: Sample) -> bool:
        if sample.relative:
            return True  # a wheel says only that it was turned
        if section.by == "position" or section.value_type == "counter":
            return (plugged, name) in self._touched
        return name in self._rested[plugged] and bool(_deflection(plugged, section, sample))


def _sticks(plugged: Plugged) -> list[tuple[str, ControlSection, Sample]]:
    values = plugged.state.values
    return [
        (name, each, values[name]) for name, each in plugged.chosen.controls.items() if each.axis and name in values
    ]


def _deflection(plugged: Plugged, section: ControlSection, sample: Sample) -> float:
    """-1..1 from its rest, which of a puck is 0."""
    low, high = section.range or (sample.minimum, sample.maximum)
    if sample.null or low == high:
        return 0.0
    rest = section.rest or ("low" if (low, high) == (0, 1) else "middle")
    if rest == "middle":
        puck = plugged.state.purpose == MULTI_AXIS and low < 0 < high
        center = section.center if section.center is not None else 0 if puck else (low + high) / 2
        return (sample.value - center) / ((high - center if sample.value > center else center - low) or 1)
    return (sample.value - (low if rest == "low" else high)) / (high - low)


def _state(plugged: Sequence[Plugged | None]) -> str:
    return "; ".join(
        f"{each.info}: { {name: sample.value for name, _, sample in _sticks(each)} }" for each in plugged if each
    )
