"""The table of faults, what is in the hand: a pad that fails mid-pan stops the pan, and the run goes on without it.

The pad is a fake only beneath hidapi: descriptor, reports and the thread that reads them are as of a real one.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest
from fake_hid import FakeBackend, FakeDevice, real
from gimbal_fault_bench import PAN, GimbalFaultBench, gimbal_fault_bench
from waiting import wait_until

from teleop.config.operator_settings import SticksSection
from teleop.config.presets import Presets
from teleop.core.events import Tick
from teleop.core.run_state import Result
from teleop.inputs.hid import reader as hid_reader
from teleop.inputs.hid.device import open_inputs
from teleop.manual.operator import Operator

F310 = bytes.fromhex(real("Logitech F310")["descriptor"])
REST = bytes.fromhex("7f7f7f7f08000000")
PUSHED, TREMBLING = bytes.fromhex("c07f7f7f08000000"), bytes.fromhex("bf7f7f7f08000000")
PUSH_AT, BREAK_AT = 1.0, 2.5  # s of the run


class Pad(FakeDevice):
    """Reports 100 times a second, first at rest and then pushed to the right."""

    def __init__(self, backend: FakeBackend) -> None:
        super().__init__(F310)
        self.backend = backend
        self.broken_at = float("inf")
        self.reports = self.trembles = True
        self.dies = False
        backend.plug(self)

    def read(self, timeout: float) -> bytes:
        if self.dies:
            raise ZeroDivisionError("a defect in the reader's thread")
        return super().read(timeout)

    def tell(self, elapsed: float, number: int) -> None:
        if self.reports:
            pushed = TREMBLING if self.trembles and number % 2 else PUSHED
            self.told(pushed if elapsed >= PUSH_AT else REST)


def unplugged(pad: Pad) -> None:
    pad.reports = False
    pad.backend.unplug(pad)


def frozen(pad: Pad) -> None:
    pad.trembles = False


def silent(pad: Pad) -> None:
    pad.reports = False


def reader_dies(pad: Pad) -> None:
    pad.reports = False
    pad.dies = True
    wait_until(lambda: not any(each.name.startswith("hid ") for each in threading.enumerate()), "the reader's end")


@dataclass(frozen=True)
class Row:
    name: str
    breaks: Callable[[Pad], None]
    trouble: str
    within: float  # s until the pan rests


ROWS = [
    Row("stick unplugged", unplugged, "unplugged", 1.0),
    Row("stick frozen", frozen, "reports unchanged for 10 s", 11.0),
    Row("reports stop", silent, "no report for 0.2 s", 1.2),
    Row("exception in the reader's thread", reader_dies, "its reader failed: a defect in the reader's thread", 1.2),
]


class Handler:
    """Passes time on to the pad each tick, breaks it, and ends the run when it has been at rest for a while."""

    def __init__(self, bench: GimbalFaultBench, pad: Pad, row: Row, operator: Operator) -> None:
        self.moving_when_broken = 0.0
        self.stopped_after = float("inf")
        self._bench, self._pad, self._row, self._operator = bench, pad, row, operator
        self._begin = 0.0
        self._number = 0

    def observe(self, tick: Tick) -> None:
        self._begin = self._begin or tick.time
        self._number += 1
        elapsed = tick.time - self._begin
        if elapsed >= BREAK_AT and self._pad.broken_at == float("inf"):
            self._pad.broken_at = tick.time
            self.moving_when_broken = self._bench.gimbal.rates.yaw
            self._row.breaks(self._pad)
        self._pad.tell(elapsed, self._number)
        since = tick.time - self._pad.broken_at
        if since > 0 and all(state.velocity == 0 for state in tick.motion.values()):
            self.stopped_after = min(self.stopped_after, since)
        if since > self._row.within + 1:
            self._bench.loop.interrupt("enough")


@pytest.mark.parametrize("mode", ["position", "speed", "stick"])
@pytest.mark.parametrize("row", ROWS, ids=[row.name for row in ROWS])
def test_a_pad_that_fails_mid_pan_stops_the_pan(
    row: Row, mode: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(hid_reader, "LOOK_EVERY", 0.001)
    backend = FakeBackend()
    pad = Pad(backend)
    with gimbal_fault_bench(mode, tmp_path, monkeypatch) as bench, open_inputs([], bench.clock.now, backend) as inputs:
        presets = Presets(tmp_path / "presets.yaml")
        operator = Operator(bench.rig.profile.limits, inputs, presets, SticksSection(), 2.0)
        handler = Handler(bench, pad, row, operator)
        bench.run(operator, [handler])
        presets.close()
        said = [message.text for message in operator.status.messages]
        assert handler.moving_when_broken > 1.0
        assert handler.stopped_after < row.within
        after = [rate for time, rate, _ in bench.rates if time >= pad.broken_at]
        assert min(after) > -1.5
        assert max(after) < handler.moving_when_broken + 1.5
        bench.assert_no_jump()
        bench.assert_at_rest()
        bench.assert_given_back()
        assert (bench.ended.result, bench.ended.reasons) == (Result.INTERRUPTED, ["enough"])
        assert any(row.trouble in text for text in said), said
        assert PAN.velocity > max(after)
