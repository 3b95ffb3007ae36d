"""`teleop schema KIND`: what an editor needs to complete and check the files of this program."""

from __future__ import annotations

import json
from typing import Annotated, Literal

from cyclopts import Parameter

from teleop.app.json_schema import schema as schema_of


def schema(
    kind: Annotated[Literal["sequence", "profile", "pad"], Parameter(help="Which kind of file.")],
    /,
) -> int:
    """Print the JSON Schema (draft 2020-12) of a kind of file, for editors."""
    print(json.dumps(schema_of(kind), indent=2, ensure_ascii=False))
    return 0
