"""Keeps how the axes of gimbals were found to answer, from one run to the next: `teleop doctor` shows it.

What was found is of a rig's name, the gimbal's version, the kind of link, the mode and the payload (`Key`), for each
axis. Each axis of each key has a small file of its own, written whole or not at all, so that two programs at once never
lose what the other one found. A file that cannot be read is reported, and neither used nor replaced until
`teleop forget` clears it.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping
from datetime import UTC, datetime
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

from teleop.config.files import OutputError, write_text
from teleop.config.folders import state_folder
from teleop.core.axes import Axis
from teleop.core.response import Response

FORMAT, VERSION = "teleop response", 1
ENDING = ".json"
RANGES: Mapping[str, tuple[float, float]] = {
    "dead_time": (0, 1),
    "lag": (0, 2),
    "gain": (0.1, 3),
    "drift": (-10, 10),
    "delay_doubt": (0, math.inf),
    "gain_doubt": (0, math.inf),
    "drift_doubt": (0, math.inf),
}
"""Of each value of a Response: beyond them a file is damaged."""


class Key(NamedTuple):
    """What a response is of. `rig` is a profile's name; `version` is "" for a gimbal that does not answer for it."""

    rig: str
    version: str
    link: str
    mode: str
    payload: str


class Kept(NamedTuple):
    """The `response` of an axis as it was found at a time (`found`, ISO 8601 in UTC)."""

    key: Key
    axis: Axis
    response: Response
    found: str


def default_folder() -> Path:
    """Where responses are kept. Raises UsageError where there is no home directory."""
    return state_folder("set XDG_STATE_HOME, to keep how the axes answer") / "responses"


class ResponseStore:
    """The files in `folder`, which need not exist. After `read`, `damaged` are those that cannot be read."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.damaged: list[Path] = []

    def read(self, rig: str | None = None) -> list[Kept]:
        """What is kept for a rig, or for all of them; by rig, then key, then axis."""
        self.damaged = []
        found: list[Kept] = []
        for path in self._files(rig):
            try:
                found.append(_kept(json.loads(path.read_text(encoding="utf-8"))))
            except FileNotFoundError:  # another program has cleared it just now
                continue
            except (OSError, ValueError, KeyError, TypeError, AttributeError):
                self.damaged.append(path)
        return sorted(found, key=lambda each: (each.key, list(Axis).index(each.axis)))

    @property
    def damage(self) -> str:
        """A line about the damaged files, "" without any."""
        if not self.damaged:
            return ""
        more = len(self.damaged) - 1
        return (
            f"{self.damaged[0]}{f' and {more} more' if more else ''}: damaged, not used and not replaced:"
            " clear it with teleop forget"
        )

    def holds(self, rig: str) -> bool:
        """Whether anything is kept under this name, be it damaged."""
        return any(self._files(rig))

    def keep(self, key: Key, axis: Axis, response: Response) -> bool:
        """Write it in place of what was kept; False where that is damaged. Raises OutputError."""
        path = self._path(key, axis)
        if path in self.damaged:
            return False
        content = {
            "format": FORMAT,
            "version": VERSION,
            "key": key._asdict(),
            "axis": axis.value,
            "found": datetime.now(UTC).isoformat(timespec="milliseconds"),
            "response": {name: _written(value) for name, value in response._asdict().items()},
        }
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise OutputError(path, error.strerror or str(error)) from None
        write_text(path, json.dumps(content, indent=1) + "\n")
        return True

    def drop(self, key: Key, axis: Axis) -> None:
        """Keep nothing of this axis any more."""
        path = self._path(key, axis)
        if path not in self.damaged:
            _remove(path)

    def forget(self, rig: str | None = None) -> list[Path]:
        """Clear what is kept for a rig, or for all, damaged files included; the files. Raises OutputError."""
        files = list(self._files(rig))
        for path in files:
            _remove(path)
        return files

    def _files(self, rig: str | None) -> Iterator[Path]:
        folder = f"{_folder_name(rig)}/" if rig is not None else "*/"
        return iter(sorted(self._folder.glob(f"{folder}*{ENDING}")))

    def _path(self, key: Key, axis: Axis) -> Path:
        return self._folder / _folder_name(key.rig) / f"{_hash('|'.join(map(repr, key[1:])))}-{axis}{ENDING}"


def _folder_name(rig: str) -> str:
    """Readable, and another one for each name."""
    slug = re.sub(r"[^a-z0-9]+", "-", rig.lower()).strip("-")[:40]
    return f"{slug or 'rig'}-{_hash(rig)}"


def _hash(text: str) -> str:
    return sha256(text.encode()).hexdigest()[:8]


def _remove(path: Path) -> None:
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(path, error.strerror or str(error)) from None


def _written(value: float) -> float | None:
    return round(value, 6) if math.isfinite(value) else None


def _kept(content: Any) -> Kept:
    """Raises ValueError, KeyError and TypeError for anything else than what `keep` writes."""
    if content["format"] != FORMAT or content["version"] != VERSION:
        raise ValueError("not a response of this version")
    key = Key(**content["key"])
    if not all(isinstance(each, str) for each in (*key, content["found"])):
        raise ValueError("not a key")
    return Kept(key, Axis(content["axis"]), Response(**_values(content["response"])), content["found"])


def _values(written: Mapping[str, Any]) -> dict[str, float]:
    values = {name: math.inf if written[name] is None else float(written[name]) for name in Response._fields}
    if not all(low <= values[name] <= high for name, (low, high) in RANGES.items()):
        raise ValueError("a value is out of its range")
    return values
