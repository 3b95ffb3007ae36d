"""The page of a commissioning: every fact with its verdict, what changed, and no serial number unless asked."""

from __future__ import annotations

import re

from made_findings import FOUND, UPDATED

from teleop.plots.findings_html import page


def test_every_fact_has_its_row_and_verdict() -> None:
    text = page(FOUND)
    for fact in FOUND.facts:
        rows = re.findall(rf'<tr id="{re.escape(fact.key)}">.*?</tr>', text)
        assert rows
        assert all(fact.verdict.value in row for row in rows)
    assert "<p>3 as documented, 1 different, 1 not seen.</p>" in text
    assert "03.01.00.10" in text


def test_a_text_of_a_report_is_no_markup_and_nothing_is_fetched() -> None:
    text = page(FOUND)
    assert "&lt;0E 12&gt;" in text
    assert "<0E" not in text
    assert "script" not in text
    assert "default-src 'none'" in text
    assert not re.search(r"(src|href)=", text)


def test_serial_numbers_are_on_it_only_when_asked_for() -> None:
    assert "0M6CH7R0A1B2C3" not in page(FOUND)
    assert "Serial numbers</dt><dd>left out" in page(FOUND)
    assert "0M6CH7R0A1B2C3" in page(FOUND, serials=True)


def test_what_changed_since_an_earlier_report() -> None:
    text = page(UPDATED, before=FOUND)
    assert "<td>Firmware</td><td>03.01.00.10</td><td>04.00.00.00</td><td>changed</td>" in text
    assert "<td>Sign of pan in speed commands (0E 01)</td><td>-1</td><td>1</td><td>changed</td>" in text
    assert "<p>Nothing.</p>" in page(FOUND, before=FOUND)
