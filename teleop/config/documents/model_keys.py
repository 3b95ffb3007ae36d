"""The keys that a section of a file may have, found from pydantic's location of an error.

pydantic reports an unknown key without the model that refuses it, so its location is followed through the models: a
suggestion is a key of the mapping at hand, never of another section.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from pydantic import BaseModel

from teleop.config.documents.base_model import Section


def keys_at(model: type[BaseModel], location: Sequence[str | int]) -> list[str]:
    """The keys of the mapping at pydantic's `location`, as a file has them."""
    return sorted({key for section in _sections(model, location) for key, _ in _fields(section)})


def renamed_at(model: type[BaseModel], location: Sequence[str | int]) -> Mapping[str, str]:
    """Old keys of the mapping at `location`, and what they are called now."""
    found: dict[str, str] = {}
    for section in _sections(model, location):
        if issubclass(section, Section):
            found |= section.RENAMED
    return found


def _sections(model: type[BaseModel], location: Sequence[str | int]) -> list[type[BaseModel]]:
    kinds: list[Any] = [model]
    for part in location:
        kinds = [inner for kind in kinds for inner in _inside(kind, part)]
    return [kind for kind in kinds if _is_model(kind)]


def _inside(kind: Any, part: str | int) -> Iterator[Any]:
    """The types that a value of this kind may have at `part`: a key, an index or the tag of a union's member."""
    if not _is_model(kind):
        if arguments := get_args(kind):
            yield from _members(arguments[-1])
        return
    fields = dict(_fields(kind))
    if "type" in fields and part in get_args(fields["type"]):
        yield kind
    elif part in fields:
        yield from _members(fields[str(part)])


def _members(annotation: Any) -> Iterator[Any]:
    """The single types of an annotation, without Annotated and unions."""
    if get_origin(annotation) is Annotated:
        yield from _members(get_args(annotation)[0])
    elif get_origin(annotation) in (Union, UnionType):
        for member in get_args(annotation):
            yield from _members(member)
    else:
        yield annotation


def _is_model(kind: Any) -> bool:
    return isinstance(kind, type) and issubclass(kind, BaseModel)


def _fields(section: type[BaseModel]) -> Iterator[tuple[str, Any]]:
    for name, field in section.model_fields.items():
        yield field.alias or name, field.annotation
