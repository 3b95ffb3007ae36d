"""What repeated passes amounted to: how far each lay from the first, for people and for programs."""

from __future__ import annotations

from collections.abc import Iterator

from teleop.cli.display import UNITS
from teleop.sinks.repeatability import Repeatability
from teleop.sinks.tally import Score


class PassesReport:
    def __init__(self, repeatability: Repeatability) -> None:
        self._passes = repeatability.passes

    def facts(self) -> Iterator[tuple[str, object]]:
        yield (
            "passes",
            [
                {
                    "pass": number,
                    "axes": {
                        axis.value: {"commanded": _facts(each.commanded), "measured": _facts(each.measured)}
                        for axis, each in axes.items()
                    },
                }
                for number, axes in self._passes.items()
            ],
        )

    def print(self) -> None:
        from rich.console import Console
        from rich.table import Table

        if not self._passes:
            return
        table = Table(title="Each pass against the first")
        for heading in ("Pass", "Axis", "Commanded RMS", "Peak", "Measured RMS", "Peak", "Unit"):
            table.add_column(heading, justify="left" if heading in ("Axis", "Unit") else "right")
        for number, axes in self._passes.items():
            for axis, each in axes.items():
                shown = [f"{value:.4f}" for of in (each.commanded, each.measured) for value in (of.rms, of.peak)]
                table.add_row(str(number), axis.value, *shown, UNITS.get(axis, "0..1"))
        Console().print(table)


def _facts(score: Score) -> dict[str, object]:
    return {"readings": score.readings, "rms": round(score.rms, 9), "peak": round(score.peak, 9)}
