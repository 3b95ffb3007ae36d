"""Presets: numbered positions, and marks of the focus, kept in a file between runs.

    presets:
      1: {pan: 10.0, tilt: -3.2, name: "wide"}
    focus_marks: {A: 0.25, B: 0.8}

The control thread only changes what is in memory; a thread of their own writes the file, whole and beside the old one,
which it then replaces. A disk that is full costs the file and not the run, and is reported once for each change.
"""

from __future__ import annotations

import json
import re
import threading
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field

from teleop.config.documents.base_model import PositionsSection, Section
from teleop.config.documents.document import Wrong, mapping, number
from teleop.config.documents.yaml_loader import read_document
from teleop.config.files import OutputError, write_text
from teleop.config.folders import state_folder
from teleop.core.axes import Axis, Limits

DIGITS = 4  # behind the point: finer than any gimbal measures
WRITE_TIMEOUT = 5.0  # s to wait at the end for a disk that does not answer
MARKS = ("A", "B", "C")
_NUMBER = re.compile(r"\d{1,3}")


class PresetSection(PositionsSection):
    """What stands in the file: positions in the axes' units, and what to call them."""

    name: str = ""
    """Name of the preset on screens."""


class PresetsFile(Section):
    presets: dict[str, PresetSection] = Field(default_factory=dict)
    """The presets by their numbers."""

    focus_marks: dict[Literal["A", "B", "C"], Annotated[float, Field(ge=0, le=1)]] = Field(default_factory=dict)
    """Marks of the focus ring: 0 near to 1 far."""


@dataclass(frozen=True)
class Preset:
    positions: Mapping[Axis, float]
    name: str = ""


def default_file(profile: str) -> Path:
    """Where the presets of the profile called so are kept; raises UsageError when there is no home for them."""
    name = re.sub(r"\W+", "-", profile.casefold()).strip("-_") or "rig"
    return state_folder("say where to keep presets with --presets FILE") / f"presets-{name}.yaml"


class Presets:
    """The presets of one rig, as they are now; `names` of them by number, "" for one that has none.

    `marks` are those of the focus.
    """

    def __init__(
        self,
        file: Path,
        presets: Mapping[int, Preset] | None = None,
        messages: Sequence[str] = (),
        marks: Mapping[str, float] | None = None,
    ) -> None:
        self._file = file
        self._presets = dict(presets or {})
        self.marks: Mapping[str, float] = dict(marks or {})
        self.names: Mapping[int, str] = {}
        self.changes = 0
        self._messages = deque(messages)
        self._changed = threading.Condition()
        self._unsaved: tuple[Mapping[int, Preset], Mapping[str, float]] | None = None
        self._closing = False
        self._writer: threading.Thread | None = None
        self._name()

    def get(self, number: int) -> Preset | None:
        return self._presets.get(number)

    def store(self, number: int, positions: Mapping[Axis, float], name: str | None = None) -> None:
        """Positions of these axes, from now on; what the preset had of others stays, and its name without a new one."""
        before = self._presets.get(number, Preset({}))
        rounded = {axis: round(position, DIGITS) + 0.0 for axis, position in positions.items()}
        self._presets[number] = Preset({**before.positions, **rounded}, before.name if name is None else name)
        self._save()

    def delete(self, number: int) -> bool:
        """Whether there was one."""
        known = self._presets.pop(number, None) is not None
        if known:
            self._save()
        return known

    def mark(self, name: str, position: float | None) -> None:
        """A mark of the focus from now on; None deletes it."""
        kept = {each: at for each, at in self.marks.items() if each != name}
        if position is not None:
            kept[name] = round(position, DIGITS) + 0.0
        self.marks = dict(sorted(kept.items()))
        self._save()

    def new_messages(self) -> Iterator[str]:
        """What the operator has to know since the last time: a file that could not be written."""
        while self._messages:
            yield self._messages.popleft()

    def close(self) -> None:
        """Wait for what is being written, but not for ever."""
        with self._changed:
            self._closing = True
            self._changed.notify()
        if self._writer:
            self._writer.join(WRITE_TIMEOUT)

    def _save(self) -> None:
        self.changes += 1
        self._name()
        with self._changed:
            self._unsaved = dict(self._presets), self.marks
            self._changed.notify()
        if self._writer is None:
            self._writer = threading.Thread(target=self._write_changes, name="presets", daemon=True)
            self._writer.start()

    def _name(self) -> None:
        self.names = {number: preset.name for number, preset in sorted(self._presets.items())}

    def _write_changes(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._unsaved is not None or self._closing)
                kept, self._unsaved = self._unsaved, None
            if kept is None:
                return
            try:
                write_presets(self._file, *kept)
            except OutputError as error:
                self._messages.append(f"presets are not saved: {self._file}: {error.reason}")


def read_presets(file: Path, limits: Mapping[Axis, Limits], rig: str) -> Presets:
    """The presets in the file, none when it is not there yet; raises DocumentError with a line for everything wrong.

    What only this rig cannot do, because it lacks an axis or its soft limits lie nearer, is left for `new_messages`.
    """
    if not file.exists():
        return Presets(file)
    document = read_document(file)
    checked = document.check(PresetsFile, _rules(document.data))
    presets = {int(key): _preset(section) for key, section in checked.presets.items()}
    messages = [
        document.problem(("presets", str(number), axis.value), text)
        for number, preset in presets.items()
        for axis, position in preset.positions.items()
        if (text := _beyond(axis, position, limits, rig))
    ]
    return Presets(file, presets, messages, {str(name): at for name, at in checked.focus_marks.items()})


def _rules(data: Any) -> Iterator[Wrong]:
    for key, section in mapping(data, "presets").items():
        if not _NUMBER.fullmatch(key) or str(int(key)) != key:
            yield ("presets", key), "must be a number from 0 to 999"
        section = mapping(section)
        if section and not any(number(section.get(axis.value)) is not None for axis in Axis):
            yield ("presets", key), "has no axis (pan, tilt, roll, focus)"


def _preset(section: PresetSection) -> Preset:
    positions = {axis: getattr(section, axis.value) for axis in Axis}
    return Preset({axis: position for axis, position in positions.items() if position is not None}, section.name)


def _beyond(axis: Axis, position: float, limits: Mapping[Axis, Limits], rig: str) -> str:
    if axis not in limits:
        return f"is not used: {rig} has no {axis}"
    low, high = limits[axis].minimum, limits[axis].maximum
    return (
        ""
        if low <= position <= high
        else f"is outside the soft limits ({low:g}..{high:g}): a recall stops at the limit"
    )


def write_presets(file: Path, presets: Mapping[int, Preset], marks: Mapping[str, float] | None = None) -> None:
    """Write all of them in place of what was there; raises OutputError, and then the old file is as it was."""
    lines = ["# Positions of a rig, kept by teleop live.\n", "presets:\n" if presets else "presets: {}\n"]
    for key, preset in sorted(presets.items()):
        parts = [f"{axis}: {position}" for axis, position in preset.positions.items()]
        if preset.name:
            parts.append(f"name: {json.dumps(preset.name, ensure_ascii=False)}")
        lines.append(f"  {key}: {{{', '.join(parts)}}}\n")
    if marks:
        lines.append(f"focus_marks: {{{', '.join(f'{name}: {at}' for name, at in sorted(marks.items()))}}}\n")
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(file, error.strerror or str(error)) from None
    write_text(file, "".join(lines))
