"""The options of `teleop commission` about its results, and what is printed of them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cyclopts import Group, Parameter

from teleop.app.commission.kept import Kept, Wanted
from teleop.app.commission.results import change_lines, read_report
from teleop.cli.screens.folded import complain, tell
from teleop.commission.findings import Findings
from teleop.core.errors import UsageError

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

    @property
    def wanted(self) -> Wanted:
        return Wanted(self.report, self.compare, self.serial)


NO_RESULTS = ResultOptions()


def tell_results(kept: Kept, findings: Findings, compared_with: Sequence[Path]) -> None:
    """Print where the results are, and what changed since the earlier report."""
    if not kept.files:
        return
    if kept.before is not None:
        compared(kept.before, findings, str(compared_with[0]))
    tell(f"results: {kept.files[0]}, {kept.files[1].name}")
    complain(kept.summary)


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
