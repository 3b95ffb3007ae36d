"""What the console shows of takes: computed in its worker, because a take may be long."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from teleop.config.documents.document import DocumentError
from teleop.core.run_state import Result
from teleop.recording.reader import read_take
from teleop.recording.report import report
from teleop.recording.summary import Summary, summarize_index
from teleop.recording.topics import plain

COMPLETE = Result.DONE.name.lower()


def take_entry(file: str) -> dict[str, Any]:
    """A take in a list: what its index says of it."""
    path = Path(file)
    try:
        return {"name": path.stem, **_of_summary(summarize_index(path))}
    except DocumentError as error:
        return {"name": path.stem, "damaged": True, "ok": False, "problem": _text(error, path)}


def take_report(file: str) -> dict[str, Any]:
    """A take in full: the errors of each axis; `error` for one that cannot be read."""
    path = Path(file)
    try:
        take = read_take(path)
    except DocumentError as error:
        return {"error": _text(error, path)}
    axes = {axis.value: plain(of) for axis, of in report(take).items()}
    peaks = {name: found["peak"] for name, found in axes.items()}
    return {"axes": axes, "peaks": peaks, "seconds": round(take.duration, 3), "result": take.ended}


def take_page(file: str) -> dict[str, Any]:
    """The report as a page: `html`, or `error`."""
    from teleop.plots.report_html import page

    path = Path(file)
    try:
        take = read_take(path)
    except DocumentError as error:
        return {"error": _text(error, path)}
    found = report(take)
    return {"html": page(take, found)} if found else {"error": "the take is empty"}


def take_keys(file: str, tolerance: float) -> dict[str, Any]:
    """Keyframes fitted to a take: `text` of a sequence, and how far it is off; or `error`."""
    from teleop.config.documents.yaml_loader import parse_document
    from teleop.recording.to_keyframes.convert import keyframes

    path = Path(file)
    try:
        fitted = keyframes(read_take(path), tolerance)
    except DocumentError as error:
        return {"error": _text(error, path)}
    errors = {axis.value: {"error": round(each.size, 6), "time": each.time} for axis, each in fitted.errors.items()}
    content = parse_document(fitted.text, path.stem).data
    return {"text": fitted.text, "content": content, "keyframes": len(fitted.frames), "largest_errors": errors}


def _of_summary(found: Summary) -> Mapping[str, Any]:
    ending = found.ending
    return {
        "title": found.about.title,
        "rig": found.about.rig,
        "started": datetime.fromtimestamp(found.about.started, UTC).isoformat() if found.about.started else "",
        "seconds": round(found.seconds, 3),
        "result": "cut off" if ending is None else str(ending),
        "ok": ending is not None and not found.remark and ending.result == COMPLETE,
        "damaged": bool(found.remark),
        "problem": _without_folder(found.remark, found.path),
    }


def _text(error: DocumentError, path: Path) -> str:
    """What is wrong, without the folder, which is no business of a page."""
    return _without_folder(error.problems[0], path)


def _without_folder(text: str, path: Path) -> str:
    return text.removeprefix(f"{path}: ").replace(f"{path.parent}/", "")
