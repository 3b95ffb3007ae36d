"""What the `teleop take` commands share: their options, and how they speak of takes."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

from teleop.cli.screens.folded import complain
from teleop.config.documents.document import DocumentError
from teleop.config.files import check_place, is_stream
from teleop.core.errors import UsageError
from teleop.recording.messages import Ending

Json = Annotated[bool, Parameter(name="--json", help="Print JSON, for programs.", negative=(), show_default=False)]
Overwrite = Annotated[
    bool,
    Parameter(help="Replace an existing file.", negative=(), show_default=False),
]
TakeFile = Annotated[Path, Parameter(help="A recorded run (.mcap).")]


@contextmanager
def problems_as_json(as_json: bool) -> Iterator[None]:
    """With --json a file that cannot be used is an object too, as for `check`."""
    try:
        yield
    except DocumentError as error:
        if as_json:
            print(json.dumps({"ok": False, "problems": error.problems}))
        raise


def place(option: str, path: Path, overwrite: bool, original: Path) -> None:
    """As `check_free`, and never over the take itself."""
    if path.resolve() == original.resolve():
        raise UsageError(f"{option} {path}: is the take itself; choose another file")
    check_free(option, path, overwrite)


def check_free(option: str, path: Path, overwrite: bool) -> None:
    """Raises UsageError where another file may not be replaced, OutputError where nothing can be written."""
    if path.exists() and not (overwrite or is_stream(path)):
        raise UsageError(f"{option} {path}: already exists; give --overwrite to replace it")
    check_place(path)


def notify(remark: str) -> None:
    """A remark about the file, where errors are read."""
    if remark:
        complain(remark)


def recorded_on(started: float) -> str:
    """The local date and time of `started` (s since 1970)."""
    return datetime.fromtimestamp(started).astimezone().isoformat(sep=" ", timespec="seconds")


def length(seconds: float) -> str:
    """A duration as people read it: seconds, from two minutes on as hours, minutes and seconds."""
    if seconds < 120:
        return f"{seconds:.2f} s"
    whole = round(seconds)
    return f"{whole // 3600}:{whole // 60 % 60:02}:{whole % 60:02}"


def ending_facts(ending: Ending | None) -> Mapping[str, Any]:
    """How a run ended, for programs; null where the file does not say it."""
    if ending is None:
        return {"result": None, "reasons": [], "dropped": None}
    return {"result": ending.result, "reasons": list(ending.reasons), "dropped": ending.dropped}
