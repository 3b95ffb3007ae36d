"""What a commissioning leaves behind: a page, the same facts as JSON, and a capture of everything that passed."""

from __future__ import annotations

import re
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from datetime import datetime
from pathlib import Path
from typing import Self

from teleop.captures.candump import interface_name
from teleop.captures.captured import Source
from teleop.captures.recording import Recording
from teleop.captures.serial_numbers import SerialNumbers
from teleop.captures.tapping import tap
from teleop.captures.writer import CaptureWriter
from teleop.commission.changes import changes, heading, shown
from teleop.commission.findings import Findings
from teleop.config.documents.read_bytes import read_bytes
from teleop.config.files import OutputError, write_text
from teleop.core.clock import date
from teleop.core.errors import UsageError
from teleop.core.interfaces import Link
from teleop.links.url import LinkAddress
from teleop.plots.findings_html import page

PAGE, REPORT, CAPTURE = "report.html", "report.json", "capture"
LARGEST = 4_000_000  # bytes of a report that is read: one is 50 kB
LOOK = 0.1  # s between two writes of the capture
LAST = 3.0  # s for the last of them


def default_folder(rig: str) -> Path:
    """A new folder's name for a commissioning of this rig that begins now."""
    name = re.sub(r"[^a-z0-9]+", "-", rig.lower()).strip("-")
    return Path(f"commission-{name}-{datetime.fromtimestamp(date()):%Y%m%d-%H%M%S}")


def read_report(path: Path) -> Findings:
    """A report of an earlier commissioning. Raises UsageError."""
    raw = read_bytes(path, str(path), LARGEST)
    try:
        return Findings.from_json(raw.decode("utf-8"))
    except UnicodeDecodeError as error:
        raise UsageError(f"{path}: cannot be read: {error}") from None
    except UsageError as error:
        raise UsageError(f"{path}: {error}") from None


class Results:
    """A new `folder` with the capture of the link at `address`, open while it is entered.

    Serial numbers are in it only with `serials`. `now` is a clock in s. A thread writes the capture. Raises UsageError
    for a folder that exists, OutputError where it cannot be made.
    """

    def __init__(
        self,
        folder: Path,
        address: LinkAddress,
        device: str,
        now: Callable[[], float],
        *,
        serials: bool = False,
        before: Findings | None = None,
    ) -> None:
        if before is not None and before.device != device:
            raise UsageError(f"the earlier report is of a {before.device}, not of a {device}")
        self.folder, self._serials, self._before = folder, serials, before
        self._source = _source(address, device)
        self.capture = folder / (CAPTURE + (".log" if self._source.kind == "can" else ".mcap"))
        try:
            folder.mkdir(parents=True)
        except FileExistsError:
            raise UsageError(f"{folder}: already exists; choose another folder") from None
        except OSError as error:
            raise OutputError(folder, error.strerror or str(error)) from None
        numbers = None if serials else SerialNumbers(self._source)
        self._recording = Recording(CaptureWriter(self.capture, self._source), numbers, now)
        self._over, self._trouble = threading.Event(), ""
        self._written = False
        self._thread = threading.Thread(target=self._work, name="capture", daemon=True)
        self._thread.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """The capture is complete. Without a report nothing of it is left behind."""
        self.close()
        if not self._written:
            self.capture.unlink(missing_ok=True)
            with suppress(OSError):  # not empty: another has put something there
                self.folder.rmdir()

    def close(self) -> None:
        """Complete the capture; waits LAST s for the disk at most. Closing it again is fine."""
        self._over.set()
        self._thread.join(LAST)
        if self._thread.is_alive():
            self._trouble = self._trouble or f"{self.capture}: the disk does not answer"

    def tap(self, link: Link) -> Link:
        """The link to use in the place of `link`: all that passes is in the capture."""
        return tap(link, self._recording, self._source)

    def write(self, findings: Findings) -> Sequence[Path]:
        """Write the page and the report, also again; the files of the folder. Raises OutputError."""
        self._written = True
        files = [self.folder / PAGE, self.folder / REPORT]
        write_text(files[0], page(findings, self._serials, self._before))
        write_text(files[1], findings.to_json(self._serials))
        return [*files, self.capture]

    @property
    def summary(self) -> str:
        """What is in the capture, in a line, and what is wrong with it."""
        return "; ".join([self._recording.summary(), *([self._trouble] if self._trouble else [])])

    def _work(self) -> None:
        """A disk that is slow or full must not hold up what moves."""
        try:
            while not self._over.wait(LOOK):
                self._recording.look()
            self._recording.close()
        except OutputError as error:
            self._trouble = str(error)
            self._over.wait()


def change_lines(before: Findings, now: Findings) -> list[str]:
    """What changed, a line each; one line when nothing did."""
    lines = [f"{name}: {was or '-'} -> {is_now or '-'}" for name, was, is_now in heading(before, now)]
    lines += [f"{each.title}: {shown(each.before)} -> {shown(each.now)}" for each in changes(before, now)]
    return lines or ["nothing changed"]


def _source(address: LinkAddress, device: str) -> Source:
    """A simulated gimbal is captured as on a bus, a simulated drone as on a serial line."""
    is_serial = address.kind == "serial" or (address.kind == "sim" and device == "drone")
    name = interface_name(address.channel or "sim")
    return Source("serial" if is_serial else "can", name, "drone" if device == "drone" else "gimbal")
