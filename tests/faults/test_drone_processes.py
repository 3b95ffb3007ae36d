"""A drone at the far end of a serial line, flown by a real process that is frozen, killed, or loses its adapter."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from subprocess import Popen

import pytest
from command import running
from drone_fault_bench import check_enables
from waiting import wait_until

from teleop.core.clock import SystemClock
from teleop.dji.drone.session import OnboardSession
from teleop.dji.drone.virtual_rc import NEUTRAL, Sticks, VirtualRc
from teleop.dji.message import Message
from teleop.links.pty import PtyLink
from teleop.sim.drone.controls import Pilot
from teleop.sim.drone.device import SimulatedDrone
from teleop.sim.drone.settings import VIRTUAL_RC_TIMEOUT

AXES = "stick_roll", "stick_pitch", "stick_throttle", "stick_yaw"
STICKS = "time,stick_roll,stick_pitch,stick_throttle,stick_yaw\n0,0,0,0,0\n0.5,0,0.5,0,0\n40,0,0,0,0\n"
FORWARD = 1024 + 330
LOOK = 0.002  # s


class FarDrone:
    """A drone that hovers, on a serial line; `heard` is all that reached it, by the machine's clock."""

    def __init__(self) -> None:
        self.line = PtyLink()
        self.clock = SystemClock()
        self.drone = SimulatedDrone(now=self.clock.now())
        self.drone.autopilot.flight.start_motors()
        self.drone.autopilot.flight.rise_to(20)
        self.heard: list[tuple[float, Message]] = []
        self.pilots: list[tuple[float, Pilot]] = []
        self.unplugged = False
        self._session = OnboardSession()
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._live, daemon=True)
        self._thread.start()

    def of(self, kind: type[Message]) -> list[tuple[float, Message]]:
        return [each for each in list(self.heard) if isinstance(each[1], kind)]

    def sticks(self) -> list[tuple[float, Sticks]]:
        return [(at, message) for at, message in list(self.heard) if isinstance(message, Sticks)]

    @property
    def flies_forward(self) -> bool:
        return sum(message.pitch == FORWARD for _, message in self.sticks()) > 10

    @property
    def pilot(self) -> Pilot:
        return self.drone.autopilot.pilot

    def close(self) -> None:
        self._over.set()
        self._thread.join()
        self.line.close()

    def _live(self) -> None:
        while not self._over.is_set():
            now = self.clock.now()
            if not self.unplugged:
                data = self.line.receive()
                self.heard += [(now, received.message) for received in self._session.receive(data, now)]
                self.drone.receive(data, now)
                if said := self.drone.advance(now):
                    self.line.send(said)
            if not self.pilots or self.pilots[-1][1] is not self.pilot:
                self.pilots.append((now, self.pilot))
            self._over.wait(LOOK)


@pytest.fixture
def far() -> Iterator[FarDrone]:
    drone = FarDrone()
    yield drone
    drone.close()


def freezes_for(seconds: float) -> Callable[[Popen[str], FarDrone], None]:
    def freeze(process: Popen[str], far: FarDrone) -> None:
        process.send_signal(signal.SIGSTOP)
        time.sleep(seconds)  # this is the fault, not waiting for one
        process.send_signal(signal.SIGCONT)

    return freeze


def sends(number: signal.Signals) -> Callable[[Popen[str], FarDrone], None]:
    return lambda process, far: process.send_signal(number)


@dataclass(frozen=True)
class Row:
    name: str
    breaks: Callable[[Popen[str], FarDrone], None]
    said: str
    code: int
    disables: int = 1


ROWS = [
    Row("SIGINT", sends(signal.SIGINT), "stopped: SIGINT received", 130),
    Row("300 ms stall", freezes_for(0.3), "stopped: the computer stalled for 0.", 1),
    Row("1.5 s stall", freezes_for(1.5), "stopped: the computer stalled for 1.", 1),
    Row("SIGKILL", sends(signal.SIGKILL), "", -signal.SIGKILL, disables=0),
]


@pytest.mark.parametrize("row", ROWS, ids=[row.name for row in ROWS])
def test_a_process_that_is_stopped_leaves_the_drone_with_its_pilot(
    row: Row, far: FarDrone, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with flown(far, tmp_path, monkeypatch) as process:
        wait_until(lambda: far.flies_forward, "flying", patience=30)
        row.breaks(process, far)
        _, said = process.communicate(timeout=20)
    assert process.returncode == row.code, said
    assert row.said in said
    wait_until(lambda: far.pilots[-1][1] is Pilot.RC, "its pilot has it", patience=3)
    time_of_last, last = far.sticks()[-1]
    enables = [at for at, message in far.of(VirtualRc) if getattr(message, "on", False)]
    disables = [at for at, message in far.of(VirtualRc) if not getattr(message, "on", True)]
    assert len(enables) == 1
    assert len(disables) == row.disables
    check_enables(enables, disables)
    back = next(at for at, pilot in reversed(far.pilots) if pilot is Pilot.RC)
    if row.disables:
        assert [message for _, message in far.sticks()[-6:]] == [NEUTRAL] * 6
    else:
        assert last.pitch == FORWARD, "killed with the stick forward,"
        assert back - time_of_last == pytest.approx(VIRTUAL_RC_TIMEOUT, abs=0.05), "it goes back by itself"


def test_a_new_run_flies_only_when_it_is_asked_to(
    far: FarDrone, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After a kill, however soon it comes."""
    for _ in range(2):
        with flown(far, tmp_path, monkeypatch) as process:
            before = len(far.sticks())
            wait_until(lambda before=before: len(far.sticks()) > before + 5, "flying", patience=30)
            process.kill()
            process.communicate()
    enables = [at for at, message in far.of(VirtualRc) if getattr(message, "on", False)]
    assert len(enables) == 2
    assert enables[1] - enables[0] >= 2.0
    assert not far.drone.autopilot.locked


def test_an_adapter_that_is_unplugged_and_back_flies_nothing(
    far: FarDrone, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with flown(far, tmp_path, monkeypatch) as process:
        wait_until(lambda: far.flies_forward, "flying", patience=30)
        far.unplugged = True
        lost, far.line = far.line, PtyLink()
        lost.close()
        far.unplugged = False
        count = len(far.heard)
        _, said = process.communicate(timeout=20)
    assert process.returncode == 1
    assert "the adapter is gone: plug it in, then start again" in said
    assert "the drone goes back to its RC by itself, 1 s after the last sticks that reached it" in said
    wait_until(lambda: far.pilots[-1][1] is Pilot.RC, "its pilot has it", patience=3)
    assert len(far.heard) == count


def flown(far: FarDrone, folder: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("TELEOP_DJI_APP_ID", "1")
    monkeypatch.setenv("XDG_STATE_HOME", str(folder))  # where the last enable is noted for the next run
    (folder / "sticks.csv").write_text(STICKS)
    (folder / "rig.yaml").write_text(
        "name: Far\nlinks: {drone: 'sim:'}\naxes:\n"
        + "".join(f"  {axis}: {{min: -1, max: 1, velocity: 4, acceleration: 20, jerk: 200}}\n" for axis in AXES)
        + "sinks: [{type: virtual-rc, link: drone}]\n"
    )
    arguments = ["live", "--sticks", str(folder / "sticks.csv"), "--rig", str(folder / "rig.yaml"), "--i-understand"]
    return running(*arguments, "--link", f"drone=serial:{far.line.path}@230400")
