"""YAML 1.2 values, places in errors, and files that would choke a parser."""

import contextlib
from typing import Annotated

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import Field

from teleop.document import DocumentError, mapping, number, sequence
from teleop.section import Section
from teleop.yaml_text import parse_document, read_document


class Part(Section):
    size: Annotated[float, Field(gt=0)]
    name: str = ""


class Whole(Section):
    parts: list[Part]
    count: int = 0


def problems_of(text: str) -> list[str]:
    with pytest.raises(DocumentError) as caught:
        parse_document(text, "f.yaml").check(Whole)
    return caught.value.problems


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1:30", "1:30"),
        ("on", "on"),
        ("no", "no"),
        ("010", 10),
        ("0o10", 8),
        ("0x1F", 31),
        ("1e3", 1000.0),
        (".5", 0.5),
        ("-2.5E-1", -0.25),
        ("~", None),
        ("'7'", "7"),
        ("true", True),
        ("2026-11-22", "2026-11-22"),
        ("-.inf", float("-inf")),
        ("1_000", "1_000"),
    ],
)
def test_scalars_follow_yaml_1_2(text: str, value: object) -> None:
    data = parse_document(f"key: {text}", "f.yaml").data
    assert data == {"key": value}
    assert type(data["key"]) is type(value)


def test_every_error_is_reported_at_its_place_in_file_order() -> None:
    text = "parts:\n  - {size: -1}\n  - {size: big, nmae: x}\n  - {}\ncount: 1.5\n"
    assert problems_of(text) == [
        "f.yaml:2:12: parts[0].size must be positive",
        "f.yaml:3:12: parts[1].size must be a number, not 'big'",
        "f.yaml:3:17: parts[1].nmae is not known here; did you mean name?",
        "f.yaml:4:5: parts[2].size is missing",
        "f.yaml:5:8: count must be a whole number, not 1.5",
    ]


def test_values_are_not_converted() -> None:
    assert problems_of("parts: [{size: '3'}]") == ["f.yaml:1:16: parts[0].size must be a number, not '3'"]
    assert problems_of("parts: [{size: true}]") == ["f.yaml:1:16: parts[0].size must be a number, not true"]


def test_a_key_that_stands_twice_is_refused() -> None:
    assert problems_of("count: 1\nparts: []\ncount: 2\n") == ["f.yaml:3:1: count stands here for the second time"]


def test_what_the_text_has_that_is_not_used_is_reported_with_the_rest() -> None:
    text = "parts:\n  - &a {size: 1, size: -2}\n  - {<<: *a, size: x}\n? [x]\n: 1\ncount: !n 1.5\n"
    assert problems_of(text) == [
        "f.yaml:2:18: parts[0].size stands here for the second time",
        "f.yaml:2:24: parts[0].size must be positive",
        "f.yaml:3:6: parts[1].<< would merge, which YAML 1.2 does not: write out what it adds",
        "f.yaml:3:20: parts[1].size must be a number, not 'x'",
        "f.yaml:4:3: has a key that is not a word",
        "f.yaml:6:8: count has a tag, !n; no tags are used here",
        "f.yaml:6:8: count must be a whole number, not 1.5",
    ]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("parts: []\ncount: \x07", "2:8: not YAML: a control character, U+0007"),
        ("parts: []\r\r\ncount: \x9f", "3:8: not YAML: a control character, U+009F"),
        ("parts: []\nname: a\u2028b", "2:8: not YAML: a control character, U+2028"),
        ("parts:\n\t- {size: 1}", "2:1: not YAML: a tab; indent with spaces"),
        ("parts: []\n---\nparts: []", "2:1: not YAML: a second document begins here, and a file holds one"),
        ('parts: [{size: 1, name: "\\e[31m"}]', "1:25: parts[0].name has a control character, U+001B"),
        ('parts: [{size: 1, "\\e[31m": 2}]', "1:19: parts[0] has a key that is not a word"),
        ('parts: []\n"a\\nb": 2', "2:1: has a key that is not a word"),
    ],
)
def test_what_would_not_be_seen_on_a_screen_has_a_place_and_is_not_shown(text: str, problem: str) -> None:
    with pytest.raises(DocumentError) as caught:
        parse_document(text, "f.yaml").check(Whole)
    assert caught.value.problems == [f"f.yaml:{problem}"]


def test_callers_rules_are_reported_with_the_rest() -> None:
    document = parse_document("parts: []\ncount: x\n", "f.yaml")
    with pytest.raises(DocumentError) as caught:
        document.check(Whole, [(("parts",), "must not be empty")])
    assert caught.value.problems == [
        "f.yaml:1:8: parts must not be empty",
        "f.yaml:2:8: count must be a whole number, not 'x'",
    ]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "the file is empty"),
        ("a: [1, 2", "not YAML"),
        ("a: !!python/object:os.system x", "has a tag"),
        ("a: !mine 3", "has a tag"),
        ("a: \x07", "not YAML"),
        ("[1, 2]: 3", "a key that is not a word"),
    ],
)
def test_what_is_not_plain_yaml_is_refused_in_one_line(text: str, said: str) -> None:
    with pytest.raises(DocumentError, match=said) as caught:
        parse_document(text, "f.yaml").check(Whole)
    assert all("\n" not in problem for problem in caught.value.problems)


@pytest.mark.parametrize(
    "text",
    [
        "[" * 5000,
        "a: &a [*a]",
        "\n".join(["a0: &a0 x"] + [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 12)]),
    ],
    ids=["deep", "recursive", "billion laughs"],
)
@pytest.mark.timeout(30)
def test_files_that_would_choke_a_parser_are_refused(text: str) -> None:
    with pytest.raises(DocumentError, match=r"nested too deeply|too many values"):
        parse_document(text, "f.yaml")


def test_a_file_that_is_missing_huge_or_not_text_is_refused(tmp_path) -> None:
    with pytest.raises(DocumentError, match="No such file"):
        read_document(tmp_path / "none.yaml")
    (tmp_path / "huge.yaml").write_bytes(b"a: " + b"x" * 5_000_000)
    with pytest.raises(DocumentError, match="larger than 4 MB"):
        read_document(tmp_path / "huge.yaml")
    for raw, said in (
        (b"title: a\nname: caf\xe9\n", "2:10: is not UTF-8 text but has a byte 0xE9; save it as UTF-8"),
        ("a: 1".encode("utf-16"), "1:1: is not UTF-8 text but has UTF-16; save it as UTF-8"),
    ):
        (tmp_path / "binary.yaml").write_bytes(raw)
        with pytest.raises(DocumentError, match=rf"binary.yaml:{said}"):
            read_document(tmp_path / "binary.yaml")
    (tmp_path / "marked.yaml").write_bytes(b"\xef\xbb\xbfa: 1\r\n")
    assert read_document(tmp_path / "marked.yaml").data == {"a": 1}


@given(st.text(max_size=200))
def test_any_text_is_a_document_or_a_document_error(text: str) -> None:
    with contextlib.suppress(DocumentError):
        parse_document(text, "f.yaml").check(Whole)


def test_rules_may_look_at_data_of_any_shape() -> None:
    assert mapping({"a": {"b": {"c": 1}}}, "a", "b") == {"c": 1}
    assert mapping([1], "a") == {}
    assert sequence({"a": 3}, "a") == []
    assert number(True) is None
    assert number(2) == 2
