"""The profile that `live --learn` updates or writes, and its text with what was learned."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from teleop.app.learn.answers import Answers
from teleop.app.learn.devices import LearnedDevices
from teleop.app.learn.merge import merged
from teleop.config.documents.document import mapping
from teleop.config.documents.yaml_edit import block, edited
from teleop.config.documents.yaml_loader import parse_document
from teleop.config.files import OutputError, check_place, is_stream, write_text
from teleop.config.profile import Profile, checked_profile
from teleop.config.resources import described, find, folder, is_bare
from teleop.core.errors import UsageError


class Target:
    """`file` is where the profile goes, None where only its `inputs:` are asked for: a shipped rig without `-o`.

    Raises UsageError for a file that is never written, OutputError for one that cannot be.
    """

    def __init__(self, rig: str, out: Path | None) -> None:
        self._source, self._name = find(rig, "profiles", "rig")
        shipped = is_bare(rig) or _is_shipped(self._source)
        self.file = out or (None if shipped else self._source)
        if self.file is None:
            return
        if _is_shipped(self.file):
            raise UsageError(f"{self.file}: a shipped rig is never written: choose another file with -o")
        check_place(self.file)

    @property
    def replaces(self) -> bool:
        """Whether another file than the rig's own would be written over."""
        if self.file is None or is_stream(self.file) or not self.file.exists():
            return False
        return not self._source.samefile(self.file)

    @property
    def updates(self) -> bool:
        """Whether it is the rig's own file."""
        return self.file is not None and self.file.exists() and self._source.samefile(self.file)

    def text(self, answers: Answers, devices: LearnedDevices) -> str:
        """The whole profile. Raises DocumentError where the result is none, or the file has become another."""
        text = self._read()
        data = self._data(text)
        done = edited(text, {**mapping(data), "inputs": self._inputs(data, answers, devices)}, self._name)
        checked_profile(done, self._name)
        return done

    def lines(self, answers: Answers, devices: LearnedDevices) -> str:
        """Only its `inputs:`."""
        inputs = self._inputs(self._data(self._read()), answers, devices)
        return "\n".join(block({"inputs": inputs}, 0)) + "\n"

    def write(self, text: str) -> None:
        """Raises OutputError."""
        assert self.file is not None
        write_text(self.file, text)

    def profile(self, answers: Answers, devices: LearnedDevices) -> Profile:
        """The profile as it would be written. Raises DocumentError."""
        return checked_profile(self.text(answers, devices), self._name)

    def _inputs(self, data: Any, answers: Answers, devices: LearnedDevices) -> list[dict[str, Any]]:
        infos = [device.info for device in devices.each]
        return merged(mapping(data).get("inputs"), answers, infos, [device.hats for device in devices.each])

    def _data(self, text: str) -> Any:
        return parse_document(text.removeprefix("\ufeff"), self._name).data

    def _read(self) -> str:
        try:
            return self._source.read_bytes().decode("utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise OutputError(self._source, f"it cannot be read any more: {error}") from None


def _is_shipped(file: Path) -> bool:
    shipped = folder("profiles").resolve()
    return file.resolve().parent == shipped and file.stem in described("profiles")
