"""A whole shoot on virtual time: the real rig over frames, the simulated gimbal and its camera, and what they saw."""

from __future__ import annotations

import resource
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from hooked_clock import HookedClock

from teleop.app.shoot_runner import Ended, Shooting
from teleop.config.profile import Profile, load_profile
from teleop.core.axes import Axis
from teleop.core.events import Tick
from teleop.core.operator_input import Held, Press
from teleop.devices import rig
from teleop.dji.gimbal import camera
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.camera import CameraCommand
from teleop.dji.gimbal.session import Session
from teleop.dji.message import Message, ReturnCode
from teleop.sim.gimbal.device import SimulatedGimbal
from teleop.timelapse.compile import Timelapse, load_timelapse
from teleop.timelapse.journal import FrameState, Journal, Shoot, open_journal

FILE = """
title: Dusk
fps: 24
keyframes:
  - {at: 0, pan: -30, tilt: -5}
  - {at: LAST, pan: 60, tilt: 10}
timelapse:
  frames: COUNT
  interval: INTERVAL
  exposure: EXPOSURE
"""


class Shot(NamedTuple):
    """A press of the shutter as the camera felt it: when (s), the angles and the rates then (deg, deg/s)."""

    time: float
    pan: float
    tilt: float
    rate: float


class CountingGimbal(SimulatedGimbal):
    """Keeps every press, and every message with its time; `camera_says` may refuse (a code) or be silent (None).

    `trembles` is by how much the yaw that it tells is off, in deg, so many s after it was last sent elsewhere.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.shots: list[Shot] = []
        self.heard: list[tuple[float, Message]] = []
        self.places: list[tuple[float, float, float]] = []  # time, yaw and pitch, whenever it is told something
        self.turned: list[tuple[float, float]] = []  # time, and the fastest rate
        self.camera_says: Callable[[int], int | None] = lambda _count: 0
        self.deaf: Callable[[float], bool] = lambda _now: False
        self.trembles: Callable[[float], float] = lambda _since: 0.0
        self._sent_away, self._aim = 0.0, 0.0  # when (s), and to which yaw (deg)
        self._listening = Session()
        self._presses = 0

    def receive(self, data: bytes, now: float) -> None:
        if self.deaf(now):
            return
        self.heard += [(now, received.message) for received in self._listening.receive(data, now)]
        super().receive(data, now)
        self.places.append((now, self.angles.yaw, self.angles.pitch))
        self.turned.append((now, max(map(abs, self.rates))))

    def _obey(self, message: Message):
        if isinstance(message, camera.Command) and message.command == CameraCommand.SHUTTER:
            self._presses += 1
            says = self.camera_says(self._presses - 1)
            if says != 0:
                return SILENT if says is None else ReturnCode(says)
            angles, rates = self.angles, self.rates
            self.shots.append(Shot(self._now, angles.yaw, angles.pitch, max(map(abs, rates))))
        if isinstance(message, gimbal.Position) and message.yaw != self._aim:
            self._sent_away, self._aim = self._now, message.yaw
        answer = super()._obey(message)
        if isinstance(answer, gimbal.AnglesReply):
            return replace(answer, yaw=answer.yaw + self.trembles(self._now - self._sent_away))
        return answer

    def _reply(self, frame, answer) -> None:
        if answer is not SILENT:
            super()._reply(frame, answer)

    def heard_of(self, kind: type[Message]) -> list[float]:
        return [time for time, message in self.heard if isinstance(message, kind)]


SILENT: Any = object()


class Keys:
    """What is pressed at a time on the clock, once."""

    name = "keys"

    def __init__(self) -> None:
        self.presses: list[tuple[float, Press]] = []

    def read(self, now: float) -> Held:
        due = [press for time, press in self.presses if time <= now]
        self.presses = [each for each in self.presses if each[0] > now]
        return Held(presses=due)


class Watcher:
    """A sink that passes each tick to the stage's `watch`."""

    def __init__(self, stage: Stage) -> None:
        self._stage = stage

    def observe(self, tick: Tick) -> None:
        self._stage.watch(tick)


class Stage:
    """`gimbals` are those of each run, the one of the last run last; their camera is one, so their shots are added up.

    `watch` is called with each tick.
    """

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.folder = folder
        self.clock: Any = HookedClock()
        self.gimbals: list[CountingGimbal] = []
        self.said: list[str] = []
        self.executor: Executor | None = None
        self.keys: Keys | None = None
        self.stands: tuple[float, float, float] | None = None  # where the next gimbal is found; None: where it was left
        self.prepare: Callable[[CountingGimbal], None] = lambda _gimbal: None
        self.watch: Callable[[Any], None] = lambda _tick: None
        self.shooting: Shooting
        self.timelapse: Timelapse
        self.profile: Profile = load_profile("sim")

        def gimbal_made(**options: Any) -> CountingGimbal:
            made = CountingGimbal(boot=self.stands or self._stood(), **options)
            self.prepare(made)
            self.gimbals.append(made)
            return made

        monkeypatch.setattr(rig, "SimulatedGimbal", gimbal_made)

    def _stood(self) -> tuple[float, float, float]:
        return self.gimbals[-1].angles if self.gimbals else (0.0, 0.0, 0.0)

    def write(
        self, count: int, interval: str, more: str = "", exposure: str = "0.2s", by_hand: bool = False
    ) -> Timelapse:
        text = FILE.replace("COUNT", str(count)).replace("LAST", str(count - 1)).replace("INTERVAL", interval)
        (self.folder / "dusk.yaml").write_text(text.replace("EXPOSURE", exposure) + more)
        found = load_timelapse(str(self.folder / "dusk.yaml"), self.profile.limits, "the rig", by_hand)
        assert found is not None
        self.timelapse = found
        return found

    @contextmanager
    def journal(self, **how: bool):
        shoot = Shoot("dusk.yaml", self.timelapse.identity, self.timelapse.frames)
        with open_journal(self.folder / "dusk.journal", shoot, **{"patient": True, **how}) as journal:
            yield journal

    def shoot(self, journal: Any = None, **how: Any) -> Ended:
        """The whole shoot, or what is left of it."""
        if journal is None:
            in_doubt = how.pop("in_doubt", "shoot")
            by_hand = how.pop("by_hand", False)
            with self.journal(**how) as opened:
                return self.shoot(opened, in_doubt=in_doubt, by_hand=by_hand)
        self.shooting = Shooting(
            self.timelapse,
            self.profile,
            self.clock,
            journal,
            self.said.append,
            [Watcher(self)],
            self.keys,
            executor=self.executor,
            **how,
        )
        return self.shooting.run()

    @property
    def shots(self) -> list[Shot]:
        return [shot for each in self.gimbals for shot in each.shots]

    @property
    def due(self) -> list[float]:
        """When each frame is due after the first."""
        return [self.timelapse.slots.at(frame) for frame in range(self.timelapse.frames)]

    def off(self, shot: Shot, frame: int) -> float:
        """How far from its place a frame was shot, in deg."""
        place = self.timelapse.path.at(frame)
        return max(abs(shot.pan - place[Axis.PAN]), abs(shot.tilt - place[Axis.TILT]))

    def silences(self) -> float:
        """The longest time for which the gimbal heard nothing that keeps it awake, in s."""
        times = sorted(time for each in self.gimbals for time in each.heard_of(gimbal.Position))
        return max(b - a for a, b in pairwise(times))


class SlowBook:
    """A journal whose disk takes `held[frame]` s to say that a frame has been begun."""

    def __init__(self, journal: Journal, stage: Stage, held: Mapping[int, float]) -> None:
        self._journal, self._stage, self._held = journal, stage, held
        self._since: dict[int, float] = {}

    def __getattr__(self, name: str) -> Any:
        return getattr(self._journal, name)

    def note(self, frame: int | None, state: FrameState) -> Any:
        note = self._journal.note(frame, state)
        held = self._held.get(frame, 0.0) if frame is not None and state is FrameState.BEGUN else 0.0
        if not held or frame is None:
            return note
        end = self._since.setdefault(frame, self._stage.clock.now()) + held
        return SlowNote(lambda: self._stage.clock.now() >= end)


class SlowNote:
    """A note that is safe once `over` says so."""

    failed = False

    def __init__(self, over: Callable[[], bool]) -> None:
        self._over = over

    @property
    def safe(self) -> bool:
        return self._over()


@contextmanager
def small_disk(size: int):
    """No file of this process may grow beyond `size` bytes: a write fails as on a full disk."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
