"""JACK without a sound card: `jackd` with its dummy driver, and a MIDI controller that is one of its clients."""

from __future__ import annotations

import importlib
import os
import shutil
import subprocess
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from page_bench import until

INSTALLED = shutil.which("jackd") is not None


@contextmanager
def jack_server(period: int = 1024) -> Iterator[None]:
    """A server of this process's own, which it and its children find by the environment; `period` in samples."""
    name = f"teleop{os.getpid()}"
    before = os.environ.get("JACK_DEFAULT_SERVER")
    os.environ["JACK_DEFAULT_SERVER"] = name
    # It waits for its clients in each period: without real time it would go on without one that is late, and drop
    # what that one was sent.
    waits = ["--sync", "--timeout", "10000"]
    command = ["jackd", "--no-realtime", *waits, "--name", name, "-d", "dummy", "-r", "48000", "-p", str(period)]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        until(_answers)
        yield
    finally:
        process.terminate()
        process.wait(10)
        if before is None:
            del os.environ["JACK_DEFAULT_SERVER"]
        else:
            os.environ["JACK_DEFAULT_SERVER"] = before


def _answers() -> bool:
    return subprocess.run(["jack_lsp"], capture_output=True, check=False, timeout=20).returncode == 0


class JackController:
    """A controller: ports of this name, through which it sends, and keeps what it is sent."""

    def __init__(self, name: str) -> None:
        rtmidi: Any = importlib.import_module("rtmidi")

        self._out, self._in = rtmidi.MidiOut(rtmidi.API_UNIX_JACK, name), rtmidi.MidiIn(rtmidi.API_UNIX_JACK, name)
        self._lock, self._got = threading.Lock(), []
        self._in.set_callback(self._take)
        self._out.open_virtual_port("out")
        self._in.open_virtual_port("in")

    def _take(self, event: tuple[list[int], float], _data: Any) -> None:
        with self._lock:
            self._got.append(tuple(event[0]))

    @property
    def got(self) -> Sequence[tuple[int, ...]]:
        with self._lock:
            return list(self._got)

    def send(self, *data: int) -> None:
        self._out.send_message(list(data))

    def close(self) -> None:
        for port in (self._out, self._in):
            port.close_port()
            port.delete()
