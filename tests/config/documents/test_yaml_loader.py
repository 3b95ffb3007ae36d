"""YAML 1.2 values, and texts and files that are refused before they can choke a parser or a screen."""

import contextlib

import pytest
from documents import Whole
from hypothesis import given
from hypothesis import strategies as st

from teleop.config.documents.document import DocumentError
from teleop.config.documents.yaml_loader import parse_document, read_document


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
