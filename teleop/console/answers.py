"""Answers in JSON, which no cache keeps."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response

from teleop.console.json_body import Refusal


def json_text(content: Mapping[str, Any]) -> str:
    """Compact JSON. Raises ValueError for NaN and infinity, which JSON has not."""
    return json.dumps(content, separators=(",", ":"), allow_nan=False, ensure_ascii=False)


def answer(content: Mapping[str, Any], status: int = 200, headers: Mapping[str, str] | None = None) -> Response:
    """`content` as JSON."""
    return Response(
        json_text(content).encode(), status, {"cache-control": "no-store", **(headers or {})}, "application/json"
    )


async def refused(_: Request, error: Exception) -> Response:
    """The answer to a request that was refused."""
    assert isinstance(error, Refusal)
    return answer(error.content, error.status, error.headers)


async def http_error(_: Request, error: Exception) -> Response:
    """Starlette's own errors: no such path, no such method."""
    assert isinstance(error, HTTPException)
    text = {404: "no such path", 405: "no such method here"}.get(error.status_code, error.detail)
    return answer({"error": text}, error.status_code, error.headers)


async def fault(_: Request, error: Exception) -> Response:
    """A fault of this program: the details stay here."""
    return answer({"error": f"the console failed: {type(error).__name__}"}, 500)
