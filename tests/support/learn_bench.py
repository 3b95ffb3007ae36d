"""A session of `live --learn` on a virtual clock, with pads in a hand that does what it is asked."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from fake_hid import GAMEPAD, real

from teleop.app.learn.session import LearnSession
from teleop.app.learn.target import Target
from teleop.config.profile import load_profile
from teleop.config.resources import folder
from teleop.core.operator_input import Command
from teleop.inputs.hid.backend import DeviceInfo, HidBackend

SIM = (folder("profiles") / "sim.yaml").read_text()
F310 = real("Logitech F310")["descriptor"]
REST = "7f7f7f7f08000000"
RIGHT, LEFT, UP, BUTTON_1, BUTTON_2 = (
    "ff7f7f7f08000000",
    "007f7f7f08000000",
    "7f007f7f08000000",
    "7f7f7f7f18000000",
    "7f7f7f7f28000000",
)
TRIGGERS, HAT_UP, SHOULDER = ("7f7f7f7f08080000", "7f7f7f7f08040000"), "7f7f7f7f00000000", "7f7f7f7f08010000"
"""Reports of a Logitech F310."""

TURN = 0.02  # s
LONGEST = 60.0  # s in which what is waited for has to come
Time = list[float]


class Pad:
    """A device that reports what it is given, when the session's clock has come to it; None unplugs it."""

    def __init__(
        self,
        time: Time,
        descriptor: str,
        ids: tuple[int, int] = (0x046D, 0xC216),
        name: str = "Pad",
        usage: tuple[int, int] = GAMEPAD,
        serial: str = "",
        interface: int = 0,
    ) -> None:
        self._time, self._descriptor = time, bytes.fromhex(descriptor)
        self.info = DeviceInfo(f"{name} {serial} {interface}".encode(), *ids, serial, name, *usage, interface)
        self._reports: deque[bytes | None] = deque()

    def report(self, *reports: str | None) -> None:
        self._reports.extend(None if each is None else bytes.fromhex(each) for each in reports)

    @property
    def next_report(self) -> float:
        return self._time[0] if self._reports else math.inf

    def get_report_descriptor(self) -> bytes:
        return self._descriptor

    def read(self, timeout: float) -> bytes:
        report = self._reports.popleft() if self._reports else b""
        if report is None:
            raise OSError("unplugged")
        return report

    def get_input_report(self, report_id: int, length: int) -> bytes:
        raise OSError("does not answer")

    def close(self) -> None: ...


class Pads:
    def __init__(self, pads: Sequence[Pad]) -> None:
        self._pads = pads

    def enumerate(self) -> Sequence[DeviceInfo]:
        return [pad.info for pad in self._pads]

    def open(self, path: bytes) -> Pad:
        return next(pad for pad in self._pads if pad.info.path == path)


class LearnBench:
    """A session, and its time that only `turn` moves on."""

    def __init__(self, session: LearnSession, time: Time) -> None:
        self.session, self.time = session, time

    def turn(self, seconds: float = TURN, *keys: Command) -> None:
        end = self.time[0] + seconds
        self.session.turn(self.time[0], keys)
        while self.time[0] < end - TURN / 2 and not self.session.over:
            self.time[0] += TURN
            self.session.turn(self.time[0], ())

    def until(self, holds: Callable[[], object], what: str) -> None:
        begin = self.time[0]
        while not holds():
            assert self.time[0] - begin < LONGEST, f"{what}; it shows {self.session.dialogue.page}"
            self.turn()

    def asked(self, words: str) -> None:
        """Skip questions until this one is asked."""
        while True:
            self.until(lambda: self.session.dialogue.asks or self.session.dialogue.over, words)
            if words in self.session.dialogue.page.text:
                return
            self.turn(TURN, Command.GO)

    def answer(self, words: str, pad: Pad, *reports: str) -> str:
        """Once this is asked send all reports, the last of them what the pad rests at; what the page then says."""
        self.asked(words)
        before = self.session.dialogue.page
        for report in reports[:-1]:
            pad.report(report)
            self.turn(0.7)
        pad.report(reports[-1])
        self.until(lambda: self.session.dialogue.page != before and self.session.dialogue.asks, "an answer")
        return self.session.dialogue.page.status

    def tried(self) -> None:
        """Go to the trial."""
        self.turn(TURN, Command.NEXT)
        assert self.session.trial is not None, self.session.problem

    def row(self, control: str) -> str:
        """What a control asks for in the trial."""
        assert self.session.trial is not None
        return next(row.asks for row in self.session.trial.rows if row.control == control)


@contextmanager
def learning(rig: Path | str, time: Time, backend: HidBackend, out: Path | None = None) -> Iterator[LearnBench]:
    session = LearnSession(load_profile(str(rig)), Target(str(rig), out), backend, lambda: time[0], polled=True)
    with session:
        yield LearnBench(session, time)
