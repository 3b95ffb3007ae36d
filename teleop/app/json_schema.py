"""The files that people write, as JSON Schema (draft 2020-12), so that an editor completes and checks them.

Made of the very sections that check a file, so that it cannot say something else. What stands in their docstrings as
"`key`: what it is" becomes the key's description. What lies between values (times in order, limits of a rig, links that
exist) no schema can say; `teleop check` does.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from teleop.config.base_model import Section

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def _sequence() -> type[Section]:
    from teleop.sequence.model import SequenceModel

    return SequenceModel


def _profile() -> type[Section]:
    from teleop.config.profile import Profile

    return Profile


def _pad() -> type[Section]:
    from teleop.config.inputs_section import PadSection

    return PadSection


KINDS: Mapping[str, Callable[[], type[Section]]] = {"sequence": _sequence, "profile": _profile, "pad": _pad}
"""The kinds of file, by the names of their schemas, and the section that such a file is."""


def schema(kind: str) -> dict[str, Any]:
    """The schema of a kind of file."""
    made = KINDS[kind]().model_json_schema(by_alias=True)
    for part in _objects(made):
        part.pop("title", None)
        for name, text in _described(part.get("description", "")):
            if name in part.get("properties", {}):
                part["properties"][name].setdefault("description", text)
        if "description" in part:
            part["description"] = part["description"].partition("\n\n")[0].replace("\n", " ")
    return {"$schema": DIALECT, "title": f"teleop {kind}", **made}


def _objects(part: Any) -> Iterator[dict[str, Any]]:
    """Every schema within a schema, but no value that happens to be called like a part of one."""
    if not isinstance(part, dict):
        return
    yield part
    for key in ("properties", "$defs"):
        for inner in part.get(key, {}).values():
            yield from _objects(inner)
    for key in ("anyOf", "oneOf", "allOf", "prefixItems"):
        for inner in part.get(key, []):
            yield from _objects(inner)
    for key in ("items", "additionalProperties", "propertyNames"):
        yield from _objects(part.get(key))


def _described(text: str) -> Iterator[tuple[str, str]]:
    """Each key that a docstring says something of, and the sentence that does."""
    for sentence in re.split(r"(?<=\.)\s+(?=[A-Z`])", text):
        whole = " ".join(sentence.split())
        names, colon, rest = whole.partition(": ")
        said = rest if colon and re.fullmatch(r"(`\w+`(, )?)+", names) else whole
        said = said.replace("`", "")
        for name in re.findall(r"`(\w+)`", whole):
            yield name, said[:1].upper() + said[1:]
