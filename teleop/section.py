"""What every section of a YAML file is checked by: known keys only, values taken as they are, nothing converted."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Finite = Annotated[float, Field(allow_inf_nan=False)]


class Section(BaseModel):
    """A mapping in a file, as an immutable object."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)
