"""What is reported of a trim and its file: that it was written is only reported of a file that was."""

from __future__ import annotations

from pathlib import Path
from threading import Event

import pytest

from teleop.app.trim_writer import TrimWriter
from teleop.cli.trim_options import TrimReport
from teleop.config.files import OutputError
from teleop.core.axes import Axis, State
from teleop.core.events import Tick

TICK = Tick(0.0, {}, {}, (), {})


class Hands:
    """What a TrimWriter needs of `Trimming`."""

    def __init__(self) -> None:
        self.offsets = {Axis.PAN: State(1.5)}
        self.lines: list[str] = []

    def notify(self, text: str) -> None:
        self.lines.append(text)


class File:
    """What it needs of a `TrimmedFile`, failing with `error`."""

    target = Path("out.yaml")

    def __init__(self, error: Exception | None = None) -> None:
        self._error = error

    def write(self, offsets: object) -> None:
        if self._error:
            raise self._error


@pytest.mark.parametrize(
    "error", [OutputError(Path("out.yaml"), "No space left on device"), MemoryError("no room"), ValueError("a defect")]
)
@pytest.mark.parametrize("key", [False, True])
def test_a_write_that_failed_is_never_followed_by_written_to_file(
    error: Exception, key: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    hands = Hands()
    writer = TrimWriter(hands, File(error))  # type: ignore[arg-type]  # stand-ins
    if key:
        assert writer.keep
        assert writer.keep() == "writing the trim to out.yaml"
    TrimReport(writer).print()
    writer.observe(TICK)
    printed = capsys.readouterr()
    reason = "out.yaml: cannot be written: "
    assert printed.out == "trim: pan +1.500 deg\n"
    assert printed.err.startswith(f"teleop: {reason}")
    assert dict(TrimReport(writer).facts())["trim"] == {
        "offsets": {"pan": 1.5},
        "file": None,
        "trouble": printed.err.removeprefix("teleop: ").strip(),
    }
    assert writer.failure.startswith(reason)
    assert all(line.startswith(reason) for line in hands.lines)


def test_a_file_that_was_written_is_reported(capsys: pytest.CaptureFixture[str]) -> None:
    hands = Hands()
    writer = TrimWriter(hands, File())  # type: ignore[arg-type]  # stand-ins
    TrimReport(writer).print()
    writer.observe(TICK)
    assert capsys.readouterr().out == "trim: pan +1.500 deg; written to out.yaml\n"
    assert hands.lines == ["the trim is written to out.yaml"]
    assert (writer.failure, dict(TrimReport(writer).facts())["trim"]["file"]) == ("", "out.yaml")  # type: ignore[index]  # a dict


def test_a_disk_that_hangs_is_not_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("teleop.app.trim_writer.WRITE_TIMEOUT", 0.01)
    never = Event()

    class Hung(File):
        def write(self, offsets: object) -> None:
            never.wait()

    writer = TrimWriter(Hands(), Hung())  # type: ignore[arg-type]  # stand-ins
    assert dict(TrimReport(writer).facts())["trim"]["file"] is None  # type: ignore[index]  # a dict
    assert writer.failure == "out.yaml: cannot be written: the disk does not answer"
    never.set()
