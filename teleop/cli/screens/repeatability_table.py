"""What repeated passes amounted to: how far each lay from the first, for people and for programs."""

from __future__ import annotations

from collections.abc import Iterator

from teleop.cli.screens.tables import print_table
from teleop.monitors.repeatability import Repeatability
from teleop.monitors.tracking_error import Score


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
        if not self._passes:
            return
        headings = ("Pass", "Axis", "Commanded RMS", "Commanded peak", "Measured RMS", "Measured peak", "Unit")
        rows = []
        for number, axes in self._passes.items():
            for axis, each in axes.items():
                shown = [f"{value:.4f}" for of in (each.commanded, each.measured) for value in (of.rms, of.peak)]
                rows.append([str(number), axis.value, *shown, axis.unit or "0..1"])
        drop = ("Unit", "Commanded RMS", "Measured RMS", "Commanded peak")
        print_table("Each pass against the first", headings, rows, words=("Axis", "Unit"), drop=drop)


def _facts(score: Score) -> dict[str, object]:
    return {"readings": score.readings, "rms": round(score.rms, 9), "peak": round(score.peak, 9)}
