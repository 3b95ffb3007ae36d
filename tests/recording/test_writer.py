"""The recorder: nothing that the disk does reaches the loop, and what is missing is counted."""

from __future__ import annotations

import io
from pathlib import Path

import pytest

from teleop.core.axes import Axis, Limits, State
from teleop.core.errors import UsageError
from teleop.core.events import Tick
from teleop.core.run_state import Result
from teleop.recording.format import About
from teleop.recording.reader import read_take
from teleop.recording.writer import Recorder, recording

LIMITS = {Axis.PAN: Limits(-10, 10, 1, 2, 3)}
ABOUT = About("Bench", "t", 1.7e9, LIMITS, "0")


def tick(number: int) -> Tick:
    return Tick(number / 100, {Axis.PAN: State(1.0)}, {}, (), {})


class FullDisk(io.RawIOBase):
    def write(self, _data: object) -> int:
        raise OSError(28, "No space left on device")


class HalfWrites(io.RawIOBase):
    """Takes at most 7 bytes at a time, as a raw file may."""

    def __init__(self) -> None:
        self.data = b""

    def write(self, data: object) -> int:
        taken = bytes(data)[:7]  # type: ignore[call-overload]
        self.data += taken
        return len(taken)


def test_a_full_disk_is_a_sentence_and_a_count() -> None:
    recorder = Recorder(FullDisk(), ABOUT, "t.mcap")  # type: ignore[arg-type]
    for number in range(3):
        recorder.observe(tick(number))
    recorder.finish(Result.DONE, [])
    assert recorder.trouble == "t.mcap: No space left on device: 3 ticks not recorded"
    assert recorder.missing == 3


def test_a_write_of_a_part_goes_on_with_the_rest(tmp_path: Path) -> None:
    stream = HalfWrites()
    recorder = Recorder(stream, ABOUT, "t.mcap", patient=True)  # type: ignore[arg-type]
    for number in range(200):
        recorder.observe(tick(number))
    recorder.finish(Result.DONE, [])
    assert recorder.trouble == ""
    (tmp_path / "t.mcap").write_bytes(stream.data)
    assert read_take(tmp_path / "t.mcap").duration == pytest.approx(1.99)


def test_a_run_that_fails_before_its_first_tick_leaves_no_file(tmp_path: Path) -> None:
    path = tmp_path / "t.mcap"
    with pytest.raises(RuntimeError), recording(path, "Bench", "t", LIMITS):
        raise RuntimeError("no")
    assert not path.exists()


def test_a_run_that_fails_later_leaves_its_reason_in_the_file(tmp_path: Path) -> None:
    path = tmp_path / "t.mcap"

    def failing_run() -> None:
        with recording(path, "Bench", "t", LIMITS) as recorder:
            assert recorder is not None
            recorder.observe(tick(0))
            raise RuntimeError("the cable fell out")

    with pytest.raises(RuntimeError):
        failing_run()
    assert read_take(path).ended == "failed: the cable fell out"


@pytest.mark.parametrize("option", ["", "--take "], ids=["a program", "the command line"])
@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("t.bag", "its ending must be .mcap"),
        ("there.mcap", "already exists; choose another name, a take is never overwritten"),
        ("no/folder/t.mcap", "cannot be written: No such file or directory"),
    ],
)
def test_where_no_take_can_be_is_refused_with_its_path(tmp_path: Path, name: str, text: str, option: str) -> None:
    (tmp_path / "there.mcap").touch()
    with pytest.raises(UsageError) as refusal, recording(tmp_path / name, "Bench", "t", LIMITS, option=option):
        pass
    assert str(refusal.value) == f"{option}{tmp_path / name}: {text}"
