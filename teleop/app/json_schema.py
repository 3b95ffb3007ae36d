"""The files that people write, as JSON Schema (draft 2020-12), so that an editor completes and checks them.

Made from the sections that check a file; the docstrings of their fields are the descriptions. What lies between values
(times in order, limits of a rig, links that exist) is outside a schema; `teleop check` finds it.
"""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise
from typing import Any, cast

from teleop.config.documents.base_model import Section

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
    sections = {section.__name__: section for section in _sections(Section)}
    for part in _objects(made):
        if section := sections.get(part.get("title", "")):
            _describe(part.get("properties", {}), section)
    for part in _objects(made):
        part.pop("title", None)
        if "description" in part:
            part["description"] = " ".join(part["description"].split())
    return {"$schema": DIALECT, "title": f"teleop {kind}", **made}


def _sections(section: type[Section]) -> Iterator[type[Section]]:
    for each in section.__subclasses__():
        yield each
        yield from _sections(each)


def _describe(properties: dict[str, dict[str, Any]], section: type[Section]) -> None:
    """Give each property the docstring of its field."""
    said = {name: text for each in reversed(section.__mro__) for name, text in _docstrings(each).items()}
    for name, field in section.model_fields.items():
        if name in said:
            key = field.alias or name
            properties[key] = {"description": said[name], **properties[key]}


def _docstrings(section: type) -> dict[str, str]:
    """What follows each annotation of a class, read from its source."""
    if section.__module__.partition(".")[0] != "teleop":
        return {}
    (definition,) = ast.parse(textwrap.dedent(inspect.getsource(section))).body
    found = {}
    for field, text in pairwise(cast("ast.ClassDef", definition).body):
        match field, text:
            case ast.AnnAssign(target=ast.Name(name)), ast.Expr(ast.Constant(str(said))):
                found[name] = inspect.cleandoc(said)
    return found


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
