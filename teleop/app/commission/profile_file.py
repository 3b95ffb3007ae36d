"""The profile that a commissioning updates or writes; comments and everything else of it stay as they are."""

from __future__ import annotations

from copy import deepcopy
from pathlib import Path
from typing import Any

from teleop.app.commission.settings import Settings, settings_of
from teleop.app.rig_file import RigFile, check_target
from teleop.commission.findings import Findings
from teleop.config.documents.document import Location, mapping
from teleop.config.documents.yaml_edit import edited
from teleop.config.documents.yaml_notes import with_notes
from teleop.config.files import check_place, write_text
from teleop.config.profile import Profile, checked_profile
from teleop.core.errors import UsageError

MARK = "commission"


class ProfileFile:
    """`rig` is what was asked for, `out` where the profile is to go; a shipped rig goes to `RIG.yaml` unless given.

    `urls` are the links that were given instead of the profile's: the profile keeps them. Raises UsageError for a file
    that is never written, OutputError for one that cannot be.
    """

    def __init__(self, rig: str, out: Path | None, urls: dict[str, str] | None = None) -> None:
        self._rig = RigFile(rig)
        self._urls = urls or {}
        shipped, source = self._rig.is_shipped, self._rig.source
        self.file = out or (Path(f"{source.stem}.yaml") if shipped else source)
        check_target(self.file)
        if self.file.exists() and not self.updates:
            cure = f"give it with --rig ./{self.file}" if shipped and out is None else "choose another file with -o"
            raise UsageError(f"{self.file} exists already: {cure}")
        check_place(self.file)

    @property
    def updates(self) -> bool:
        """Whether it is the rig's own file."""
        return self.file.exists() and self._rig.source.exists() and self._rig.source.samefile(self.file)

    def settings(self, findings: Findings) -> Settings:
        return settings_of(findings, self._profile())

    def text(self, findings: Findings) -> str:
        """The whole profile with what was found. Raises DocumentError where the result is none."""
        text = self._rig.text()
        settings = self.settings(findings)
        data = deepcopy(self._rig.data(text))
        for place, value in settings.values.items():
            _put(data, place, value)
        for name, url in self._urls.items():
            _put(data, ("links", name), url)
        text = with_notes(edited(text, data, self._rig.name), settings.notes, MARK)
        for place in sorted(settings.removed, key=str, reverse=True):
            _remove(data, place)
        text = edited(text, data, self._rig.name)
        checked_profile(text, self._rig.name)
        return text

    def write(self, findings: Findings) -> None:
        """Raises OutputError, and DocumentError as `text` does."""
        write_text(self.file, self.text(findings))

    def _profile(self) -> Profile:
        return checked_profile(self._rig.text(), self._rig.name)


def _put(data: Any, place: Location, value: Any) -> None:
    for step in place[:-1]:
        data = data[step]
    data[place[-1]] = {**mapping(data, str(place[-1])), **value} if isinstance(value, dict) else value


def _remove(data: Any, place: Location) -> None:
    for step in place[:-1]:
        data = data[step]
    del data[place[-1]]
