"""The results of one commissioning that are kept on disk, from where they go to what there is to say of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from teleop.app.commission.results import Results, change_lines, default_folder, read_report
from teleop.commission.findings import Findings
from teleop.core.errors import UsageError
from teleop.core.interfaces import Link
from teleop.links.url import LinkAddress


@dataclass(frozen=True)
class Wanted:
    """Where the results go and with what they are compared: `folder` is a new one, None for one of its own name.

    `compare` are reports of earlier commissionings, at most one. With `serials` the results have serial numbers.
    """

    folder: Path | None = None
    compare: Sequence[Path] = ()
    serials: bool = False


class Kept:
    """`files` are the page, the report and the capture, once they are written. Raises UsageError and OutputError.

    `before` is the earlier report, None without one.
    """

    def __init__(self, wanted: Wanted, rig: str, device: str, now: Callable[[], float]) -> None:
        if len(wanted.compare) > 1:
            raise UsageError("--compare: give one report to compare with, or two to compare with each other")
        self._wanted, self._device, self._now = wanted, device, now
        self.folder = wanted.folder or default_folder(rig)
        self.before = read_report(wanted.compare[0]) if wanted.compare else None
        self.files: Sequence[Path] = ()
        self._results: Results | None = None

    def tapped(self, address: LinkAddress) -> Callable[[Link], Link]:
        """Begins the capture of the link at `address`."""
        self._results = Results(
            self.folder, address, self._device, self._now, serials=self._wanted.serials, before=self.before
        )
        return self._results.tap

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """The capture is complete; without a report nothing is left behind."""
        if self._results is not None:
            self._results.__exit__()

    def write(self, findings: Findings) -> None:
        """Complete the capture and write what was found, if anything was. Raises OutputError."""
        if self._results is None:
            return
        self._results.close()
        if any(fact.found is not None for fact in findings.facts):
            self.files = self._results.write(findings)

    def facts(self, findings: Findings) -> dict[str, Any]:
        """For programs."""
        files = dict(zip(("page", "report", "capture"), map(str, self.files), strict=False))
        changed = {} if self.before is None else {"changes": change_lines(self.before, findings)}
        return {**files, **changed}

    @property
    def summary(self) -> str:
        """What is in the capture, in a line; "" where nothing was kept."""
        return self._results.summary if self._results is not None and self.files else ""
