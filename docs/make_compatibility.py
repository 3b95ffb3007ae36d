"""Makes docs/reference/compatibility.md from the reports of users: what each device was found to do.

    python docs/make_compatibility.py            writes the page
    python docs/make_compatibility.py --check    exits with 1 where the page is out of date

A report is the `report.json` that `teleop commission` writes, in docs/reference/reports under any name that ends in
.json. A report with serial numbers is refused.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

from teleop.app.commission.results import read_report
from teleop.commission.changes import shown, written
from teleop.commission.findings import Findings, Verdict
from teleop.core.errors import TeleopError

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "reference" / "compatibility.md"
REPORTS = ROOT / "docs" / "reference" / "reports"
INTRO = """\
# Compatibility

What users found with `teleop commission` on real devices. This page is made from their reports by
`docs/make_compatibility.py`; to add yours, attach the `report.json` to an issue. A report has no serial numbers.
"""
EMPTY = """\
**The table is empty: there is no report of a real device yet.** [What was never tried](../explanation/untested.md)
lists what is open.
"""
COUNTS = tuple(Verdict)


def page(reports: Sequence[Findings]) -> str:
    """The whole page."""
    if not reports:
        return f"{INTRO}\n{EMPTY}"
    ordered = sorted(reports, key=lambda report: (report.device, report.model, report.firmware, report.date))
    return "\n".join([INTRO, *_table(ordered), "", *(line for report in ordered for line in _section(report))])


def reports(folder: Path) -> list[Findings]:
    """All that are in the folder. Raises TeleopError for what is none, or has serial numbers."""
    found = []
    for file in sorted(folder.glob("*.json")):
        report = read_report(file)
        if report.serials:
            raise TeleopError(f"{file}: has serial numbers: write the report again without --serial")
        found.append(report)
    return found


def _table(reports: Sequence[Findings]) -> Iterator[str]:
    yield "| Device | Model | Firmware | Adapter | Date | teleop | " + " | ".join(COUNTS) + " |"
    yield "|" + "---|" * (6 + len(COUNTS))
    for report in reports:
        counts = Counter(fact.verdict for fact in report.facts)
        about = (report.device, report.model, report.firmware, report.adapter, report.date, report.program)
        yield "| " + " | ".join([*map(_cell, about), *(str(counts[verdict]) for verdict in COUNTS)]) + " |"


def _section(report: Findings) -> Iterator[str]:
    """What is different from the document."""
    yield f"## {_cell(report.model or report.device)}, firmware {_cell(report.firmware)}, {_cell(report.date)}"
    yield ""
    different = [fact for fact in report.facts if fact.verdict is Verdict.DIFFERENT]
    if not different:
        yield "Nothing that was seen differs from the document."
    else:
        yield "| Different from the document | Document | Found |"
        yield "|---|---|---|"
        for fact in different:
            yield f"| {_cell(fact.title)} | {_cell(written(fact.documented, fact.unit))} | {_cell(shown(fact))} |"
    yield ""


def _cell(text: str) -> str:
    """Text of a report in a table: it makes no markup."""
    plain = " ".join(str(text).split()) or "-"
    return "".join(f"\\{each}" if each in "|\\`*_[]<>#" else each for each in plain)


def main() -> int:
    try:
        text = page(reports(REPORTS))
    except TeleopError as error:
        sys.exit(str(error))
    if "--check" in sys.argv[1:]:
        return int(not PAGE.exists() or PAGE.read_text(encoding="utf-8") != text)
    PAGE.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
