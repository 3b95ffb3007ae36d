"""One step of a commissioning, and what it asks of its runner: to wait, or to ask the operator.

A step is values in and values out. Its script is a generator: it sends its commands itself, and yields a `Wait` or a
`Question`. A question is sent its answer. What the script returns are the facts. It never has to think of STOP: the
runner closes the script and calls `release` until everything rests.
"""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from teleop.commission.findings import Fact, Findings, Subject


@dataclass(frozen=True)
class Wait:
    """Nothing for `seconds`; `progress` is what the page says meanwhile, "" for what it said before."""

    seconds: float
    progress: str = ""


@dataclass(frozen=True)
class Question:
    """Asked on the page. `choices` are keys and what they mean: `{"y": "right", "n": "left"}`; the answer is the key.

    With a `word` the operator types, and the answer is what was typed when Enter came. `seconds` is how long the script
    itself waits; then the answer is "": so it can look at something between two keys.
    """

    text: str
    choices: Mapping[str, str] = field(default_factory=dict)
    word: bool = False
    seconds: float | None = None

    @property
    def only_waits(self) -> bool:
        """Whether the script does nothing before the answer."""
        return self.seconds is None


Pause = Generator[Wait | Question, str, None]
"""A part of a script that only takes its time."""
Script = Generator[Wait | Question, str, Sequence[Fact]]


class Step(Protocol):
    """`about` says what will happen and how far, a line each; `consent` what it does beyond 5 deg/s and 5 deg.

    `key` is stable: `position-pan`. `subjects` are the facts that it settles. An `automatic` step begins without a key:
    it neither moves nor changes anything.
    """

    @property
    def key(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def about(self) -> Sequence[str]: ...
    @property
    def consent(self) -> str: ...
    @property
    def subjects(self) -> Sequence[Subject]: ...
    @property
    def automatic(self) -> bool: ...

    def unfit(self, findings: Findings) -> str:
        """Why there is no point in it after what was found, "" where there is."""
        ...

    def script(self, findings: Findings) -> Script:
        """Raises DeviceError when the device does not do it, LinkError when the link is lost."""
        ...


class Device(Protocol):
    """What the steps act on, as far as their runner needs it."""

    def poll(self, now: float) -> None:
        """Take in what has arrived, and send what is due; called in every turn. Raises LinkError."""
        ...

    def release(self, now: float) -> float | None:
        """The next thing that brings everything to rest; when to do the one after (s), None when all is done."""
        ...

    def displaced(self) -> str:
        """How far everything is from where it began, "" where it is there."""
        ...

    def restore(self) -> Script:
        """Back to where everything was when the commissioning began, slowly. It returns no facts."""
        ...

    def reopen(self) -> None:
        """Open the link again after it was lost. Raises LinkError."""
        ...
