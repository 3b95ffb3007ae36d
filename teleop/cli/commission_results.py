"""The options of `teleop commission` about its results, and what is printed of them."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Self

from cyclopts import Group, Parameter

from teleop.app.commission.results import Results, change_lines, default_folder, read_report
from teleop.cli.screens.folded import complain, tell
from teleop.commission.findings import Findings
from teleop.core.errors import UsageError
from teleop.core.interfaces import Link
from teleop.links.url import LinkAddress

RESULTS = Group("Results", sort_key=1)
_PAIR = 2


@Parameter(name="*")
@dataclass(frozen=True)
class ResultOptions:
    """Where the results go, and with what they are compared."""

    report: Annotated[
        Path | None,
        Parameter(
            metavar="FOLDER",
            group=RESULTS,
            help="New folder for the page, the JSON and the capture; without it, commission-RIG-DATE here.",
            show_default=False,
        ),
    ] = None
    compare: Annotated[
        tuple[Path, ...],
        Parameter(
            metavar="REPORT",
            group=RESULTS,
            help="Show what changed since this report.json; given twice, compare these two and do nothing else.",
            negative=(),
            show_default=False,
        ),
    ] = ()
    serial: Annotated[
        bool, Parameter(group=RESULTS, help="Keep serial numbers in the results.", negative=(), show_default=False)
    ] = False


NO_RESULTS = ResultOptions()


class Kept:
    """The results of one commissioning, from its options to its last lines. Raises UsageError and OutputError."""

    def __init__(self, options: ResultOptions, rig: str, device: str, now: Callable[[], float]) -> None:
        if len(options.compare) > 1:
            raise UsageError("--compare: give one report to compare with, or two to compare with each other")
        self._options, self._device, self._now = options, device, now
        self._folder = options.report or default_folder(rig)
        self._before = read_report(options.compare[0]) if options.compare else None
        self._results: Results | None = None
        self._files: Sequence[Path] = ()

    def tapped(self, address: LinkAddress) -> Callable[[Link], Link]:
        """Begins the capture of the link at `address`."""
        self._results = Results(
            self._folder, address, self._device, self._now, serials=self._options.serial, before=self._before
        )
        return self._results.tap

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """The capture is complete; without a report nothing is left behind."""
        if self._results is not None:
            self._results.__exit__()

    def write(self, findings: Findings) -> None:
        """Write what was found, if anything was. Raises OutputError."""
        if self._results is not None and any(fact.found is not None for fact in findings.facts):
            self._files = self._results.write(findings)

    def facts(self, findings: Findings) -> dict[str, Any]:
        """For programs."""
        files = dict(zip(("page", "report", "capture"), map(str, self._files), strict=False))
        changed = {} if self._before is None else {"changes": change_lines(self._before, findings)}
        return {**files, **changed}

    def tell(self, findings: Findings) -> None:
        """For people."""
        if self._before is not None and self._files:
            compared(self._before, findings, str(self._options.compare[0]))
        if self._results is not None and self._files:
            tell(f"results: {self._files[0]}, {self._files[1].name}")
            complain(self._results.summary)


def compare_two(reports: Sequence[Path], as_json: bool) -> int:
    """Print what is different between two reports; 0."""
    before, now = (read_report(path) for path in reports)
    if before.device != now.device:
        raise UsageError(f"{reports[1]} is of a {now.device}, {reports[0]} of a {before.device}")
    if as_json:
        print(json.dumps({"changes": change_lines(before, now)}))
    else:
        compared(before, now, str(reports[0]))
    return 0


def compares_two(options: ResultOptions) -> bool:
    """Whether two reports are to be compared, and no device asked."""
    return len(options.compare) == _PAIR


def compared(before: Findings, now: Findings, name: str) -> None:
    tell(f"since {name} ({before.date or 'no date'}):")
    for line in change_lines(before, now):
        tell(f"  {line}")
