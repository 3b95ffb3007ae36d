"""What a commissioning found, as one page without scripts: to read, to print, and to attach to a bug report."""

from __future__ import annotations

import html
from collections import Counter
from collections.abc import Iterator, Sequence

from teleop.commission.changes import Kind, changes, heading, shown, written
from teleop.commission.findings import Fact, Findings, Verdict
from teleop.plots.printed_page import printed_page

NOTE = "As documented: what DJI's document says, or a value that it does not give. Different: it says otherwise."
_MARKS = {Verdict.DOCUMENTED: "documented", Verdict.DIFFERENT: "different", Verdict.NOT_SEEN: "not-seen"}


def page(found: Findings, serials: bool = False, before: Findings | None = None) -> str:
    """The HTML text. Serial numbers are on it only with `serials`; with `before`, what changed since then."""
    title = found.model or found.rig
    return printed_page(f"{title}: commissioning", "Commissioning", title, _content(found, serials, before))


def _content(found: Findings, serials: bool, before: Findings | None) -> Iterator[str]:
    yield _about(found, serials)
    counts = Counter(fact.verdict for fact in found.facts)
    yield f"<p>{', '.join(f'{counts[verdict]} {verdict.value}' for verdict in Verdict)}.</p>"
    if before is not None:
        yield from _changes(before, found)
    different = [fact for fact in found.facts if fact.verdict is Verdict.DIFFERENT]
    if different:
        yield "<h2>Different from the document</h2>"
        yield _table(different)
    for group in dict.fromkeys(_group(fact) for fact in found.facts):
        yield f"<h2>{_text(group)}</h2>"
        yield _table([fact for fact in found.facts if _group(fact) == group])


def _about(found: Findings, serials: bool) -> str:
    rows = {
        "Device": found.device,
        "Rig": found.rig,
        "Firmware": found.firmware or "not seen",
        "Adapter": found.adapter or "not seen",
        "Date": found.date,
        "Program": f"teleop {found.program}" if found.program else "",
    }
    if serials:
        rows |= {f"Serial number of the {name}": number for name, number in found.serials.items()}
    else:
        rows["Serial numbers"] = "left out"
    items = "".join(f"<dt>{_text(name)}</dt><dd>{_text(text)}</dd>" for name, text in rows.items() if text)
    return f'<dl>{items}</dl><p class="note">{NOTE}</p>'


def _changes(before: Findings, now: Findings) -> Iterator[str]:
    yield "<h2>Changed since the earlier report</h2>"
    rows = [_cells(name.capitalize(), was, new, Kind.VALUE) for name, was, new in heading(before, now)]
    rows += [_cells(each.title, shown(each.before), shown(each.now), each.kind) for each in changes(before, now)]
    if not rows:
        yield "<p>Nothing.</p>"
        return
    head = "<tr><th>Fact</th><th>Before</th><th>Now</th><th></th></tr>"
    yield f'<table class="facts"><thead>{head}</thead><tbody>{"".join(rows)}</tbody></table>'


def _cells(*texts: str) -> str:
    return f"<tr>{''.join(f'<td>{_text(text)}</td>' for text in texts)}</tr>"


def _table(facts: Sequence[Fact]) -> str:
    head = "<tr><th>Fact</th><th>Document</th><th>Found</th><th>Verdict</th><th>How</th></tr>"
    rows = "".join(_row(fact) for fact in facts)
    return f'<table class="facts"><thead>{head}</thead><tbody>{rows}</tbody></table>'


def _row(fact: Fact) -> str:
    mark = f'<span class="verdict {_MARKS[fact.verdict]}">{fact.verdict.value}</span>'
    cells = [fact.title, written(fact.documented, fact.unit), shown(fact), "", fact.how]
    texts = [_text(cell) for cell in cells]
    texts[3] = mark
    return f'<tr id="{_text(fact.key)}">{"".join(f"<td>{text}</td>" for text in texts)}</tr>'


def _group(fact: Fact) -> str:
    return (fact.step or fact.key.partition(".")[0]).replace("-", " ").capitalize()


def _text(text: str) -> str:
    return html.escape(str(text))
