"""Prints what a run came to: for people a table and what went wrong, for programs one JSON object."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Protocol

from teleop.app.run import RunReport
from teleop.cli.screens.folded import complain, tell
from teleop.cli.screens.response_lines import run_facts, run_lines
from teleop.cli.screens.run_view import error_table
from teleop.core.run_state import Result
from teleop.monitors.tracking_error import TrackingErrorMonitor
from teleop.recording.topics import plain
from teleop.recording.writer import Recorder

EXIT_CODES: Mapping[Result, int] = {Result.DONE: 0, Result.FAILED: 1, Result.INTERRUPTED: 130}
TRAFFIC = ("frames_out", "frames_in", "replies")  # of a connection's counts, those that are no trouble


class Extra(Protocol):
    """What a command reports of a run, beside how well the rig followed."""

    def facts(self) -> Iterable[tuple[str, object]]:
        """For the JSON report: names and values."""
        ...

    def print(self) -> None: ...


def print_report(report: RunReport, as_json: bool, extras: Sequence[Extra] = ()) -> int:
    """Print `report` and `extras`; the exit code."""
    if as_json:
        print(json.dumps({**_facts(report, extras), **({} if report.take is None else {"take": report.take.facts})}))
        return EXIT_CODES[report.result]
    print_reasons(report.reasons)
    if report.tracking.scores:
        error_table(report.tracking)
    for line in run_lines(report):
        tell(line)
    for problem in report.kept.problems:
        complain(f"teleop: {problem}")
    for extra in extras:
        extra.print()
    print_links(report.links)
    print_take(report.take)
    return EXIT_CODES[report.result]


def print_reasons(reasons: Sequence[str]) -> None:
    """Why a run ended before its end."""
    for reason in reasons:
        complain(f"teleop: stopped: {reason}")


def stopped(result: Result, reasons: Sequence[str], as_json: bool) -> int:
    """Print why a run that measures did not come to its end; the exit code."""
    if as_json:
        print(json.dumps({"result": result.name.lower(), "reasons": reasons}))
    else:
        print_reasons(reasons)
    return EXIT_CODES[result]


def print_links(links: Mapping[str, Mapping[str, int]]) -> None:
    """What went wrong on each link without ending the run."""
    for name, counts in links.items():
        if troubles := _troubles(counts):
            tell(f"{name}: {', '.join(f'{count} {word}' for word, count in troubles.items())}")


def print_take(take: Recorder | None) -> None:
    """What was recorded, if anything was to be, and what could not be."""
    if take is None:
        return
    tell(str(take))
    if take.trouble:
        complain(f"teleop: {take.trouble}")


def axes_facts(tracking: TrackingErrorMonitor) -> Mapping[str, object]:
    """How well each axis followed, for programs."""
    return {
        axis.value: {"readings": score.readings, "rms": round(score.rms, 6), "peak": round(score.peak, 6)}
        for axis, score in tracking.scores.items()
    }


def _troubles(counts: Mapping[str, int]) -> Mapping[str, int]:
    """Those of a connection's counts that should be 0."""
    return {word.replace("_", " "): count for word, count in counts.items() if count and word not in TRAFFIC}


def _facts(report: RunReport, extras: Sequence[Extra]) -> Mapping[str, object]:
    drone = {} if report.drone is None else {"drone": plain(report.drone)}
    return {
        "result": report.result.name.lower(),
        "reasons": report.reasons,
        "seconds": round(report.tracking.seconds, 3),
        "axes": axes_facts(report.tracking),
        "responses": run_facts(report),
        "links": report.links,
        **{name: value for extra in extras for name, value in extra.facts()},
        **drone,
    }
