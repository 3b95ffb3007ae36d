"""The profile that `live --learn` updates or writes, and its text with what was learned."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from teleop.app.learn.answers import Answers
from teleop.app.learn.devices import LearnedDevices
from teleop.app.learn.merge import merged
from teleop.app.rig_file import RigFile, check_target
from teleop.config.documents.document import mapping
from teleop.config.documents.yaml_edit import block, edited
from teleop.config.files import check_place, is_stream, write_text
from teleop.config.profile import Profile, checked_profile


class Target:
    """`file` is where the profile goes, None where only its `inputs:` are asked for: a shipped rig without `-o`.

    Raises UsageError for a file that is never written, OutputError for one that cannot be.
    """

    def __init__(self, rig: str, out: Path | None) -> None:
        self._rig = RigFile(rig)
        self.file = out or (None if self._rig.is_shipped else self._rig.source)
        if self.file is None:
            return
        check_target(self.file)
        check_place(self.file)

    @property
    def replaces(self) -> bool:
        """Whether another file than the rig's own would be written over."""
        if self.file is None or is_stream(self.file) or not self.file.exists():
            return False
        return not self._rig.source.samefile(self.file)

    @property
    def updates(self) -> bool:
        """Whether it is the rig's own file."""
        return self.file is not None and self.file.exists() and self._rig.source.samefile(self.file)

    def text(self, answers: Answers, devices: LearnedDevices) -> str:
        """The whole profile. Raises DocumentError where the result is none, or the file has become another."""
        text = self._rig.text()
        data = self._rig.data(text)
        done = edited(text, {**mapping(data), "inputs": self._inputs(data, answers, devices)}, self._rig.name)
        checked_profile(done, self._rig.name)
        return done

    def lines(self, answers: Answers, devices: LearnedDevices) -> str:
        """Only its `inputs:`."""
        inputs = self._inputs(self._rig.data(self._rig.text()), answers, devices)
        return "\n".join(block({"inputs": inputs}, 0)) + "\n"

    def write(self, text: str) -> None:
        """Raises OutputError."""
        assert self.file is not None
        write_text(self.file, text)

    def profile(self, answers: Answers, devices: LearnedDevices) -> Profile:
        """The profile as it would be written. Raises DocumentError."""
        return checked_profile(self.text(answers, devices), self._rig.name)

    def _inputs(self, data: Any, answers: Answers, devices: LearnedDevices) -> list[dict[str, Any]]:
        infos = [device.info for device in devices.each]
        return merged(mapping(data).get("inputs"), answers, infos, [device.hats for device in devices.each])
