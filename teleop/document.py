"""YAML text to checked objects, with every error of a file at once, each as file:line:column.

The text is composed to nodes, which keep their places, and only then turned into values, so that an error found by
pydantic or by a later check can still say where it stands. Scalars follow YAML 1.2's core schema: PyYAML's own
rules read `1:30` as 90, `on` as true and `010` as 8. Nothing is merged, tagged or executed, keys stand once, and a
file whose size, depth or aliases would choke a parser is refused before it can.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import yaml

from teleop.nodes import TooMuchError, compose
from teleop.phrases import PHRASES, nearest
from teleop.ports import UsageError

if TYPE_CHECKING:
    from pydantic import BaseModel
    from pydantic_core import ErrorDetails

    Checked = TypeVar("Checked", bound=BaseModel)

MAX_BYTES = 4_000_000  # a sequence of 2000 keys is 0.2 MB
MAX_VALUES = 100_000  # after aliases are followed: 14 000 keyframes of four axes, which nobody writes or can plan
MAX_NODES = 160_000  # keys counted, aliases not followed
MAX_DEPTH = 32
MOST_TOLD = 200  # of what pydantic finds: to say it in words takes a millisecond each

Location = tuple[str | int, ...]
Place = tuple[int, int]  # line and column, from 1
Wrong = tuple[Location, str]  # where in the data, and what is wrong there

_UNTAGGED = frozenset(f"tag:yaml.org,2002:{kind}" for kind in ("str", "seq", "map"))  # what PyYAML gives by default
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]")
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


class DocumentError(UsageError):
    """A file that cannot be used: a line for each thing wrong with it, and how many more there are than `problems`."""

    def __init__(self, problems: Sequence[str], more: int = 0) -> None:
        super().__init__("\n".join(problems))
        self.problems, self.more = list(problems), more


def path_text(path: Location) -> str:
    """A place in a document as its user writes it: `keyframes[3].at`."""
    text = ""
    for part in path:
        text += f"[{part}]" if isinstance(part, int) else f".{part}" if text else part
    return text


class UnplayableError(DocumentError):
    """A file that is right in itself and asks for what this rig cannot do."""


@dataclass
class Document:
    """A YAML file as plain values, which knows where each of them stands. `note` ends every line about it."""

    name: str
    data: Any = None
    places: dict[Location, Place] = field(default_factory=dict)
    keys: dict[Location, Place] = field(default_factory=dict)
    note: str = ""

    def line(self, path: Location, text: str) -> str:
        """One line for what is said elsewhere of something that stands at `path`."""
        line, column = self.places[path]
        return f"{self.name}:{line}:{column}: {text}{self.note}"

    def problem(self, path: Location, text: str, *, key: bool = False) -> str:
        """One line for something wrong at `path`: at its value, at its `key`, or at the nearest thing around it."""
        places = (self.keys, self.places) if key else (self.places, self.keys)
        around = path
        while around and not any(around in known for known in places):
            around = around[:-1]
        line, column = next((known[around] for known in places if around in known), (1, 1))
        said = f"{path_text(path)} {text}" if path else text
        return f"{self.name}:{line}:{column}: {said}{self.note}"

    def check(self, model: type[Checked], wrong: Iterable[Wrong] = ()) -> Checked:
        """The document as a `model`; raises DocumentError with a line for everything wrong with it.

        `wrong` is what the caller's own rules found in the plain data: reported together with pydantic's findings.
        """
        from pydantic import ValidationError

        found = [self.problem(location, text) for location, text in wrong]
        checked, more = None, 0
        try:
            checked = model.model_validate(self.data)
        except ValidationError as error:
            known = sorted(set(_property_names(model.model_json_schema())))
            found += [self._explain(detail, known) for detail in error.errors(include_url=False)[:MOST_TOLD]]
            more = max(0, error.error_count() - MOST_TOLD)
        if checked is None or found:
            raise DocumentError(sorted(found, key=_place_in), more)
        return checked

    def _explain(self, detail: ErrorDetails, known: Sequence[str]) -> str:
        context = detail.get("ctx", {})
        is_key = detail["loc"][-1:] == ("[key]",)
        path = self._path(detail["loc"][:-1] if is_key else detail["loc"])
        kind = detail["type"]
        if kind == "extra_forbidden":
            others = [name for name in known if name != path[-1]]  # it is known, but elsewhere
            return self.problem(path, "is not known here" + nearest(str(path[-1]), others), key=True)
        phrase = PHRASES.get(kind)
        text = phrase(context, detail["input"]) if phrase else f"is wrong: {detail['msg']}"
        return self.problem(path, text, key=is_key)

    def _path(self, location: Location) -> Location:
        """pydantic's location without the parts that name a union's member and stand in no file."""
        path: Location = ()
        value = self.data
        for index, part in enumerate(location):
            try:
                value = value[part]
            except (KeyError, IndexError, TypeError):
                if index + 1 < len(location):
                    continue
                if isinstance(value, Mapping) and value.get("type") == part:
                    continue
            path += (part,)
        return path


def mapping(data: Any, *keys: str) -> Mapping[str, Any]:
    """What stands below `keys`, or nothing where the data is not of that shape: for rules that run beside pydantic."""
    value = _below(data, keys)
    return value if isinstance(value, Mapping) else {}


def sequence(data: Any, *keys: str) -> Sequence[Any]:
    """The list below `keys`, or nothing where the data is not of that shape."""
    value = _below(data, keys)
    return value if isinstance(value, list) else []


def _below(data: Any, keys: Sequence[str]) -> Any:
    for key in keys:
        data = data.get(key) if isinstance(data, Mapping) else None
    return data


def number(value: Any) -> float | None:
    """The value where it is a number, else None."""
    return value if isinstance(value, int | float) and not isinstance(value, bool) else None


def _place_in(problem: str) -> Place:
    """The place that a problem's text begins with, so that a file's errors stand in its order."""
    found = re.search(r":(\d+):(\d+): ", problem)
    return (int(found[1]), int(found[2])) if found else (0, 0)


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
    name = name or str(file)
    try:
        with file.open("rb") as stream:
            raw = stream.read(MAX_BYTES + 1)
        if len(raw) > MAX_BYTES:
            raise DocumentError([f"{name}: is larger than {MAX_BYTES // 1_000_000} MB"])
        return parse_document(raw.decode("utf-8-sig"), name)
    except OSError as error:
        raise DocumentError([f"{name}: cannot be read: {error.strerror or error}"]) from None
    except UnicodeDecodeError as error:
        raise DocumentError([f"{name}: is not UTF-8 text (byte {error.start})"]) from None


def parse_document(text: str, name: str) -> Document:
    """YAML text as a Document called `name` in errors; raises DocumentError."""
    document = Document(name)
    problems: list[str] = []
    if found := _CONTROL.search(text):
        line = text.count("\n", 0, found.start()) + 1
        column = found.start() - text.rfind("\n", 0, found.start())
        raise DocumentError([f"{name}:{line}:{column}: not YAML: a control character, U+{ord(found[0]):04X}"])
    try:
        node = compose(text, MAX_DEPTH, MAX_NODES)
        if node is None:
            raise DocumentError([f"{name}:1:1: the file is empty"])
        document.data = _Reading(document, problems).value(node, (), 0)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f":{mark.line + 1}:{mark.column + 1}" if mark else ""
        what = "" if isinstance(error, TooMuchError) else "not YAML: "
        raise DocumentError([f"{name}{place}: {what}{error.problem or error.context}"]) from None
    except yaml.YAMLError as error:
        raise DocumentError([f"{name}: not YAML: {str(error).splitlines()[0]}"]) from None
    except RecursionError:
        raise DocumentError([f"{name}: is nested too deeply"]) from None
    if problems:
        raise DocumentError(problems)
    return document


class _Reading:
    """One walk over the nodes of a file, filling a document's values and places."""

    def __init__(self, document: Document, problems: list[str]) -> None:
        self._document, self._problems, self._nodes = document, problems, 0

    def value(self, node: yaml.Node, path: Location, depth: int) -> Any:
        place = (node.start_mark.line + 1, node.start_mark.column + 1)
        self._document.places[path] = place
        self._nodes += 1
        if self._nodes > MAX_VALUES or depth > MAX_DEPTH:
            what = "holds too many values" if self._nodes > MAX_VALUES else "is nested too deeply"
            raise DocumentError([self._document.problem(path[:4], what + "; aliases count each time")])
        if node.tag not in _UNTAGGED:
            self._problems.append(self._document.problem(path, f"has a tag, {node.tag}; no tags are used here"))
        if isinstance(node, yaml.MappingNode):
            return self._mapping(node, path, depth)
        if isinstance(node, yaml.SequenceNode):
            return [self.value(item, (*path, index), depth + 1) for index, item in enumerate(node.value)]
        assert isinstance(node, yaml.ScalarNode)
        return node.value if node.style else _scalar(node.value)

    def _mapping(self, node: yaml.MappingNode, path: Location, depth: int) -> dict[str, Any]:
        result: dict[str, Any] = {}
        for key_node, value_node in node.value:
            if not isinstance(key_node, yaml.ScalarNode):
                self._problems.append(self._document.problem(path, "has a key that is not a word"))
                continue
            key = key_node.value
            here = (*path, key)
            twice = key in result
            self._document.keys[here] = (key_node.start_mark.line + 1, key_node.start_mark.column + 1)
            if twice:
                self._problems.append(self._document.problem(here, "stands here for the second time", key=True))
            result[key] = self.value(value_node, here, depth + 1)
        return result


def _scalar(text: str) -> Any:
    for pattern, read in _SCALARS:
        if pattern.fullmatch(text):
            return read(text)
    return text


def _property_names(schema: Any) -> Iterator[str]:
    if isinstance(schema, dict):
        properties = schema.get("properties")
        if isinstance(properties, dict):
            yield from properties
        for value in schema.values():
            yield from _property_names(value)
    elif isinstance(schema, list):
        for value in schema:
            yield from _property_names(value)
