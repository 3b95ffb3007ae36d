"""The page that writes the profile."""

from __future__ import annotations

from pathlib import Path

from made_findings import FOUND

from teleop.app.commission.profile_file import ProfileFile
from teleop.app.commission.profile_step import ProfileStep
from teleop.app.commission.settings import Settings
from teleop.commission.findings import Findings


class Counting(ProfileFile):
    """Counts how often the profile was read for what is new in it."""

    count = 0

    def settings(self, findings: Findings) -> Settings:
        self.count += 1
        return super().settings(findings)


def test_the_profile_is_read_once_for_a_page_that_is_asked_for_in_every_turn(tmp_path: Path) -> None:
    file = Counting("sim", tmp_path / "mine.yaml")
    step = ProfileStep(file)
    assert step.unfit(FOUND) == ""
    first = step.about
    assert first[0].startswith("Enter writes ")
    assert any("speed_signs.pan -1: measured" in line for line in first)
    assert step.about == first
    assert file.count == 1
    step.unfit(Findings("sim"))  # come to again, with other findings
    assert step.about[0].endswith("New in it: nothing")
    assert file.count == 2
