"""Sound that comes in, in a thread: from arecord, or from a pipe that another program writes to; and when it was heard.

A sample is timed by its number. What our clock is ahead of that, the quickest blocks of the last seconds tell: a block
comes late now and then, never early.
"""

from __future__ import annotations

import os
import select
import subprocess
import threading
from collections import deque
from collections.abc import Callable
from time import monotonic

from teleop.core.errors import DeviceError

BLOCK = 0.01  # s of sound read at a time
QUICKEST = 5.0  # s of blocks that tell
GAP = 0.2  # s without a block, after which the sound counts as interrupted: its samples no longer tell what was before
AGAIN = 0.2  # s between two looks whether it is over

Heard = Callable[[bytes, float], object]


class SampleClock:
    """What our clock is ahead of the samples; `samples` in a second."""

    def __init__(self, samples: int) -> None:
        self._samples, self._count = samples, 0
        self._offsets: deque[tuple[float, float]] = deque()  # arrival, and arrival less the sound's own time

    def add(self, count: int, now: float) -> None:
        """So many more have come by now."""
        self._count += count
        offset = now - self._count / self._samples
        if self._offsets and now - self._offsets[-1][0] > GAP:
            self._offsets.clear()
        while self._offsets and self._offsets[-1][1] >= offset:
            self._offsets.pop()
        self._offsets.append((now, offset))
        while now - self._offsets[0][0] > QUICKEST:
            self._offsets.popleft()

    @property
    def offset(self) -> float:
        """In s, since the first sample; some must have come."""
        return self._offsets[0][1]


class Sound:
    """Sound of `device` (alsa:NAME or pipe:FILE); each block and its time of arrival goes to `heard`, in a thread.

    `ended` has why there is no more. Raises DeviceError.
    """

    def __init__(self, device: str, samples: int, heard: Heard) -> None:
        kind, _, name = device.partition(":")
        self._heard, self._size = heard, max(1, int(samples * BLOCK)) * 2
        self._process: subprocess.Popen[bytes] | None = None
        self.ended = ""
        self._over = threading.Event()
        try:
            if kind == "alsa":
                self._process = _recorder(name, samples)
                assert self._process.stdout is not None
                self._file = os.dup(self._process.stdout.fileno())
            else:
                self._file = os.open(name, os.O_RDONLY | os.O_NONBLOCK)
        except FileNotFoundError as error:
            missing = "arecord is not installed: sudo apt install alsa-utils" if kind == "alsa" else str(error)
            raise DeviceError(f"no sound from {device}: {missing}") from None
        except OSError as error:
            raise DeviceError(f"no sound from {device}: {error.strerror or error}") from None
        self._thread = threading.Thread(target=self._read, name="sound", daemon=True)
        self._thread.start()

    def _read(self) -> None:
        while not self._over.is_set():
            if not select.select([self._file], [], [], AGAIN)[0]:
                continue
            try:
                data = os.read(self._file, self._size)
            except BlockingIOError:
                continue
            except OSError as error:
                self.ended = error.strerror or str(error)
                return
            if data:
                self._heard(data, monotonic())
            elif self._process is not None:
                self.ended = self._why()
                return
            else:
                self._over.wait(AGAIN)  # nobody writes to the pipe at present

    def _why(self) -> str:
        assert self._process is not None
        assert self._process.stderr is not None
        return self._process.stderr.read(300).decode(errors="replace").strip() or "arecord has ended"

    def close(self) -> None:
        self._over.set()
        if self._process is not None:
            self._process.kill()
        self._thread.join(2 * AGAIN)
        os.close(self._file)
        if self._process is not None:
            for stream in (self._process.stdout, self._process.stderr):
                if stream is not None:
                    stream.close()
            self._process.wait()


def _recorder(name: str, samples: int) -> subprocess.Popen[bytes]:
    command = ["arecord", "-q", "-D", name, "-t", "raw", "-f", "S16_LE", "-c", "1", "-r", str(samples)]
    command += ["--period-time", "10000", "--buffer-time", "200000"]
    return subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
