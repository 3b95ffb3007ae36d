"""The last step: the profile is written."""

from __future__ import annotations

from collections.abc import Sequence

from teleop.app.commission.profile_file import ProfileFile
from teleop.commission.findings import Findings, Subject
from teleop.commission.step import Script, Wait
from teleop.core.errors import DeviceError, TeleopError

SHOWN = 12  # lines of what will be written


class ProfileStep:
    """Shows what will be in the profile, and writes it."""

    key, title, consent, automatic = "profile", "Write the profile", "", False
    subjects: Sequence[Subject] = ()

    def __init__(self, file: ProfileFile) -> None:
        self.file, self.written = file, False
        self._findings: Findings | None = None
        self._about: Sequence[str] = ()

    def unfit(self, findings: Findings) -> str:
        self._findings, self._about = findings, ()
        return ""

    @property
    def about(self) -> Sequence[str]:
        """Made once for each visit of the page: it reads the profile, and a page is asked for 100 times a second."""
        if not self._about:
            self._about = self._what_is_new()
        return self._about

    def _what_is_new(self) -> Sequence[str]:
        verb = "updates" if self.file.updates else "writes"
        head = f"Enter {verb} {self.file.file}{', its comments kept' * self.file.updates}. New in it:"
        if self._findings is None:
            return (head,)
        settings = self.file.settings(self._findings)
        lines = [line for notes in settings.notes.values() for line in notes]
        more = [f"and {len(lines) - SHOWN} more"] if len(lines) > SHOWN else []
        return (head, *(f"  {line}" for line in lines[:SHOWN]), *more) if lines else (f"{head} nothing",)

    def script(self, findings: Findings) -> Script:
        yield Wait(0.0, "writing")
        try:
            self.file.write(findings)
        except TeleopError as error:
            raise DeviceError(str(error)) from None
        self.written = True
        return ()
