"""The `timelapse:` section: what it cannot be used with, and values of the wrong kind."""

from __future__ import annotations

import pytest

from teleop.sequence.timelapse_section import UNUSED, is_timelapse, timelapse_rules

SECTION = {"frames": 24, "interval": "5s", "exposure": "0.5s"}
KEYS = [{"at": 0, "pan": 0}, {"at": 23, "pan": 5}]


def found(extra: dict | None = None, **section: object) -> list[tuple[tuple, str]]:
    return list(timelapse_rules({"timelapse": {**SECTION, **section}, "keyframes": KEYS, **(extra or {})}))


def test_a_good_section_breaks_no_rule() -> None:
    assert found() == []
    assert found(interval={"from": "2s", "to": "10s"}, settle={"below": 0.1, "at_most": "2s"}) == []


def test_a_file_is_a_timelapse_by_its_section() -> None:
    assert is_timelapse({"timelapse": None})
    assert not is_timelapse({"keyframes": KEYS})
    assert not is_timelapse(None)


@pytest.mark.parametrize("name", UNUSED)
def test_what_only_a_film_has_is_refused(name: str) -> None:
    assert found({name: []}) == [((name,), f"cannot be used with timelapse: {UNUSED[name]}")]


@pytest.mark.parametrize(
    ("section", "location", "text"),
    [
        ({"interval": 0}, ("interval",), "must be more than 0 s"),
        ({"interval": {"from": "2s"}}, ("interval", "to"), "is missing"),
        (
            {"interval": {"from": "2s", "to": "3s", "too": 1}},
            ("interval", "too"),
            ": unknown key; the keys are from and to",
        ),
        ({"settle": {"below": -1, "at_most": "2s"}}, ("settle", "below"), "must be a rate above 0 deg/s, not -1"),
        ({"exposure": "banana"}, ("exposure",), "must be a time"),
    ],
)
def test_a_duration_that_is_none_is_refused_at_its_key(section: dict, location: tuple, text: str) -> None:
    [(where, said)] = found(**section)
    assert where == ("timelapse", *location)
    assert said.startswith(text)


def test_a_key_beyond_the_last_frame_and_an_ease_in_seconds_are_refused() -> None:
    keys = [{"at": 0, "pan": 0, "ease": "2s"}, {"at": 24, "pan": 5}]
    assert [where for where, _ in found({"keyframes": keys})] == [("keyframes", 0, "ease"), ("keyframes", 1, "at")]
