"""Shoots in processes that can be killed: everything is imported and planned once, so a fresh one costs milliseconds.

Started with a folder; for each line on stdin it forks a child that shoots there (`resume` goes on with what was left),
writes the child's pid and, when it has ended, its wait status. The gimbal is behind a Unix socket in that folder.
"""

from __future__ import annotations

import os
import signal
import socket
import sys
import traceback
from pathlib import Path

from teleop.app.shoot_runner import Shooting
from teleop.config.profile import Profile, load_profile
from teleop.core.clock import SystemClock
from teleop.core.errors import LinkError
from teleop.core.run_state import Result
from teleop.devices import rig
from teleop.timelapse.compile import Timelapse, load_timelapse
from teleop.timelapse.journal import Shoot, open_journal

PROFILE = """
name: Quick
links: {gimbal: "virtual:quick"}
axes:
  pan: {min: -180, max: 180, velocity: 5000, acceleration: 500000, jerk: 100000000}
sinks:
  - {type: gimbal, link: gimbal, mode: position, rate: 100, max_following_error: 180}
  - {type: camera, link: gimbal}
"""
FRAMES = 60
FILE = f"""
keyframes: [{{at: 0, pan: 0}}, {{at: {FRAMES - 1}, pan: {FRAMES - 1}}}]
ease: 1f
timelapse: {{frames: {FRAMES}, interval: 0.05s, exposure: 0.01s, settle: 0}}
"""
SOCKET, SAID = "gimbal.sock", "said"


class SocketLink:
    """A teleop.links.ClosableLink to whatever listens in the folder: bytes that have left survive their sender."""

    def __init__(self, path: Path) -> None:
        self._socket = socket.socket(socket.AF_UNIX)
        self._socket.connect(str(path))
        self._socket.setblocking(False)
        self.counts: dict[str, int] = {}

    def send(self, data: bytes) -> None:
        try:
            self._socket.sendall(data)
        except OSError as error:
            raise LinkError(str(error)) from None

    def receive(self) -> bytes:
        try:
            return self._socket.recv(65536)
        except BlockingIOError:
            return b""

    def close(self) -> None:
        self._socket.close()


def serve(folder: Path) -> None:
    profile = load_profile(str(folder / "quick.yaml"))
    timelapse = load_timelapse(str(folder / "quick-shoot.yaml"), profile.limits, profile.name)
    assert timelapse is not None
    _notify("ready")
    for line in sys.stdin:
        child = os.fork()
        if child == 0:
            code = 2
            try:
                rig.open_link = lambda _url, **_options: SocketLink(folder / SOCKET)  # type: ignore[assignment]
                code = shoot(folder, profile, timelapse, resume=line.strip() == "resume")
            except BaseException:  # noqa: BLE001 - whatever it is, a forked child must not go on as its parent
                traceback.print_exc()
            os._exit(code)
        _notify(child)
        _notify(os.waitpid(child, 0)[1])


def _notify(word: object) -> None:
    sys.stdout.write(f"{word}\n")
    sys.stdout.flush()


def shoot(folder: Path, profile: Profile, timelapse: Timelapse, resume: bool) -> int:
    with (folder / SAID).open("a", buffering=1) as said:
        belongs = Shoot("quick-shoot.yaml", timelapse.identity, timelapse.frames)
        with open_journal(folder / "quick.journal", belongs, resume=resume) as journal:
            ended = Shooting(timelapse, profile, SystemClock(), journal, lambda text: said.write(text + "\n")).run()
            said.writelines(f"stopped: {reason}\n" for reason in ended.reasons)
            return 0 if ended.result is Result.DONE else 1


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    serve(Path(sys.argv[1]))
