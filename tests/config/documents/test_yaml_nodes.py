"""YAML of an insane size is refused while it is read."""

from __future__ import annotations

import pytest
import yaml

from teleop.config.documents.yaml_nodes import TooMuchError, compose


def test_a_text_becomes_one_node_and_an_empty_one_none():
    node = compose("{a: [1, 2]}", 5, 10)
    assert isinstance(node, yaml.MappingNode)
    assert compose("", 5, 10) is None


def test_keys_and_values_are_counted():
    assert compose("[1, 2]", 5, 3) is not None  # the list and its two values
    with pytest.raises(TooMuchError) as error:
        compose("[1, 2, 3]", 5, 3)
    assert error.value.problem == "holds too many values"
    mark = error.value.problem_mark
    assert mark is not None
    assert (mark.line, mark.column) == (0, 7)


@pytest.mark.parametrize("depth", [4, 10_000])
def test_nesting_is_limited_whatever_its_depth(depth):
    assert compose("[[1]]", 3, 99) is not None
    with pytest.raises(TooMuchError, match="nested too deeply"):
        compose("[" * depth + "]" * depth, 3, 1_000_000)


def test_bad_yaml_is_an_error_of_yaml():
    with pytest.raises(yaml.YAMLError):
        compose("a: [", 5, 10)
