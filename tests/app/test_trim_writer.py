"""The trim is written when asked, in order, else at the end; a disk that fails is a line, not a crash."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest
from waiting import wait_until

from teleop.app import trim_writer
from teleop.app.trim_writer import TrimWriter
from teleop.core.axes import Axis, State
from teleop.core.errors import DeviceError
from teleop.core.events import Tick
from teleop.manual.live_offset import LiveOffset
from teleop.sequence.trim_export import TrimmedFile

TICK = Tick(0.0, {}, {}, (), {})
Offsets = Mapping[Axis, State]


class Bench:
    """A trim with a file that `write` writes; `said` is what the operator reads."""

    def __init__(self, write: Callable[[Offsets], Any]) -> None:
        self.said: list[str] = []
        self.trimming = SimpleNamespace(offsets={Axis.PAN: State(1.0)}, notify=self.said.append)
        file = SimpleNamespace(target=Path("b.yaml"), write=write)
        self.writer = TrimWriter(cast(LiveOffset, self.trimming), cast(TrimmedFile, file))

    def press(self) -> str:
        assert self.writer.keep is not None
        return self.writer.keep()

    def hears(self, line: str) -> bool:
        self.writer.observe(TICK)
        return self.said == [line]


def raising(error: Exception) -> Callable[[Offsets], Any]:
    def write(_offsets: Offsets) -> None:
        raise error

    return write


def test_without_a_file_there_is_no_key_and_nothing_is_written():
    writer = TrimWriter(cast(LiveOffset, SimpleNamespace(offsets={})), None)
    assert writer.keep is None
    assert writer.finish() is None
    assert writer.failure == ""


def test_the_operator_reads_once_that_the_file_is_written():
    written: list[Offsets] = []
    bench = Bench(written.append)
    assert bench.press() == "writing the trim to b.yaml"
    wait_until(lambda: bench.hears("the trim is written to b.yaml"))
    bench.writer.observe(TICK)
    assert bench.said == ["the trim is written to b.yaml"]
    assert bench.writer.finish() == "b.yaml"
    assert len(written) == 1  # not again at the end


def test_what_was_never_asked_for_is_written_at_the_end_with_the_last_trim():
    written: list[Offsets] = []
    bench = Bench(written.append)
    bench.trimming.offsets = {Axis.PAN: State(2.5)}
    assert bench.writer.finish() == "b.yaml"
    assert written == [{Axis.PAN: State(2.5)}]


def test_two_presses_are_written_one_after_the_other():
    gate, written = threading.Event(), []

    def write(offsets: Offsets) -> None:
        if not written:
            gate.wait(10)
        written.append(offsets[Axis.PAN].position)

    bench = Bench(write)
    bench.press()
    bench.trimming.offsets = {Axis.PAN: State(2.0)}
    bench.press()
    gate.set()
    assert bench.writer.finish() == "b.yaml"
    assert written == [1.0, 2.0]


@pytest.mark.parametrize(
    ("error", "line"),
    [
        (DeviceError("b.yaml: is a folder"), "b.yaml: is a folder"),
        (ValueError("odd"), "b.yaml: cannot be written: odd"),
    ],
)
def test_a_file_that_cannot_be_written_is_told_during_the_run_and_after_it(error: Exception, line: str):
    bench = Bench(raising(error))
    bench.press()
    wait_until(lambda: bench.hears(line))
    assert bench.writer.finish() is None
    assert bench.writer.failure == line


def test_a_disk_that_does_not_answer_does_not_hold_up_the_end(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(trim_writer, "WRITE_TIMEOUT", 0.05)
    gate = threading.Event()
    bench = Bench(lambda _offsets: gate.wait(10))
    try:
        assert bench.writer.finish() is None
        assert bench.writer.failure == "b.yaml: cannot be written: the disk does not answer"
    finally:
        gate.set()
