"""What is in an OpenTimelineIO file, for `otio`: runs in a process of its own, because the library is C++."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from teleop.interchange.isolated import ExtractError

MOST_MARKERS = 10_000
MOST_CLIPS = 100_000


def extract(path: Path) -> dict[str, Any]:
    """Its name and rate, the markers at their times (s) in the whole timeline, and the path that teleop wrote."""
    otio = importlib.import_module("opentimelineio")
    try:
        timeline = otio.adapters.read_from_string(path.read_text("utf-8-sig"), "otio_json")
    except (otio.exceptions.OTIOError, UnicodeDecodeError, ValueError, TypeError, RecursionError) as error:
        raise ExtractError(f"is not OpenTimelineIO: {str(error)[:120]}") from None
    if not isinstance(timeline, otio.schema.Timeline):
        raise ExtractError("has no timeline")
    stack = timeline.tracks
    markers: list[dict[str, Any]] = []
    rate, path_found = 0.0, None
    for count, item in enumerate(_items(stack, otio)):
        if count > MOST_CLIPS:
            raise ExtractError(f"has more than {MOST_CLIPS} clips")
        own = _plain(item.metadata).get("teleop")
        if path_found is None and isinstance(own, dict) and "path" in own:
            path_found = own
        for marker in item.markers:
            if len(markers) >= MOST_MARKERS:
                raise ExtractError(f"has more than {MOST_MARKERS} markers")
            moment = item.transformed_time(marker.marked_range.start_time, stack)
            rate = rate or float(moment.rate)
            own = _plain(marker.metadata).get("teleop", {})
            markers.append(
                {"name": str(marker.name), "at": moment.to_seconds(), "rate": float(moment.rate), "own": own}
            )
    if not rate:
        rate = _rate(stack, otio)
    return {"name": str(timeline.name or ""), "rate": rate, "markers": markers, "path": path_found}


def _items(stack: Any, otio: Any) -> Iterator[Any]:
    yield stack
    for item in stack.find_children():
        if isinstance(item, otio.core.Item):
            yield item


def _plain(value: Any) -> Any:
    """Metadata as JSON has it."""
    if isinstance(value, str | int | float | bool) or value is None:
        return value
    if hasattr(value, "items"):
        return {str(key): _plain(each) for key, each in value.items()}
    if hasattr(value, "__iter__"):
        return [_plain(each) for each in value]
    return str(value)


def _rate(stack: Any, otio: Any) -> float:
    try:
        return float(stack.duration().rate)
    except otio.exceptions.OTIOError:
        return 0.0
