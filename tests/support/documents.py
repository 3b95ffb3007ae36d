"""A small kind of file, to be wrong in."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from teleop.config.documents.base_model import Section


class Part(Section):
    size: Annotated[float, Field(gt=0)]
    name: str = ""


class Whole(Section):
    parts: list[Part]
    count: int = 0
