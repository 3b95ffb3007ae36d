"""The table of faults, the disk: a take that cannot be written is said, and not one frame on the bus differs for it."""

from __future__ import annotations

import errno
import io
import threading
from collections.abc import Callable
from pathlib import Path
from typing import IO

import pytest
from gimbal_fault_bench import gimbal_fault_bench

from teleop.core.run_state import Result
from teleop.recording import writer as module
from teleop.recording.format import About
from teleop.recording.writer import Recorder


class Gone(io.RawIOBase):
    """A disk that is pulled out after some kilobytes."""

    def __init__(self) -> None:
        self._left = 2000

    def writable(self) -> bool:
        return True

    def write(self, data: object) -> int:
        size = len(memoryview(data))  # type: ignore[arg-type]  # bytes or a view of them
        self._left -= size
        if self._left < 0:
            raise OSError(errno.EIO, "Input/output error")
        return size


class Stuck(io.RawIOBase):
    """A network share that no longer answers: the writer's thread is asleep in the kernel until the test is over."""

    def __init__(self, over: threading.Event) -> None:
        self._over = over

    def writable(self) -> bool:
        return True

    def write(self, data: object) -> int:
        self._over.wait()
        return len(memoryview(data))  # type: ignore[arg-type]  # as above


class Broken(io.RawIOBase):
    """Something in the writer's thread that is no error of any disk."""

    def writable(self) -> bool:
        return True

    def write(self, data: object) -> int:
        raise ZeroDivisionError("a defect")


ROWS: dict[str, tuple[Callable[[threading.Event], IO[bytes]], str]] = {
    "disk full": (lambda _over: Path("/dev/full").open("wb", buffering=0), "No space left on device"),  # noqa: SIM115 - as long as the take
    "disk gone": (lambda _over: Gone(), "Input/output error"),  # type: ignore[return-value]  # a raw stream is one
    "disk stuck": (Stuck, "the disk does not answer"),  # type: ignore[dict-item]  # as above
    "exception in the writer's thread": (lambda _over: Broken(), "a defect"),  # type: ignore[return-value]  # as above
}


@pytest.mark.parametrize("row", ROWS)
def test_a_failing_disk_is_said_and_the_motion_is_the_same_to_the_frame(
    row: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "FINISH_TIMEOUT", 0.2)
    opens, trouble = ROWS[row]
    wires, over = [], threading.Event()
    try:
        for recorded in (False, True):
            with gimbal_fault_bench("speed", tmp_path, monkeypatch) as bench:
                takes = []
                if recorded:
                    about = About("Rig", "Move", 1.7e9, bench.rig.profile.limits, "0")
                    takes.append(Recorder(opens(over), about, "take.mcap"))
                bench.move(lambda _now: None, takes, seconds=4.0)
                for take in takes:
                    take.finish(bench.ended.result, bench.ended.reasons)  # comes back, although the disk never does
                    assert trouble in take.trouble
                    assert "\n" not in take.trouble
                assert (bench.ended.result, bench.ended.reasons) == (Result.DONE, [])
                bench.assert_given_back()
                wires.append(bench.wire)
    finally:
        over.set()
    assert wires[0] == wires[1]
