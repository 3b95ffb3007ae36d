"""Takes made by hand, through the writer that records real ones: any motion, any measurement, any end."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from teleop.core.axes import Axis, Limits, Reading, State
from teleop.core.events import Tick, TickEvent
from teleop.recording.format import About, TakeWriter

PERIOD = 0.01
LIMITS = Limits(-180, 180, 120, 240, 1200)
STARTED = 1.7e9

Path1 = Callable[[float], float]  # s -> units
Motion1 = Callable[[float], State]


def write_take(
    path: Path,
    motion: Mapping[Axis, Motion1],
    seconds: float,
    *,
    measured: Mapping[Axis, Path1] | None = None,
    acts: Mapping[int, Sequence[TickEvent]] | None = None,
    limits: Mapping[Axis, Limits] | None = None,
    closed: bool = True,
    result: str = "done",
    reasons: Sequence[str] = (),
    flush: int = 80,
) -> Path:
    """A take of so many seconds at 100 Hz, readings at 25 Hz; `acts` by tick, `flush` in ticks. Not closed: killed."""
    limits = limits or dict.fromkeys(motion, LIMITS)
    with path.open("wb") as stream:
        writer = TakeWriter(stream, About("Bench", path.stem, STARTED, limits, "0"))
        readings: dict[Axis, Reading] = {}
        for number in range(round(seconds / PERIOD) + 1):
            time = number * PERIOD
            if number % 4 == 0:
                readings = {axis: Reading(place(time), time) for axis, place in (measured or {}).items()}
            states = {axis: of_axis(time) for axis, of_axis in motion.items()}
            writer.add(Tick(time, states, {}, (acts or {}).get(number, ()), readings), None)
            if number % flush == flush - 1:
                writer.flush()
        if closed:
            writer.end(result, reasons, 0)
        else:
            writer.flush()
    return path


def at_rest(position: float) -> Motion1:
    return lambda _time: State(position)
