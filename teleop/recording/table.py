"""A take as CSV, a row for each tick: for spreadsheets and other people's programs.

Rows are made while the file is read and written as soon as nothing can be added to them: what was measured arrives
later than the tick that it belongs to, as a device takes its time to say it. So hours take the memory of a second.
"""

from __future__ import annotations

import csv
import json
from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import Any, TextIO

from teleop.core.timing import SAME_TIME
from teleop.recording.messages import Line, Messages, reading_errors

HELD = 1.0  # s that a row waits for what was measured at its time; a device that is silent for longer is lost

Row = dict[str, Any]


def columns(axes: Sequence[str]) -> list[str]:
    """`time` (s from the first tick), what is there of each axis, `actions` (what was done at that tick).

    Of an axis: its stick (-1..1, empty where none was recorded), what was asked for (cruise, goto, follow, halt), the
    number of that (of a cruise unit/s, else units), where it was commanded to be (units, unit/s, unit/s2), and where it
    was measured to be since the row before, with the time of that: empty where it was not.
    """
    names = "_stick", "_wish", "_asked", "", "_velocity", "_acceleration", "_measured", "_measured_time"
    return ["time", *(f"{axis}{name}" for axis in axes for name in names), "actions"]


def write_table(path: Path, text: TextIO) -> tuple[Messages, int]:
    """The take at `path` as CSV; what is known of its end then, and the rows. Raises DocumentError for no take."""
    messages, rows = Messages(path), 0
    lines = iter(messages)
    writer = csv.DictWriter(text, ["time"], lineterminator="\n")
    with reading_errors(path):
        first = next(lines, None)
        axes = [axis.value for axis in messages.about.limits]
        writer.fieldnames = columns(axes)
        writer.writeheader()
        for row in _rows([] if first is None else chain([first], lines), axes):
            writer.writerow(row)
            rows += 1
    return messages, rows


def _rows(lines: Iterable[Line], axes: Sequence[str]) -> Iterator[Row]:
    waiting: deque[Row] = deque()
    early: list[tuple[float, Mapping[str, float]]] = []  # measured, and later than every row so far
    sticks: Mapping[str, float] = {}
    demand: Mapping[str, Mapping[str, Any]] = {}
    for time, topic, data in lines:
        content = json.loads(data)
        if topic == "/motion":
            while waiting and waiting[0]["time"] < time - HELD:
                yield waiting.popleft()
            waiting.append(_commanded(time, content, axes))
            waiting[-1].update(_asked(waiting[-1], sticks, demand, axes))
            early = [each for each in early if not _measured(waiting, *each)]
        elif topic == "/sticks":
            sticks = content
        elif topic == "/demand":
            demand = content
        elif topic == "/measured" and not _measured(waiting, time, content):
            early.append((time, content))
        elif topic == "/actions" and waiting:
            done = content.get("words") or content["action"]
            waiting[-1]["actions"] = "; ".join(filter(None, [waiting[-1]["actions"], done]))
        if topic in ("/sticks", "/demand") and waiting and waiting[-1]["time"] >= time - SAME_TIME:
            waiting[-1].update(_asked(waiting[-1], sticks, demand, axes))
    yield from waiting


def _commanded(time: float, content: Mapping[str, Mapping[str, float]], axes: Sequence[str]) -> Row:
    row: Row = {"time": round(time, 6), "actions": ""}
    for axis in axes:
        state = content[axis]
        row[axis] = state["position"]
        row[f"{axis}_velocity"], row[f"{axis}_acceleration"] = state["velocity"], state["acceleration"]
    return row


def _asked(row: Row, sticks: Mapping[str, float], demand: Mapping[str, Mapping[str, Any]], axes: Sequence[str]) -> Row:
    """What the sticks and the sources ask for; a follow that was obeyed is where the axis is."""
    asked: Row = {f"{axis}_stick": sticks[axis] for axis in axes if axis in sticks}
    for axis in axes:
        setpoint = demand.get(axis, {})
        kind = setpoint.get("wish", "")
        there = row[axis] if kind == "follow" else ""
        asked[f"{axis}_wish"] = kind
        asked[f"{axis}_asked"] = setpoint.get("velocity" if kind == "cruise" else "position", there)
    return asked


def _measured(waiting: deque[Row], time: float, content: Mapping[str, float]) -> bool:
    """Put it into the first row that is not before it; whether there was one."""
    found: Row | None = None
    for row in reversed(waiting):
        if row["time"] < time - SAME_TIME:
            break
        found = row
    if found is None:
        return False
    for axis, position in content.items():
        if axis in found:
            found[f"{axis}_measured"], found[f"{axis}_measured_time"] = position, round(time, 6)
    return True
