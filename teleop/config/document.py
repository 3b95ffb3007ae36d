"""A file as plain values that know where they stand, checked with every error of it at once as file:line:column.

Whatever is wrong with it (what its text has that is not used here, what pydantic finds, what a module's own rules find)
is said together, in the file's order, and in the words of whoever wrote it. How text becomes values is `yaml_text`'s.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeVar

from teleop.config.messages import PHRASES, nearest
from teleop.core.errors import UsageError

if TYPE_CHECKING:
    from pydantic import BaseModel
    from pydantic_core import ErrorDetails

    Checked = TypeVar("Checked", bound=BaseModel)

MOST_TOLD = 200  # of what pydantic finds: to say it in words takes a millisecond each

Location = tuple[str | int, ...]
Place = tuple[int, int]  # line and column, from 1
Wrong = tuple[Location, str]  # where in the data, and what is wrong there


class DocumentError(UsageError):
    """A file that cannot be used: a line for each thing wrong with it, and how many more there are than `problems`."""

    def __init__(self, problems: Sequence[str], more: int = 0) -> None:
        super().__init__("\n".join(problems))
        self.problems, self.more = list(problems), more


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


@dataclass
class Document:
    """A YAML file as plain values, which knows where each of them stands. `note` ends every line about it.

    `flaws` are what its text has that is not used here: they are no values, and `check` reports them.
    """

    name: str
    data: Any = None
    places: dict[Location, Place] = field(default_factory=dict)
    keys: dict[Location, Place] = field(default_factory=dict)
    note: str = ""
    flaws: list[tuple[Place, str]] = field(default_factory=list)

    def line(self, path: Location, text: str) -> str:
        """One line for what is said elsewhere of something that stands at `path`."""
        return self._line(self.places[path], text)

    def problem(self, path: Location, text: str, *, key: bool = False) -> str:
        """One line for something wrong at `path`: at its value, at its `key`, or at the nearest thing around it."""
        places = (self.keys, self.places) if key else (self.places, self.keys)
        around = path
        while around and not any(around in known for known in places):
            around = around[:-1]
        place = next((known[around] for known in places if around in known), (1, 1))
        return self._line(place, f"{path_text(path)} {text}" if path else text)

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
            known = sorted(set(_property_names(model.model_json_schema())))
            found += [self._explain(detail, known) for detail in error.errors(include_url=False)[:MOST_TOLD]]
            more = max(0, error.error_count() - MOST_TOLD)
        if checked is None or found:
            raise DocumentError(sorted(found, key=_place_in), more)
        return checked

    def flawed(self) -> list[str]:
        """A line for each of the flaws: for whoever reads the data without a model."""
        return [self._line(place, text) for place, text in self.flaws]

    def _line(self, place: Place, text: str) -> str:
        line, column = place
        return f"{self.name}:{line}:{column}: {text}{self.note}"

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
