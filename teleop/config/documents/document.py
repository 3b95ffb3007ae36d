"""A file as plain values that know where they stand, checked with every error of it at once as file:line:column.

All mistakes (unused keys, what pydantic finds, what a module's own rules find) are reported together, in the file's
order and in the file's own words. `yaml_loader` turns its text into values.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from teleop.config.documents.messages import PHRASES, likely_key, missing_space, unknown_key
from teleop.core.errors import UsageError
from teleop.core.plain import plain

if TYPE_CHECKING:
    from pydantic import BaseModel
    from pydantic_core import ErrorDetails

    Checked = TypeVar("Checked", bound=BaseModel)

MOST_REPORTED = 200  # of pydantic's errors: the text of each takes a millisecond

Location = tuple[str | int, ...]
Place = tuple[int, int]  # line and column, from 1
Wrong = tuple[Location, str]  # where in the data, and what is wrong there


class DocumentError(UsageError):
    """A file that cannot be used: a line for each thing wrong with it, and how many more there are than `problems`."""

    def __init__(self, problems: Sequence[str], more: int = 0) -> None:
        self.problems, self.more = list(map(plain, problems)), more
        super().__init__("\n".join(self.problems))


ENTRIES = {"keyframes": "key", "cues": "cue", "include": "include", "panorama": "shot"}
"""Lists whose entries people count, from 1, and what one of them is called."""


def numbered(name: str, index: int) -> str:
    """What people call an entry of a list, in errors, options and previews alike: `key 4` is `keyframes[3]`."""
    return f"{ENTRIES[name]} {index + 1}"


def path_text(path: Location) -> str:
    """A place in a document as people say it: `key 4: at`, `sinks[0].rate`."""
    match path:
        case (str(name), int(index), *rest) if name in ENTRIES:
            return ": ".join(filter(None, [numbered(name, index), path_text(tuple(rest))]))
    text = ""
    for part in path:
        text += f"[{part}]" if isinstance(part, int) else f".{part}" if text else part
    return text


class UnplayableError(DocumentError):
    """A file that is right in itself and asks for what this rig cannot do."""


class Flaw(NamedTuple):
    """An error in the text of a file that leaves no value behind: a duplicate key, a tag, a missing space."""

    place: Place
    text: str
    duplicate: Location | None = None  # the key that is in the mapping twice

    def is_duplicate_in(self, path: Location) -> bool:
        """Whether it is a duplicate key of the mapping at `path`."""
        return self.duplicate is not None and self.duplicate[:-1] == path


@dataclass
class Document:
    """A YAML file as plain values, with the line and column of each. `note` ends every error line.

    `check` reports its `flaws`.
    """

    name: str
    data: Any = None
    places: dict[Location, Place] = field(default_factory=dict)
    keys: dict[Location, Place] = field(default_factory=dict)
    note: str = ""
    flaws: list[Flaw] = field(default_factory=list)

    def line(self, path: Location, text: str) -> str:
        """One line of a message about the value at `path`."""
        return self._line(self.places[path], text)

    def problem(self, path: Location, text: str, *, key: bool = False) -> str:
        """One line for something wrong at `path`: at its value, at its `key`, or at the nearest thing around it."""
        places = (self.keys, self.places) if key else (self.places, self.keys)
        around = path
        while around and not any(around in known for known in places):
            around = around[:-1]
        place = next((known[around] for known in places if around in known), (1, 1))
        return self._line(place, joined(path_text(path), text))

    def check(self, model: type[Checked], wrong: Iterable[Wrong] = ()) -> Checked:
        """The document as a `model`; raises DocumentError with a line for everything wrong with it.

        `wrong` is what the caller's own rules found in the plain data: reported together with pydantic's findings.
        """
        from pydantic import ValidationError

        found = self.flawed()
        found += [self.problem(location, text) for location, text in wrong]
        checked, more = None, 0
        try:
            checked = model.model_validate(self.data)
        except ValidationError as error:
            details = _without_misspelled(model, error.errors(include_url=False)[:MOST_REPORTED])
            found += [self._explain(detail, model) for detail in details]
            found = self._without_duplicates_below(details, found)
            more = max(0, error.error_count() - MOST_REPORTED)
        if checked is None or found:
            raise DocumentError(sorted(found, key=_place_in), more)
        return checked

    def flawed(self) -> list[str]:
        """A line for each flaw, for a caller that checks the data without a model."""
        return [self._line(flaw.place, flaw.text) for flaw in self.flaws]

    def _line(self, place: Place, text: str) -> str:
        line, column = place
        return f"{self.name}:{line}:{column}: {text}{self.note}"

    def _explain(self, detail: ErrorDetails, model: type[BaseModel]) -> str:
        context, value = detail.get("ctx", {}), detail["input"]
        is_key = detail["loc"][-1:] == ("[key]",)
        path = self._path(detail["loc"][:-1] if is_key else detail["loc"])
        kind = detail["type"]
        if kind == "extra_forbidden":
            from teleop.config.documents.model_keys import keys_at, renamed_at

            level, key = detail["loc"][:-1], str(path[-1])
            return self.key_problem(path, unknown_key(key, keys_at(model, level), renamed_at(model, level)))
        if kind == "model_type" and (text := missing_space(value)):
            return self.problem(path, f": {text}")
        phrase = PHRASES.get(kind)
        text = phrase(context, value) if phrase else f"is wrong: {detail['msg']}"
        return self.problem(path, text, key=is_key)

    def key_problem(self, path: Location, text: str) -> str:
        """One line at the key where `path` ends, about the mapping that has it: `key 1: unknown key ...`."""
        around = path_text(path[:-1])
        return self._line(self.keys.get(path, (1, 1)), f"{around}: {text}" if around else text)

    def _without_duplicates_below(self, details: Sequence[ErrorDetails], found: list[str]) -> list[str]:
        """Without the duplicate keys of a list whose entries lack their `- `: those are one mistake, not many."""
        for detail in details:
            if detail["type"] == "list_type" and isinstance(detail["input"], dict):
                path = self._path(detail["loc"])
                lines = {self._line(flaw.place, flaw.text) for flaw in self.flaws if flaw.is_duplicate_in(path)}
                found = [line for line in found if line not in lines]
        return found

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


def joined(subject: str, text: str) -> str:
    """`key 1: pan` and what is wrong; text that begins with a colon is a sentence of its own."""
    if not subject:
        return text.removeprefix(": ")
    return f"{subject}{text}" if text.startswith(":") else f"{subject} {text}"


def _without_misspelled(model: type[BaseModel], details: Sequence[ErrorDetails]) -> list[ErrorDetails]:
    """Without "at is missing" where `time` is an unknown key: a key under a wrong name is one error."""
    from teleop.config.documents.model_keys import keys_at, renamed_at

    named: set[Location] = set()
    for detail in details:
        if detail["type"] == "extra_forbidden":
            *level, key = detail["loc"]
            renamed = renamed_at(model, level)
            named.add((*level, renamed.get(str(key)) or likely_key(str(key), keys_at(model, level))))
    return [detail for detail in details if detail["type"] != "missing" or detail["loc"] not in named]


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
