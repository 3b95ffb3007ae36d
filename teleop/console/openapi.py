"""The HTTP interface described for programs: OpenAPI 3.1, served at `/api`."""

from __future__ import annotations

from functools import cache
from typing import Any

import teleop


@cache
def description() -> dict[str, Any]:
    """The description of everything under `/api`."""
    return {
        "openapi": "3.1.0",
        "info": {"title": "teleop console", "version": teleop.__version__},
        "paths": {},
    }
