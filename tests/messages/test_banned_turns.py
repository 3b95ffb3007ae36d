"""The check for banned turns finds what it is for; `.ci/check` runs it over the whole tree."""

from __future__ import annotations

import banned_turns
import pytest
from banned_turns import better_words, findings, report


@pytest.mark.parametrize(
    "text",
    [
        "nothing is said of its speed",
        "was told to stop",
        "Nobody moves it",
        "E-STOP: press c",
        "HANDS OFF",
        "the stick's centre",
        "a grey card",
        "12 metres away",
        "two programmes",
        "virtual RC is given back",
        "it stands here twice",
    ],
)
def test_a_banned_turn_is_found(text: str) -> None:
    assert better_words(text)


@pytest.mark.parametrize(
    "text",
    ["STOPPED. Press c to clear.", "kind of file", "the axis stands still", "12 meters", "center all sticks", "{told}"],
)
def test_plain_words_pass(text: str) -> None:
    assert not better_words(text)


def test_a_finding_is_reported_unless_it_is_allowed() -> None:
    found = [("a.py", "nobody", "name who"), ("b.py", "nobody", "name who")]
    assert report(found, {"a.py: nobody"}) == ["b.py: nobody\n    name who"]


def test_no_text_has_a_banned_turn_that_is_not_allowed() -> None:
    assert report(findings(), set(banned_turns.allowed())) == []
