"""A capture file is whole lines at any time, in bounded memory, in either format; nothing is overwritten unasked."""

from __future__ import annotations

import io
import tracemalloc
from pathlib import Path

import pytest
from made_captures import CAN0, STARTED, MadeCapture
from mcap.reader import make_reader

from teleop.captures.captured import FROM_DEVICE, TO_DEVICE, Captured, CaptureError, Source
from teleop.captures.reader import read
from teleop.captures.writer import CaptureWriter, check_file
from teleop.config.files import OutputError
from teleop.dji.gimbal import messages as gimbal
from teleop.recording.format import About, TakeWriter

SERIAL = Source("serial", "ttyUSB0", "drone")
FRAMES = [
    Captured(STARTED + 0.25, 0x222, b"\xaa\x1a"),
    Captured(STARTED + 0.5, 0x18FF1234, b"\x02", extended=True),
    Captured(STARTED + 0.75, 0x222, b"", remote=True),
    Captured(STARTED + 1.0, 0x40, bytes(8), error=True),
]


def written(path: Path, frames: list[Captured], source: Source = CAN0) -> CaptureWriter:
    writer = CaptureWriter(path, source)
    for frame in frames:
        writer.add(frame)
    return writer


@pytest.mark.parametrize("ending", [".log", ".candump", ".mcap"])
def test_what_was_captured_is_read_again(tmp_path: Path, ending: str) -> None:
    file = tmp_path / f"x{ending}"
    written(file, FRAMES).close()
    assert [frame for _, frame in read(file)] == FRAMES
    assert {source for source, _ in read(file)} == {CAN0}


def test_a_serial_line_has_directions(tmp_path: Path) -> None:
    file = tmp_path / "x.mcap"
    frames = [Captured(STARTED, FROM_DEVICE, b"\xaa\x01"), Captured(STARTED + 0.1, TO_DEVICE, b"\x02")]
    written(file, frames, SERIAL).close()
    assert list(read(file)) == [(SERIAL, frame) for frame in frames]


def test_another_reader_of_mcap_has_times_topics_and_json(tmp_path: Path) -> None:
    file = tmp_path / "x.mcap"
    written(file, FRAMES).close()
    with file.open("rb") as stream:
        schema, channel, message = next(iter(make_reader(stream).iter_messages()))
    assert (channel.topic, channel.message_encoding, schema and schema.encoding) == ("/can", "json", "jsonschema")
    assert (message.log_time, message.data) == (1732888888250000000, b'{"id":546,"data":"aa1a"}')


@pytest.mark.parametrize("ending", [".log", ".mcap"])
def test_what_was_flushed_is_whole_without_an_end(tmp_path: Path, ending: str) -> None:
    file = tmp_path / f"x{ending}"
    writer = written(file, FRAMES)
    writer.flush()
    writer.add(FRAMES[0])  # and the process is killed here
    assert [frame for _, frame in read(file)] == FRAMES


@pytest.mark.parametrize("ending", [".log", ".mcap"])
def test_a_cut_anywhere_leaves_the_frames_before_it(tmp_path: Path, ending: str) -> None:
    whole = tmp_path / f"whole{ending}"
    written(whole, FRAMES[:3]).close()
    data, cut = whole.read_bytes(), tmp_path / f"cut{ending}"
    for size in range(len(data) // 2, len(data), 5):
        cut.write_bytes(data[:size])
        found = [frame for _, frame in read(cut)]
        assert found[:-1] == FRAMES[: max(0, len(found) - 1)]


@pytest.mark.parametrize("ending", [".log", ".mcap"])
def test_memory_does_not_grow(tmp_path: Path, ending: str) -> None:
    writer = CaptureWriter(tmp_path / f"x{ending}", CAN0)

    def more(count: int) -> None:
        for number in range(count):
            writer.add(FRAMES[0])
            if number % 10 == 0:
                writer.flush()

    more(200)
    tracemalloc.start()
    more(200)
    used = tracemalloc.get_traced_memory()[0]
    more(2000)
    grown = tracemalloc.get_traced_memory()[0] - used
    tracemalloc.stop()
    writer.close()
    assert grown < 10_000


class FullDisk(io.FileIO):
    """Takes 100 bytes, and no more."""

    def write(self, data: object, /) -> int:
        room = 100 - self.tell()
        if room <= 0:
            raise OSError(28, "No space left on device")
        return super().write(bytes(data)[:room])  # type: ignore[call-overload]


def test_a_full_disk_is_one_line_and_leaves_whole_lines(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "x.log"
    monkeypatch.setattr(io, "FileIO", FullDisk)
    writer = written(file, FRAMES * 3)
    with pytest.raises(OutputError, match=r"x\.log: cannot be written: No space left on device$"):
        writer.flush()
    writer.close()
    assert file.read_bytes().endswith(b"\n")
    assert [frame for _, frame in read(file)] == FRAMES[:2]


@pytest.mark.parametrize(
    ("name", "source", "error"),
    [
        ("x.txt", CAN0, "-o x.txt: its ending must be .log, .candump (candump) or .mcap"),
        ("x.log", SERIAL, "-o x.log: candump has CAN frames only; a serial line is recorded as .mcap"),
        ("there.log", CAN0, "-o there.log: already exists; give --overwrite to replace it"),
    ],
)
def test_refused_in_one_line(
    name: str, source: Source, error: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("there.log").write_text("mine")
    with pytest.raises(CaptureError) as refused:
        check_file("-o", Path(name), source, overwrite=False)
    assert str(refused.value) == error
    assert Path("there.log").read_text() == "mine"


def test_other_files_are_refused_in_one_line(tmp_path: Path) -> None:
    take = tmp_path / "take.mcap"
    with take.open("wb") as stream:
        writer = TakeWriter(stream, About("rig", "title", STARTED, {}, "1"))
        writer.end("done", [], 0)
    damaged = tmp_path / "damaged.mcap"
    MadeCapture().write(damaged)
    damaged.write_bytes(damaged.read_bytes()[:8] + b"\xff" * 60)
    for file in (damaged, tmp_path / "none.log"):
        with pytest.raises(CaptureError) as refused:
            list(read(file))
        assert "\n" not in str(refused.value)
    assert list(read(take)) == []


def test_a_take_with_messages_is_no_capture(tmp_path: Path) -> None:
    file = tmp_path / "take.mcap"
    with file.open("wb") as stream:
        from mcap.writer import Writer

        writer = Writer(stream)
        writer.start()
        channel = writer.register_channel("/motion", "json", writer.register_schema("x", "jsonschema", b"{}"))
        writer.add_message(channel, 1, b"{}", 1)
        writer.finish()
    with pytest.raises(CaptureError, match=r"an MCAP file, and no capture of teleop monitor$"):
        list(read(file))


def test_made_captures_are_read(tmp_path: Path) -> None:
    made = MadeCapture()
    made.ask(0.0, gimbal.Angles(), 1)
    assert [frame for _, frame in read(made.write(tmp_path / "x.log"))] == made.frames
