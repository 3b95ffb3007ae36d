"""What the steps of a gimbal have in common."""

from __future__ import annotations

from collections.abc import Sequence

from teleop.commission.findings import Findings, Subject
from teleop.commission.gimbal.bench import GimbalBench
from teleop.commission.step import Question, Script

WAYS = {"pan": ("turn right", "left"), "tilt": ("tilt up", "down"), "roll": ("roll clockwise", "counterclockwise")}
"""What a positive move of each axis looks like from behind the camera, and the other way."""
NO_ANGLES = "no angles are read"


class GimbalStep:
    """A step on a bench."""

    key = title = consent = ""
    about: Sequence[str] = ()
    subjects: Sequence[Subject] = ()
    automatic = False
    moves = False  # by what the readings say: without any there is no point in it

    def __init__(self, bench: GimbalBench) -> None:
        self.bench = bench

    def unfit(self, findings: Findings) -> str:  # noqa: ARG002 - some look at what was found
        return NO_ANGLES if self.moves and not self.bench.reads else ""

    def script(self, findings: Findings) -> Script:
        raise NotImplementedError


class AxisStep(GimbalStep):
    """A step that moves one axis, the one with the place `index` among yaw, roll and pitch."""

    moves = True

    def __init__(self, bench: GimbalBench, index: int) -> None:
        super().__init__(bench)
        self.index, self.name = index, bench.name(index)


def answered(code: int | None, missing: str = "not answered") -> str:
    """The return code of an answer, as a fact's `how` names it; `missing` where none came."""
    return missing if code is None else f"return code {int(code):#04x}"


def direction_question(name: str) -> Question:
    """Which way it went is for the operator's eyes: no reading can tell."""
    way, other = WAYS[name]
    text = f"Did the camera {way}, seen from behind it?"
    return Question(text, {"y": "yes", "n": f"no, {other}", "u": "unclear: once more"})
