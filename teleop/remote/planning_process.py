"""Plans moves for the control process, in a process of its own: `python -m teleop.remote.planning_process`.

Planning computes for a second, and the control thread shares its interpreter with everything else in its process. Both
ends are ours, so what passes is pickled. It ends with its input.
"""

from __future__ import annotations

import os
import pickle
import signal
import struct
import subprocess
import sys
from collections.abc import Mapping
from contextlib import suppress
from typing import IO, TYPE_CHECKING, Any

from teleop.config.profile import Profile
from teleop.core.errors import TeleopError
from teleop.remote.moves import Sent, refuse_files

if TYPE_CHECKING:
    from teleop.app.planning import Plan
    from teleop.sequence.compile import CompiledSequence
    from teleop.timelapse.compile import Timelapse

HEAD = struct.Struct("!I")
NICE = 5

What = str | Sent | Mapping[str, Any]
"""A move: a file or a shipped one's name, one that was sent, or its content."""


def send(stream: IO[bytes], what: object) -> None:
    data = pickle.dumps(what)
    stream.write(HEAD.pack(len(data)) + data)
    stream.flush()


def receive(stream: IO[bytes]) -> Any:
    """Raises EOFError at the end."""
    head = stream.read(HEAD.size)
    if len(head) < HEAD.size:
        raise EOFError
    return pickle.loads(stream.read(HEAD.unpack(head)[0]))


def why(error: TeleopError) -> str:
    """All that is wrong, in one line."""
    return "; ".join(getattr(error, "problems", ()) or [str(error)])


class PlanningProcess:
    """One that has ended is started again. `plan` waits, so call it in a thread."""

    def __init__(self, profile: Profile) -> None:
        self._profile = profile
        self._process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        """Have it load what it needs before the first plan is asked for."""
        self._running()

    def plan(self, what: What) -> CompiledSequence:
        """The move in a file, or with this content. Raises TeleopError with the reason."""
        return self._answer(False, what)

    def timelapse(self, file: str) -> Timelapse:
        """The timelapse in a file. Raises TeleopError with the reason."""
        return self._answer(True, file)

    def _answer(self, shoots: bool, what: What) -> Any:
        process = self._running()
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            send(process.stdin, (shoots, what))
            found = receive(process.stdout)
        except (OSError, EOFError):
            self.close()
            raise TeleopError("the process that plans has ended: try again") from None
        if isinstance(found, str):
            raise TeleopError(found)
        return found

    def _running(self) -> subprocess.Popen[bytes]:
        if self._process is None or self._process.poll() is not None:
            command = [sys.executable, "-m", __spec__.name if __name__ != "__main__" else __name__]
            self._process = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
            )
            assert self._process.stdin is not None
            with suppress(OSError):
                send(self._process.stdin, self._profile)
        return self._process

    def close(self) -> None:
        process, self._process = self._process, None
        if process is not None:
            process.kill()
            process.wait()
            for stream in (process.stdin, process.stdout):
                if stream is not None:
                    with suppress(OSError):
                        stream.close()


def main() -> None:
    from teleop.app.planning import plan_content, plan_file

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # a Ctrl-C of the terminal is for the control process
    with suppress(OSError, AttributeError):
        os.nice(NICE)
    reading, writing = sys.stdin.buffer, sys.stdout.buffer
    sys.stdout = sys.stderr
    with suppress(EOFError, OSError):
        profile = receive(reading)
        while True:
            shoots, given = receive(reading)
            try:
                what = given
                if isinstance(given, Sent):
                    refuse_files(given.file)
                    what = str(given.file)
                plan = plan_file(what, profile) if isinstance(what, str) else plan_content(what, profile)
                found = shot_of(plan) if shoots else played_of(plan)
            except TeleopError as error:
                found = why(error)
                if isinstance(given, Sent):
                    found = found.replace(f"{given.file.parent}/", "")
            send(writing, found)


def played_of(plan: Plan) -> CompiledSequence:
    """Raises TeleopError for a move that is none to play from a console."""
    if plan.timelapse is not None:
        raise TeleopError("it is a timelapse: shoot it")
    if plan.is_flown:
        raise TeleopError("it flies a drone, which needs an operator at the rig: use teleop play")
    return plan.sequence


def shot_of(plan: Plan) -> Timelapse:
    """Raises TeleopError for a move that is none to shoot from a console."""
    if plan.timelapse is None:
        raise TeleopError("it is no timelapse: play it")
    if plan.is_flown:
        raise TeleopError("a timelapse cannot fly a drone: leave out the stick axes")
    return plan.timelapse


if __name__ == "__main__":
    main()
