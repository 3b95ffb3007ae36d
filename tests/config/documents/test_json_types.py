"""The schemas of editors accept what the readers accept, and refuse what these refuse."""

from __future__ import annotations

from typing import Any

import pytest
from jsonschema import Draft202012Validator
from pydantic import TypeAdapter

from teleop.config.documents.json_types import Ease, Interval, Overlap, Percentage, Settle, Time


def accepts(kind: Any, value: Any) -> bool:
    return Draft202012Validator(TypeAdapter(kind).json_schema()).is_valid(value)


@pytest.mark.parametrize("kind", [Time, Percentage, Overlap, Ease])
def test_the_examples_are_accepted(kind: Any):
    for example in TypeAdapter(kind).json_schema()["examples"]:
        assert accepts(kind, example), example


@pytest.mark.parametrize(
    ("kind", "good", "bad"),
    [
        (Time, 0, -1),
        (Time, "1m30s", "soon"),
        (Percentage, "30%", "30"),
        (Overlap, "90%", "91%"),
        (Overlap, "0.5%", "-1%"),
        (Ease, {"arrive": "1s", "leave": "25%"}, {"arive": "1s"}),
        (Interval, 2, 0),
        (Interval, {"from": 2, "to": "10s"}, {"from": 2}),
        (Settle, "1s", {"below": 0.1}),
        (Settle, {"below": 0.1, "at_most": 2}, {"below": 0, "at_most": 2}),
    ],
)
def test_an_editor_tells_the_good_from_the_bad(kind: Any, good: object, bad: object):
    assert accepts(kind, good)
    assert not accepts(kind, bad)
