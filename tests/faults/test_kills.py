"""SIGKILL at a hundred random instants, counted at the camera, which outlives every one of them."""

from __future__ import annotations

import os
import random
import select
import signal
import socket
import sqlite3
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

from kill_server import FILE, FRAMES, PROFILE, SAID, SOCKET

from teleop.config.profile import load_profile
from teleop.core.axes import Axis
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.camera import CameraCommand, Command
from teleop.dji.gimbal.session import Session
from teleop.sim.gimbal.device import SimulatedGimbal
from teleop.timelapse.compile import load_timelapse

KILLS, LANES = 102, 3
LIFE = 0.05, 0.55  # s from a child's start to its end; the first shutter comes after about 0.2
LONGEST = 30.0  # s for a run that nobody kills


class AimedGimbal(SimulatedGimbal):
    """`presses` is where the pan was told to be at each press of the shutter, in deg: which frame that is."""

    def __init__(self) -> None:
        super().__init__()
        self.presses: list[float] = []
        self._aim = 0.0
        self._listening = Session()

    def receive(self, data: bytes, now: float) -> None:
        for received in self._listening.receive(data, now):
            if isinstance(received.message, gimbal.Position):
                self._aim = received.message.yaw
            if isinstance(received.message, Command) and received.message.command == CameraCommand.SHUTTER:
                self.presses.append(self._aim)
        super().receive(data, now)


def kill(child: int) -> None:
    with suppress(ProcessLookupError):  # it was over just now; its status says how
        os.kill(child, signal.SIGKILL)


@dataclass
class Lane:
    """One folder, one gimbal, one server of children; `runs` are what each child left behind."""

    folder: Path
    server: subprocess.Popen[str]
    listener: socket.socket
    places: Sequence[float]
    gimbal: AimedGimbal = field(default_factory=AimedGimbal)
    kills: int = 0

    def frame_at(self, pan: float) -> int:
        """The frame whose place this is, to the tenth of a degree that the wire has."""
        frame = min(range(FRAMES), key=lambda frame: abs(self.places[frame] - pan))
        assert abs(self.places[frame] - pan) < 0.06
        return frame

    def run(self, how: str, life: float) -> int:
        """A child that is killed after `life` s, unless it is done by then; its wait status."""
        assert self.server.stdin is not None
        assert self.server.stdout is not None
        self.server.stdin.write(f"{how}\n")
        self.server.stdin.flush()
        child = int(self.server.stdout.readline())
        end = time.monotonic() + life
        if not select.select([self.listener], [], [], life)[0]:  # killed before it had a link
            kill(child)
            return int(self.server.stdout.readline())
        link, _ = self.listener.accept()
        with link:
            self._serve(link, child, end)
        return int(self.server.stdout.readline())

    def _serve(self, link: socket.socket, child: int, end: float) -> None:
        """Until the child has gone, by itself or killed at `end`, and all that it sent has been obeyed."""
        while True:
            left = end - time.monotonic()
            if left <= 0:
                kill(child)
                end = float("inf")
            if select.select([link], [], [], min(0.002, max(left, 0.0)))[0]:
                try:
                    data = link.recv(65536)
                except ConnectionResetError:
                    data = b""
                if not data:
                    return
                self.gimbal.receive(data, time.monotonic())
            if answer := self.gimbal.advance(time.monotonic()):
                try:
                    link.sendall(answer)
                except (BrokenPipeError, ConnectionResetError):
                    continue  # it is dead; what it sent before is still to be read

    def journal(self) -> tuple[list[int], list[int], bool]:
        """Frames done, frames begun and not confirmed, and whether the shoot is finished, as they are on the disk."""
        with closing(sqlite3.connect(self.folder / "quick.journal")) as database:
            states = dict(database.execute("SELECT frame, state FROM frames ORDER BY frame").fetchall())
            finished = database.execute("SELECT value FROM shoot WHERE name = 'finished'").fetchall() == [(1,)]
        assert set(states.values()) <= {"done", "begun", "unshot"}
        return (
            [frame for frame, state in states.items() if state == "done"],
            [frame for frame, state in states.items() if state == "begun"],
            finished,
        )


def places(folder: Path) -> Sequence[float]:
    """Where the pan is at each frame, in deg."""
    limits = load_profile(str(folder / "quick.yaml")).limits
    timelapse = load_timelapse(str(folder / "quick-shoot.yaml"), limits, "the rig")
    assert timelapse is not None
    return timelapse.path.positions(FRAMES)[Axis.PAN].tolist()


@contextmanager
def lane(folder: Path) -> Iterator[Lane]:
    folder.mkdir()
    (folder / "quick.yaml").write_text(PROFILE)
    (folder / "quick-shoot.yaml").write_text(FILE)
    script = Path(sys.modules["kill_server"].__file__ or "")
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind(str(folder / SOCKET))
        listener.listen()
        server = subprocess.Popen(
            [sys.executable, str(script), str(folder)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        try:
            assert server.stdout is not None
            assert server.stdout.readline() == "ready\n"
            yield Lane(folder, server, listener, places(folder))
        finally:
            server.kill()
            server.communicate()


def shoot_to_the_end(where: Lane, chance: random.Random, kills: int) -> None:
    """One whole shoot, killed again and again until it is over or so many kills are done; every run is checked."""
    shot: list[int] = []  # frames as the camera had them, in order
    named, doubted, finished, how = 0, [], False, "begin"
    first = 0
    while not finished:
        before = len(where.gimbal.presses)
        killed = where.kills < kills
        status = where.run(how, chance.uniform(*LIFE) if killed else LONGEST)
        pressed = [where.frame_at(aim) for aim in where.gimbal.presses[before:]]
        if not (where.folder / "quick.journal").exists():
            assert pressed == []
            assert os.WIFSIGNALED(status), (status, (where.folder / SAID).read_text())
            where.kills += 1
            continue
        done, doubt, finished = where.journal()
        assert finished or os.WIFSIGNALED(status), (status, (where.folder / SAID).read_text())
        where.kills += os.WIFSIGNALED(status)
        assert pressed == list(range(first, first + len(pressed))), "the exact frame, and each after it"
        assert done == list(range(len(done))), "no frame is passed over"
        assert len(doubt) <= 1
        assert doubt in ([], [len(done)]), "only the next can be in doubt"
        confirmed = len(done) - first
        assert len(pressed) - confirmed in ((0, 1) if doubt else (0,)), "done once, no more, no less"
        assert (where.folder / SAID).read_text().count("may be missing") == named, "the one of the run before was named"
        shot += pressed
        doubted += [frame for frame in doubt if frame in pressed]
        named += len(doubt)
        first, how = len(done), "resume" if done or doubt else "begin"
    assert sorted(shot) == sorted([*range(FRAMES), *doubted]), "every frame once; twice only what was in doubt"
    (where.folder / SAID).write_text("")


def kill_many(where: Lane, chance: random.Random, kills: int) -> int:
    while where.kills < kills:
        shoot_to_the_end(where, chance, kills)
    return where.kills


def test_no_frame_is_lost_or_shot_twice_whenever_the_process_is_killed(tmp_path: Path) -> None:
    folders: Sequence[Path] = [tmp_path / str(number) for number in range(LANES)]

    def of(folder: Path) -> int:
        with lane(folder) as where:
            return kill_many(where, random.Random(folder.name), KILLS // LANES)

    with ThreadPoolExecutor(LANES) as pool:
        assert sum(pool.map(of, folders)) >= 100
