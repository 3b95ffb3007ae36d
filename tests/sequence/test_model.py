"""The shape of a sequence file: defaults, titles, and what is refused by type alone."""

from __future__ import annotations

import pytest
from pydantic import ValidationError

from teleop.sequence.model import PREROLL, SequenceModel

KEYS = [{"at": 0, "pan": 0}]


def test_a_file_needs_nothing_but_keyframes() -> None:
    model = SequenceModel.model_validate({"keyframes": KEYS})
    assert (model.preroll, model.tension, model.back_to_one, model.cues) == (PREROLL, "even", False, [])
    assert model.keyframes[0].pass_ == "through"


@pytest.mark.parametrize(
    ("title", "shown"), [("", "dusk"), ("Two\nlines  of it", "Two lines of it"), ("  \t ", "dusk")]
)
def test_a_title_is_one_line_or_the_name_of_the_file(title: str, shown: str) -> None:
    assert SequenceModel.model_validate({"title": title, "keyframes": KEYS}).called("shoots/dusk.yaml") == shown


@pytest.mark.parametrize(("fps", "exact"), [(23.976, 24000 / 1001), (29.97, 30000 / 1001), (25, 25)])
def test_a_rounded_broadcast_rate_is_the_exact_one(fps: float, exact: float) -> None:
    assert SequenceModel.model_validate({"fps": fps, "keyframes": KEYS}).fps == exact


@pytest.mark.parametrize(
    "wrong",
    [
        {"keyframes": []},
        {"keyframes": KEYS, "fps": 0},
        {"keyframes": KEYS, "title": "x" * 201},
        {"keyframes": KEYS, "fit": "squeeze"},
        {"keyframes": KEYS, "repeat": {"times": 0, "mode": "loop"}},
        {"keyframes": [{"at": 0, "focus": 1.1}]},
        {"keyframes": [{"at": 0, "pan": float("nan")}]},
        {"keyframes": [{"at": 0, "pan": 0, "zoom": 1}]},
    ],
)
def test_a_value_beyond_its_range_is_refused(wrong: dict) -> None:
    with pytest.raises(ValidationError):
        SequenceModel.model_validate(wrong)
