"""The gateway as a child of the control process: started, listened to, and started again when it ends or hangs.

What the child is told comes by its input, which stays open as long as this process lives: so the child knows when it
has ended, whatever ended it. All of it happens in a thread of its own; nothing here is the control thread's.
"""

from __future__ import annotations

import json
import os
import select
import subprocess
import sys
import threading
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from time import monotonic
from typing import Any, NamedTuple

from teleop.core.invitation import Invitation

MODULE = "teleop.gateway"
MOST, WITHIN = 3, 60.0  # starts again, in so many s
HUNG = 5.0  # s without a word, after which it is ended
STARTING = 20.0  # s for its first word
LOOK = 0.1  # s between two looks
LEAVING = 0.5  # s that it has to end by itself
LINES = 20  # of what it has to say that are passed on within that time, at most


class Gateway(NamedTuple):
    """What the gateway is told when it starts, the descriptors that it inherits, and lines on how it is reached.

    `invitation` is for who has a browser, None without a console.
    """

    settings: Mapping[str, Any]
    passed: Sequence[int] = ()
    greetings: Sequence[str] = ()
    invitation: Invitation | None = None


class GatewayChild:
    """`settings` are told to each child, `passed` are descriptors that it inherits.

    `heard` is when the child last spoke to the door (s, `monotonic`). `notify` takes lines, `ended` is called when a
    child is gone, both in this thread.
    """

    def __init__(
        self,
        settings: Mapping[str, Any],
        passed: Sequence[int],
        heard: Callable[[], float],
        notify: Callable[[str], object],
        ended: Callable[[], object],
    ) -> None:
        self._settings, self._passed, self._heard = settings, passed, heard
        self._notify, self._ended = notify, ended
        self._over = threading.Event()
        self._starts: deque[float] = deque()  # of the last minute
        self._lines: deque[float] = deque()  # when those of the last minute were passed on
        self.process: subprocess.Popen[bytes] | None = None
        self._thread = threading.Thread(target=self._run, name="gateway", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def close(self) -> None:
        """End the child and the thread."""
        self._over.set()
        if self._thread.is_alive():
            self._thread.join(LEAVING + 1.0)

    def _run(self) -> None:
        # The child dies with the thread that started it (PR_SET_PDEATHSIG), so one thread starts them all.
        while not self._over.is_set():
            self._begin()
            why = self._watch()
            if self._over.is_set():
                break
            self._ended()
            self._wait_for_turn(why)
        self._end()

    def _begin(self) -> None:
        self._starts.append(monotonic())
        command = [sys.executable, "-m", MODULE]
        self.process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            pass_fds=self._passed,
            start_new_session=True,  # a Ctrl-C of the terminal is for the control process
        )
        assert self.process.stdin is not None
        with suppress(OSError):
            self.process.stdin.write(json.dumps(self._settings).encode() + b"\n")
            self.process.stdin.flush()

    def _watch(self) -> str:
        """Why the child is no more; "" once all is over."""
        process, began = self.process, monotonic()
        assert process is not None
        while not self._over.is_set():
            if (code := process.poll()) is not None:
                self._pass_lines(process)
                self._close_pipes(process)
                return f"ended ({f'signal {-code}' if code < 0 else f'code {code}'})"
            heard, now = self._heard(), monotonic()
            if now - (heard if heard > began else began + STARTING - HUNG) > HUNG:
                process.kill()
                process.wait()
                self._close_pipes(process)
                return f"did not answer for {HUNG:g} s"
            self._pass_lines(process, LOOK)
        return ""

    def _wait_for_turn(self, why: str) -> None:
        now = monotonic()
        while self._starts and now - self._starts[0] > WITHIN:
            self._starts.popleft()
        if len(self._starts) <= MOST:
            self._notify(f"the gateway {why}: started again; the rig goes on")
            return
        left = WITHIN - (now - self._starts[0])
        self._notify(f"the gateway {why}, {len(self._starts)} times in a minute: started again in {left:.0f} s")
        self._over.wait(left)

    def _pass_lines(self, process: subprocess.Popen[bytes], wait: float = 0.0) -> None:
        """What it has to complain of; a flood of lines is read, and dropped."""
        assert process.stderr is not None
        if process.stderr.closed or not select.select([process.stderr], [], [], wait)[0]:
            return
        text = os.read(process.stderr.fileno(), 65536).decode(errors="replace")
        if not text:
            self._over.wait(wait)  # closed, while it still runs
        now = monotonic()
        while self._lines and now - self._lines[0] > WITHIN:
            self._lines.popleft()
        for line in text.splitlines():
            if line.strip() and len(self._lines) < LINES:
                self._lines.append(now)
                self._notify(f"gateway: {line.strip()[:200]}")

    def _end(self) -> None:
        process = self.process
        if process is None or process.poll() is not None:
            return
        self._close_pipes(process)  # which tells it to end
        try:
            process.wait(LEAVING)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()

    def _close_pipes(self, process: subprocess.Popen[bytes]) -> None:
        for stream in (process.stdin, process.stderr):
            if stream is not None:
                with suppress(OSError):
                    stream.close()
