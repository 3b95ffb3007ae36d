"""A take read back from its file into arrays, whole or cut: for a caller that needs all of it at once.

Six hours of four axes are a quarter of a gigabyte this way; what is not motion or its measurement stays in the file.
"""

from __future__ import annotations

import importlib
import json
from array import array
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from teleop.core.axes import Axis, State
from teleop.core.errors import UsageError
from teleop.planner.polynomial import Array
from teleop.recording.format import CUT, About
from teleop.recording.messages import Ending, Messages, reading_errors, was_cut
from teleop.recording.played import SAME, Mark

ActionRecord = Mapping[str, Any]


@dataclass(frozen=True, eq=False)
class Take:
    """Times are seconds from the first tick. `motion` has rows position, velocity, acceleration (3, n) at `times` (n,).

    `measured` has rows time, position (2, m). `actions` are what was done once, and when. `ending` is None for a file
    that was cut, and `remark` a line about one that is not whole, else "". `marks` say which pass of a sequence was
    played when, `plan` has rows time, position (2, k) of the sequence itself where a correction was added to it, and
    `firmware` versions by link.
    """

    path: Path
    about: About
    times: Array
    motion: Mapping[Axis, Array]
    measured: Mapping[Axis, Array]
    actions: Sequence[tuple[float, ActionRecord]]
    ending: Ending | None
    remark: str
    marks: Sequence[Mark] = ()
    plan: Mapping[Axis, Array] = field(default_factory=dict)
    firmware: Mapping[str, str] = field(default_factory=dict)

    def __repr__(self) -> str:
        title, axes = f"{self.about.title} on {self.about.rig}", ", ".join(self.axes)
        return f"Take({str(self.path)!r}: {title}, {axes}, {self.duration:.2f} s)"

    @property
    def axes(self) -> Sequence[Axis]:
        return list(self.motion)

    @property
    def duration(self) -> float:
        """Seconds from the first to the last tick."""
        return float(self.times[-1]) if len(self.times) else 0.0

    @property
    def cut(self) -> bool:
        """Whether the run went on after the last tick that is here."""
        return was_cut(self.ending)

    @property
    def ended(self) -> str:
        """How the run ended, in words."""
        return CUT if self.ending is None else str(self.ending)

    def planned(self, axis: Axis) -> Array:
        """Where the axis was to be at each tick (n,), in units: as commanded, without what a correction has added."""
        positions = self.motion[axis][0]
        if axis not in self.plan:
            return positions
        times, own = self.plan[axis]
        at = np.searchsorted(self.times, times - SAME)
        positions = positions.copy()
        positions[at[at < len(positions)]] = own[at < len(positions)]
        return positions

    def state(self, axis: Axis, index: int) -> State:
        """Where the axis was commanded to be at tick `index`."""
        return State(*self.motion[axis][:, index].tolist())

    def to_frame(self) -> Any:
        """A pandas DataFrame indexed by time (s): per axis position, velocity, acceleration and measured, in units.

        The columns are `pan`, `pan_velocity`, `pan_acceleration` and `pan_measured`; what was measured is drawn
        straight between readings, and NaN before the first and after the last. Raises UsageError without pandas.
        """
        try:
            pandas = importlib.import_module("pandas")
        except ImportError:
            raise UsageError("to_frame needs pandas: pip install pandas") from None
        columns: dict[str, Array] = {}
        for axis, (position, velocity, acceleration) in self.motion.items():
            columns |= {axis.value: position, f"{axis}_velocity": velocity, f"{axis}_acceleration": acceleration}
            if axis in self.measured:
                times, positions = self.measured[axis]
                columns[f"{axis}_measured"] = np.interp(self.times, times, positions, left=np.nan, right=np.nan)
        return pandas.DataFrame(columns, index=pandas.Index(self.times, name="time"))


def read_take(path: Path) -> Take:
    """The take in a file; raises DocumentError when it cannot be read at all, or is not a take."""
    messages = Messages(path)
    times = array("d")
    motion: dict[Axis, array[float]] = {}
    measured: dict[Axis, array[float]] = {}
    plan: dict[Axis, array[float]] = {}
    marks: list[Mark] = []
    firmware: dict[str, str] = {}
    actions: list[tuple[float, ActionRecord]] = []
    with reading_errors(path):
        for time, topic, data in messages:
            if topic == "/motion":
                content = json.loads(data)
                motion = motion or {axis: array("d") for axis in messages.about.limits}
                times.append(time)
                for axis, row in motion.items():
                    state = content[axis.value]
                    row.extend((state["position"], state["velocity"], state["acceleration"]))
            elif topic == "/measured":
                _add_positions(measured, time, json.loads(data))
            elif topic == "/plan":
                _add_positions(plan, time, json.loads(data))
            elif topic == "/passes":
                content = json.loads(data)
                marks.append(Mark(time, int(content["pass"]), float(content["time"])))
            elif topic == "/firmware":
                firmware |= json.loads(data)
            elif topic == "/actions":
                content = json.loads(data)
                actions.append((time, {"action": content["action"], **content}))
    about = messages.about
    motion = motion or {axis: array("d") for axis in about.limits}
    return Take(
        path,
        about,
        np.frombuffer(times),
        {axis: np.frombuffer(row).reshape(-1, 3).T for axis, row in motion.items()},
        {axis: np.frombuffer(row).reshape(-1, 2).T for axis, row in measured.items()},
        actions,
        messages.ending,
        messages.remark,
        marks,
        {axis: np.frombuffer(row).reshape(-1, 2).T for axis, row in plan.items()},
        firmware,
    )


def _add_positions(traces: dict[Axis, array[float]], time: float, positions: Mapping[str, float]) -> None:
    for name, position in positions.items():
        traces.setdefault(Axis(name), array("d")).extend((time, position))
