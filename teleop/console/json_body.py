"""JSON from a client: bounded in size, depth and numbers before anything looks at it."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, cast

from starlette.requests import ClientDisconnect

from teleop.core.finite_json import loads

if TYPE_CHECKING:
    from starlette.requests import Request

MOST_BYTES = 64_000  # of a command or a WebSocket message
MOST_DEPTH = 12  # lists and mappings within each other
LONGEST_WAIT = 10.0  # s for the whole body of a request


class Refusal(Exception):  # noqa: N818 - the answer, not a fault
    """A request that is answered with `status` and `{"error": text, ...}`."""

    def __init__(self, status: int, text: str, headers: Mapping[str, str] | None = None, **more: Any) -> None:
        super().__init__(text)
        self.status, self.headers = status, dict(headers or {})
        self.content = {"error": text, **more}


def parse_object(text: str | bytes, most_depth: int = MOST_DEPTH) -> dict[str, Any]:
    """A JSON object with finite numbers, no deeper than `most_depth`. Raises Refusal (400)."""
    try:
        data = loads(text)
    except RecursionError:
        raise Refusal(400, f"too deep: at most {most_depth} levels") from None
    except (ValueError, UnicodeDecodeError) as error:
        raise Refusal(400, f"not JSON: {error}") from None
    if not isinstance(data, dict):
        raise Refusal(400, "must be a JSON object, as in {...}")
    _check(data, most_depth)
    return data


async def read_object(request: Request, most_bytes: int = MOST_BYTES, most_depth: int = MOST_DEPTH) -> dict[str, Any]:
    """The JSON object in a request. Raises Refusal: 400, 408 for a body that does not arrive, 413 for one too large."""
    try:
        async with asyncio.timeout(LONGEST_WAIT):
            return parse_object(await _body(request, most_bytes), most_depth)
    except TimeoutError:
        raise Refusal(408, f"the body did not arrive within {LONGEST_WAIT:g} s") from None


async def _body(request: Request, most_bytes: int) -> bytes:
    length = request.headers.get("content-length", "0")
    too_large = Refusal(413, f"too large: at most {most_bytes} bytes")
    if length.isascii() and length.isdigit() and int(length[:20]) > most_bytes:
        raise too_large
    parts, size = [], 0
    try:
        async for part in request.stream():
            size += len(part)
            if size > most_bytes:
                raise too_large
            parts.append(part)
    except ClientDisconnect:
        raise Refusal(400, "the body is cut off") from None
    return b"".join(parts)


def _check(value: Any, depth: int) -> None:
    """Raises Refusal for what is too deep, or text that UTF-8 cannot hold."""
    if isinstance(value, str):
        try:
            value.encode()
        except UnicodeEncodeError:
            raise Refusal(400, "not JSON: half of a surrogate pair") from None
    elif isinstance(value, dict | list):
        if depth <= 0:
            raise Refusal(400, "too deep")
        inner = cast("dict[str, Any] | list[Any]", value)
        if isinstance(inner, dict):
            for key in inner:
                _check(key, depth)
            inner = list(inner.values())
        for each in inner:
            _check(each, depth - 1)
