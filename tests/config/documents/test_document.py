"""Errors of a document: all at once, in the order of the file, each at its place and in a user's words."""

import pytest
from documents import Whole

from teleop.config.documents.document import DocumentError, mapping, number, sequence
from teleop.config.documents.yaml_loader import parse_document


def problems_of(text: str) -> list[str]:
    with pytest.raises(DocumentError) as caught:
        parse_document(text, "f.yaml").check(Whole)
    return caught.value.problems


def test_every_error_is_reported_at_its_place_in_file_order() -> None:
    text = "parts:\n  - {size: -1}\n  - {size: big, nmae: x}\n  - {}\ncount: 1.5\n"
    assert problems_of(text) == [
        "f.yaml:2:12: parts[0].size must be positive",
        "f.yaml:3:12: parts[1].size must be a number, not 'big'",
        "f.yaml:3:17: parts[1]: unknown key `nmae`; did you mean `name`?",
        "f.yaml:4:5: parts[2].size is missing",
        "f.yaml:5:8: count must be a whole number, not 1.5",
    ]


def test_values_are_not_converted() -> None:
    assert problems_of("parts: [{size: '3'}]") == ["f.yaml:1:16: parts[0].size must be a number, not '3'"]
    assert problems_of("parts: [{size: true}]") == ["f.yaml:1:16: parts[0].size must be a number, not true"]


def test_a_key_that_stands_twice_is_refused() -> None:
    assert problems_of("count: 1\nparts: []\ncount: 2\n") == ["f.yaml:3:1: count: duplicate key"]


def test_what_the_text_has_that_is_not_used_is_reported_with_the_rest() -> None:
    text = "parts:\n  - &a {size: 1, size: -2}\n  - {<<: *a, size: x}\n? [x]\n: 1\ncount: !n 1.5\n"
    assert problems_of(text) == [
        "f.yaml:2:18: parts[0].size: duplicate key",
        "f.yaml:2:24: parts[0].size must be positive",
        "f.yaml:3:6: parts[1].<< would merge, which YAML 1.2 does not: write out what it adds",
        "f.yaml:3:20: parts[1].size must be a number, not 'x'",
        "f.yaml:4:3: has a key that is not a word",
        "f.yaml:6:8: count has a tag, !n; no tags are used here",
        "f.yaml:6:8: count must be a whole number, not 1.5",
    ]


def test_callers_rules_are_reported_with_the_rest() -> None:
    document = parse_document("parts: []\ncount: x\n", "f.yaml")
    with pytest.raises(DocumentError) as caught:
        document.check(Whole, [(("parts",), "must not be empty")])
    assert caught.value.problems == [
        "f.yaml:1:8: parts must not be empty",
        "f.yaml:2:8: count must be a whole number, not 'x'",
    ]


def test_rules_may_look_at_data_of_any_shape() -> None:
    assert mapping({"a": {"b": {"c": 1}}}, "a", "b") == {"c": 1}
    assert mapping([1], "a") == {}
    assert sequence({"a": 3}, "a") == []
    assert number(True) is None
    assert number(2) == 2
