"""YAML text to a Document, refused before it can choke anyone.

The text is composed to nodes, which keep their places, and only then turned into values, so that an error found by
pydantic or by a later check can still say where it stands. Scalars follow YAML 1.2's core schema: PyYAML's own
rules read `1:30` as 90, `on` as true and `010` as 8. Nothing is merged, tagged or executed, keys stand once, and a
file whose size, depth or aliases would choke a parser is refused before it can.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import yaml

from teleop.config.documents.document import Document, DocumentError, Flaw, Location, Place, joined, path_text
from teleop.config.documents.messages import decimal_comma, missing_space
from teleop.config.documents.read_bytes import read_bytes
from teleop.config.documents.yaml_nodes import TooMuchError, compose
from teleop.core.plain import plain

MAX_BYTES = 4_000_000  # a sequence of 2000 keys is 0.2 MB
MAX_VALUES = 100_000  # after aliases are followed: 14 000 keyframes of four axes, more than can be planned
MAX_NODES = 160_000  # keys counted, aliases not followed
MAX_DEPTH = 32

_UNTAGGED = frozenset(f"tag:yaml.org,2002:{kind}" for kind in ("str", "seq", "map"))  # what PyYAML gives by default
_BREAK = re.compile(r"\r\n|\r|\n")  # YAML 1.2's; 1.1 has three more, which PyYAML still counts as lines
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff\ufffe\uffff]")
_SCALARS: Sequence[tuple[re.Pattern[str], Callable[[str], Any]]] = (
    (re.compile(r"~|null|Null|NULL|"), lambda _: None),
    (re.compile(r"true|True|TRUE"), lambda _: True),
    (re.compile(r"false|False|FALSE"), lambda _: False),
    (re.compile(r"[-+]?[0-9]{1,300}"), int),  # longer ones, of any base, are no float either, and stay text
    (re.compile(r"0o[0-7]{1,300}"), lambda text: int(text[2:], 8)),
    (re.compile(r"0x[0-9a-fA-F]{1,250}"), lambda text: int(text[2:], 16)),
    (re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?"), float),
    (re.compile(r"[-+]?\.(inf|Inf|INF)"), lambda text: float(text.replace(".", ""))),
    (re.compile(r"\.(nan|NaN|NAN)"), lambda _: float("nan")),
)


def read_document(file: Path, name: str | None = None, note: str = "") -> Document:
    """The file as a Document, called `name` in errors, which end with `note`.

    Raises DocumentError when it is not YAML of a sane size.
    """
    try:
        document = _read(file, name)
    except DocumentError as error:
        raise DocumentError([problem + note for problem in error.problems]) from None
    document.note = note
    return document


def _read(file: Path, name: str | None) -> Document:
    name = plain(name or str(file))
    raw = read_bytes(file, name, MAX_BYTES)
    try:
        return parse_document(raw.decode("utf-8-sig"), name)
    except UnicodeDecodeError as error:
        line, column = _place(raw[: error.start].decode("utf-8-sig"))
        what = "UTF-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else f"a byte 0x{raw[error.start]:02X}"
        raise DocumentError([f"{name}:{line}:{column}: is not UTF-8 text but has {what}; save it as UTF-8"]) from None


def parse_document(text: str, name: str) -> Document:
    """YAML text as a Document called `name` in errors; raises DocumentError."""
    document = Document(name)
    if found := _CONTROL.search(text):
        line, column = _place(text[: found.start()])
        raise DocumentError([f"{name}:{line}:{column}: not YAML: {_control(found[0])}"])
    try:
        node = compose(text, MAX_DEPTH, MAX_NODES)
        if node is None:
            raise DocumentError([f"{name}:1:1: the file is empty"])
        document.data = _Reading(document).value(node, (), 0)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        if problem := _missing_space(error, text):
            raise DocumentError([f"{name}:{problem}"]) from None
        place = f":{mark.line + 1}:{mark.column + 1}" if mark else ""
        raise DocumentError([f"{name}{place}: {_what(error, text)}"]) from None
    except yaml.YAMLError as error:
        raise DocumentError([f"{name}:1:1: not YAML: {str(error).splitlines()[0]}"]) from None
    except RecursionError:
        raise DocumentError([f"{name}:1:1: is nested too deeply"]) from None
    return document


def _place(before: str) -> Place:
    """Where the text after this one begins."""
    lines = _BREAK.split(before)
    return len(lines), len(lines[-1]) + 1


def _control(character: str) -> str:
    return f"a control character, U+{ord(character):04X}"


def _what(error: yaml.MarkedYAMLError, text: str) -> str:
    """What PyYAML says, where it is hard to understand in other words."""
    problem, mark = error.problem or error.context or "", error.problem_mark
    if isinstance(error, TooMuchError):
        return problem
    if mark and "cannot start any token" in problem and _BREAK.split(text)[mark.line][mark.column :][:1] == "\t":
        return "not YAML: a tab; indent with spaces"
    if "another document" in problem:
        return "not YAML: a second document begins here, and a file holds one"
    return f"not YAML: {problem}"


def _missing_space(error: yaml.MarkedYAMLError, text: str) -> str:
    """Place and text of a key without a space behind its colon, which PyYAML finds only in the line after it."""
    lines = _BREAK.split(text)
    marks = [mark for mark in (error.context_mark, error.problem_mark) if mark]
    numbers = {mark.line + offset for mark in marks for offset in (-1, 0)}
    for number in sorted(number for number in numbers if 0 <= number < len(lines)):
        word = lines[number].lstrip(" -")
        if found := missing_space(word.split(" #")[0].rstrip()):
            return f"{number + 1}:{len(lines[number]) - len(word) + 1}: {found}"
    return ""


class _Reading:
    """One walk over the nodes of a file, filling a document's values and places."""

    def __init__(self, document: Document) -> None:
        self._document, self._nodes = document, 0

    def value(self, node: yaml.Node, path: Location, depth: int) -> Any:
        self._document.places[path] = _start(node)
        self._nodes += 1
        if self._nodes > MAX_VALUES or depth > MAX_DEPTH:
            what = "holds too many values" if self._nodes > MAX_VALUES else "is nested too deeply"
            raise DocumentError([self._document.problem(path[:4], what + "; aliases count each time")])
        if node.tag not in _UNTAGGED:
            self._flaw(node, path, f"has a tag, {node.tag}; no tags are used here")
        if isinstance(node, yaml.MappingNode):
            return self._mapping(node, path, depth)
        if isinstance(node, yaml.SequenceNode):
            return [self.value(item, (*path, index), depth + 1) for index, item in enumerate(node.value)]
        assert isinstance(node, yaml.ScalarNode)
        if found := _CONTROL.search(node.value):  # it was written as an escape
            self._flaw(node, path, f"has {_control(found[0])}")
        return node.value if node.style else _scalar(node.value)

    def _mapping(self, node: yaml.MappingNode, path: Location, depth: int) -> dict[str, Any]:
        result: dict[str, Any] = {}
        before: tuple[str, yaml.Node] | None = None
        for key_node, value_node in node.value:
            key = key_node.value
            if not isinstance(key, str) or not key.isprintable() or not key:
                self._flaw(key_node, path, "has a key that is not a word")
                continue
            here = (*path, key)
            if key == "<<" and not key_node.style:
                self._flaw(key_node, here, "would merge, which YAML 1.2 does not: write out what it adds")
                continue
            if _is_bare(key_node, value_node):
                if before and self._is_decimal_comma(before, key_node, path, result):
                    continue
                if text := missing_space(key):
                    self._flaw(key_node, path, f": {text}")
                    key, _, rest = key.partition(":")
                    self._document.keys[*path, key] = self._document.places[*path, key] = _start(key_node)
                    result.setdefault(key, _scalar(rest))
                    continue
            self._document.keys[here] = _start(key_node)
            if key in result:
                self._flaw(key_node, here, ": duplicate key", duplicate=here)
            result[key] = self.value(value_node, here, depth + 1)
            before = key, value_node
        return result

    def _is_decimal_comma(
        self, before: tuple[str, yaml.Node], key_node: yaml.Node, path: Location, result: dict[str, Any]
    ) -> bool:
        """Whether this key is the 5 of `{pan: 20,5}`; the number is then taken as 20.5, so that one error is one."""
        name, value_node = before
        written = f"{value_node.value},{key_node.value}"
        adjacent = value_node.end_mark.index + 1 == key_node.start_mark.index
        text = decimal_comma(written) if adjacent else ""
        if text:
            self._flaw(value_node, (*path, name), f": {text}")
            result[name] = _scalar(written.replace(",", "."))
        return bool(text)

    def _flaw(self, node: yaml.Node, path: Location, text: str, duplicate: Location | None = None) -> None:
        self._document.flaws.append(Flaw(_start(node), joined(path_text(path), text), duplicate))


def _is_bare(key_node: yaml.Node, value_node: yaml.Node) -> bool:
    """Whether a key has no value and no colon of its own: a word between two commas."""
    if not isinstance(key_node, yaml.ScalarNode) or not isinstance(value_node, yaml.ScalarNode):
        return False
    return not key_node.style and not value_node.style and not value_node.value


def _start(node: yaml.Node) -> Place:
    return node.start_mark.line + 1, node.start_mark.column + 1


def _scalar(text: str) -> Any:
    for pattern, read in _SCALARS:
        if pattern.fullmatch(text):
            return read(text)
    return text
