"""Sections take values as they are written, and no others."""

from __future__ import annotations

import inspect
import re
from typing import Annotated, Literal

import pytest
from pydantic import ValidationError

from teleop.config.documents.base_model import NoTruth, PositionsSection, Section
from teleop.core.axes import Axis


class Sample(Section):
    rate: Annotated[Literal[1, 2], NoTruth] = 1
    """A rate."""


@pytest.mark.parametrize("values", [{"pan": "3"}, {"pan": True}, {"pan": float("nan")}, {"yaw": 3}])
def test_nothing_is_converted_and_no_key_is_passed_over(values):
    with pytest.raises(ValidationError):
        PositionsSection.model_validate(values)


def test_true_is_no_number_where_a_number_is_chosen():
    assert Sample.model_validate({"rate": 1}).rate == 1
    with pytest.raises(ValidationError, match="must be a number, not true"):
        Sample.model_validate({"rate": True})


def test_a_section_cannot_be_changed():
    with pytest.raises(ValidationError):
        PositionsSection(pan=1.0).pan = 2.0


def test_positions_have_a_described_key_for_every_axis():
    axes = {axis.value for axis in Axis}
    assert set(PositionsSection.model_fields) == axes
    described = re.findall(r'^    (\w+): .*\n    """\w', inspect.getsource(PositionsSection), re.MULTILINE)
    assert set(described) == axes
