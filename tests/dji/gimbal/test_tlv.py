"""User parameters: known and unknown ids, every length, and what does not parse."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.dji.gimbal.messages import Parameter, ParameterId, Parameters, ParametersReply, SetParameters
from teleop.dji.message import FieldError, ReturnCode

parameters = st.lists(st.builds(Parameter, st.integers(0, 255), st.binary(max_size=255)), max_size=4).map(tuple)


@given(parameters)
def test_parameters_survive_wire_and_json(given_parameters: tuple[Parameter, ...]) -> None:
    sent = SetParameters(given_parameters)
    assert SetParameters.decode(sent.encode()) == sent
    assert SetParameters.from_fields(json.loads(json.dumps(sent.fields()))) == sent


@given(parameters, st.integers(0, 255), st.integers(1, 255), st.binary(max_size=254))
def test_a_parameter_that_is_cut_short_is_left_over(
    complete: tuple[Parameter, ...], number: int, length: int, begun: bytes
) -> None:
    cut = bytes((number, length)) + begun[: length - 1]
    received = ParametersReply.decode(b"\0" + SetParameters(complete).encode() + cut)
    assert received == ParametersReply(ReturnCode.OK, complete, extra=cut)


def test_known_ids_are_words_and_others_numbers() -> None:
    received = ParametersReply(ReturnCode.OK, (Parameter(0x23, b"\0"), Parameter(0x14, b"\1\2"), Parameter(0x99, b"")))
    assert received.fields()["parameters"] == [
        {"id": "motor", "value": "00"},
        {"id": "push_pan", "value": "0102"},
        {"id": 0x99, "value": ""},
    ]
    assert Parameters((ParameterId.TABLE, 0x99)).fields() == {"ids": ["table", 0x99]}


@pytest.mark.parametrize("ids", ["", "motr", "256", "-1", [1.5], [True], 3, [None]])
def test_ids_that_are_none_are_refused(ids: Any) -> None:
    with pytest.raises(FieldError, match=r"ids must be ids separated by commas: table, .*, motor or 0..255, not"):
        Parameters.from_fields({"ids": ids})


@pytest.mark.parametrize("value", ["motor", "motor:0", "300:00", [{"id": 1}], [3], 7, [{"id": 1, "value": None}]])
def test_parameters_that_are_none_are_refused(value: Any) -> None:
    with pytest.raises(FieldError, match="parameters must be id:hex separated by commas"):
        SetParameters.from_fields({"parameters": value})
