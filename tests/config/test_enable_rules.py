"""An input's enable button does nothing else."""

from __future__ import annotations

import pytest

from teleop.config.enable_rules import does_already, enable_rules, enable_trouble
from teleop.config.inputs_section import ControlSection


def problems(section):
    return [text for _, text in enable_rules({"inputs": [section]})]


def test_a_button_that_is_free_may_enable():
    assert problems({"device": "any", "enable": "Button 5", "controls": {"Button 1": {"press": "stop"}}}) == []


def test_a_button_that_does_something_cannot_enable_too():
    (problem,) = problems({"enable": "Button 1", "controls": {"Button 1": {"press": "stop"}}})
    assert problem.startswith("Button 1 already is stop: ")
    assert "controls: {Button 1: null}" in problem


def test_enable_is_not_a_press():
    (problem,) = problems({"controls": {"Button 1": {"press": "enable"}}})
    assert "name it with enable:" in problem


@pytest.mark.parametrize(
    ("controls", "words"),
    [
        ({"Hat": {"up": {"press": "stop"}}}, ""),
        ({"Button 5": {"dial": True}}, "the dial"),
        ({"Button 5": {"axis": "pan"}}, "pan"),
        ({"X": {"fine_button": "Button 5"}}, "the fine button of X"),
        ({"Button 5": None}, ""),
    ],
)
def test_what_a_button_does_is_found_in_its_controls(controls, words):
    assert does_already("Button 5", controls) == words
    assert does_already("Hat up", {"Hat": {"up": {"press": "stop"}}}) == "stop"


def test_a_device_without_the_button_names_those_that_it_has():
    assert enable_trouble("Button 9", ["X", "Button 1"], {}) == "enable: it has no Button 9; it has Button 1"
    assert enable_trouble(None, [], {}) == ""
    controls = {"Button 1": ControlSection.model_validate({"press": "stop"})}
    assert enable_trouble("Button 1", ["Button 1"], controls).startswith("enable: Button 1 already is stop")
