"""A simulated drone with an operator's inputs, on virtual time, and a monitor of everything that is sent to it.

The rig is real from its profile to the frames; between it and the drone lies a cable that a test can unplug, cut in
either direction, or let damage what passes. The monitor knows nothing of the program: it sees frames with their
times, and what the operator's hands held at each of them.
"""

from __future__ import annotations

import bisect
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from itertools import pairwise
from pathlib import Path
from typing import TypeVar

from gimbal_fault_bench import SteppingClock
from hands import FakeInput

from teleop.config.presets import Presets
from teleop.config.profile import load_profile
from teleop.core.axes import STICKS, Axis
from teleop.core.control_loop import ControlLoop
from teleop.core.errors import LinkError
from teleop.core.events import DeviceCommand
from teleop.core.interfaces import Link
from teleop.core.operator_input import Command
from teleop.core.run_state import RunStateMachine
from teleop.devices.drone.sink import DroneSink
from teleop.devices.rig import Rig, open_rig
from teleop.dji.drone.movement import Move
from teleop.dji.drone.session import OnboardSession
from teleop.dji.drone.virtual_rc import NEUTRAL, Sticks, VirtualRc
from teleop.dji.message import Message
from teleop.manual.operator import Operator
from teleop.sim.drone.controls import Pilot
from teleop.sim.drone.device import SimulatedDrone

AXES = "\n".join(f"  {axis}: {{min: -1, max: 1, velocity: 4, acceleration: 20, jerk: 200}}" for axis in STICKS)
PAN = "  pan: {min: null, max: null, velocity: 60, acceleration: 240, jerk: 2400}"
GIMBAL = "{type: gimbal, link: gimbal, mode: position, rate: 50}"
VIRTUAL_RC = "{type: virtual-rc, link: drone}"
FLIGHT = "{type: flight, link: drone, mode: velocity-body, full_scale: {horizontal: 5, vertical: 2, yaw: 60}}"
PROFILE = f"name: Sky\nlinks: {{drone: 'sim:'}}\naxes:\n{AXES}\nsinks: [SINK]\n"
STALE = 0.2  # s: what an operator held longer ago than this may not be on the wire
READY = 2.5  # s after the start, by which a drone can be engaged
Kind = TypeVar("Kind", bound=Message)


class Cable:
    """A link to the drone; `wire` is every frame that left, with its time, as the drone's end understands it."""

    def __init__(self, link: Link, now: Callable[[], float]) -> None:
        self._link, self._now = link, now
        self.unplugged = self.deaf = self.mute = False
        self.late = 0.0  # s by which everything that comes from the drone is delayed
        self._delayed: list[tuple[float, bytes]] = []
        self.damage: Callable[[bytes], bytes] = lambda data: data
        self.wire: list[tuple[float, Message]] = []
        self._session = OnboardSession()

    def send(self, data: bytes) -> None:
        self._check()
        self.wire += [(self._now(), received.message) for received in self._session.receive(data, self._now())]
        if not self.deaf:
            self._link.send(self.damage(data))

    def receive(self) -> bytes:
        self._check()
        data = self._link.receive()
        if not self.mute and data:
            self._delayed.append((self._now() + self.late, data))
        arrived = [data for time, data in self._delayed if time <= self._now() + 1e-9]
        del self._delayed[: len(arrived)]
        return b"".join(arrived)

    def _check(self) -> None:
        if self.unplugged:
            raise LinkError("serial:/dev/ttyUSB0@230400: the adapter is gone: plug it in, then start again")


class DroneFaultBench:
    """`said` is what the operator was told, `keys` and `pad` are what is in the operator's hands."""

    def __init__(self, clock: SteppingClock) -> None:
        self.clock = clock
        self.begin = clock.now()
        self.pad, self.keys = FakeInput("pad"), FakeInput("keys")
        self.said: list[str] = []
        self.times: list[tuple[float, str]] = []  # the same, with s after the start
        self.held: list[tuple[float, Mapping[Axis, float]]] = []  # what hands that are there held, by time
        self.pilots: list[tuple[float, Pilot]] = []
        self.ended: RunStateMachine
        self.rig: Rig
        self.drone: SimulatedDrone
        self.cable: Cable
        self.operator: Operator
        self.sink: DroneSink
        self.loop: ControlLoop
        self._script: list[tuple[float, Callable[[], object]]] = []
        clock.hook = self._pass

    def at(self, seconds: float, act: Callable[[], object]) -> None:
        """Have something done so many seconds after the start."""
        self._script.append((self.begin + seconds, act))
        self._script.sort(key=lambda each: each[0])

    def engage_at(self, seconds: float) -> None:
        self.at(seconds, lambda: self.keys.press(Command.ENGAGE))

    def tell_at(self, seconds: float, word: str) -> None:
        self.at(seconds, lambda: self.keys.press(Command.TELL, device_command=DeviceCommand("drone", word)))

    def hold_at(self, seconds: float, **deflections: float) -> None:
        held = {axis.value: 0.0 for axis in STICKS} | deflections
        self.at(seconds, lambda: self.pad.hold(**held))

    def quit_at(self, seconds: float) -> None:
        self.at(seconds, lambda: self.keys.press(Command.QUIT))

    def airborne(self, height: float = 30.0) -> None:
        """The drone hovers already, flown up by its pilot."""
        self.drone.autopilot.flight.hover(height)

    def of(self, kind: type[Kind]) -> list[tuple[float, Kind]]:
        """What was sent of a kind, by seconds after the start."""
        return [(time - self.begin, message) for time, message in self.cable.wire if isinstance(message, kind)]

    @property
    def enables(self) -> list[float]:
        return [time for time, message in self.of(VirtualRc) if message.on]

    @property
    def disables(self) -> list[float]:
        return [time for time, message in self.of(VirtualRc) if not message.on]

    def pilot(self, seconds: float) -> Pilot:
        """Who flew, so many seconds after the start."""
        return [pilot for time, pilot in self.pilots if time - self.begin <= seconds][-1]

    def hear(self, text: str) -> None:
        """What the drone has said to the operator."""
        self.said.append(text)
        self.times.append((self.clock.now() - self.begin, text))
        self.operator.notify(text)

    def _pass(self, now: float) -> None:
        while self._script and self._script[0][0] <= now + 1e-9:
            self._script.pop(0)[1]()
        if not self.pad.trouble:
            self.held.append((now, dict(self.pad.deflections)))
        self.drone.receive(b"", now)  # it lives, whether anybody looks or not
        if not self.pilots or self.pilots[-1][1] is not self.drone.autopilot.pilot:
            self.pilots.append((now, self.drone.autopilot.pilot))

    def check(self) -> None:
        """What holds whatever happens, by what was sent alone."""
        check_enables(self.enables, self.disables)
        sticks = self.of(Sticks)
        times = [time for time, _ in sticks]
        for earlier, later in zip(times, times[24:], strict=False):
            assert later - earlier >= 0.95, "never more than 25 in a second"
        for earlier, later in pairwise(times):
            assert later - earlier >= 0.04 - 1e-6
        for time, message in sticks:
            assert message == NEUTRAL or self._fresh(time), f"stale sticks at {time:.3f} s: {message}"
        for time, move in self.of(Move):
            still = (move.x, move.y, move.z, move.yaw) == (0, 0, 0, 0)
            assert still or self._fresh(time), f"stale movement at {time:.3f} s: {move}"
        assert not self.drone.autopilot.locked

    def _fresh(self, seconds: float) -> bool:
        """Whether a hand was there, so many seconds after the start, or just before."""
        index = bisect.bisect_right(self.held, seconds + self.begin + 1e-9, key=lambda each: each[0])
        return index > 0 and seconds + self.begin - self.held[index - 1][0] <= STALE

    def run(self, after: float = 2.0) -> None:
        """The whole run, and some time after it."""
        self.ended = self.loop.run()
        self.clock.sleep_until(self.clock.now() + after)
        self.check()


def check_enables(enables: list[float], disables: list[float]) -> None:
    """At most one disable for each enable, and no two enables within two seconds."""
    for earlier, later in pairwise(enables):
        assert later - earlier >= 2.0 - 1e-6, f"enabled at {earlier:.3f} s and {later:.3f} s"
        assert sum(earlier <= time < later for time in disables) == 1, "given back before it is taken again"
    if enables:
        assert sum(time >= enables[-1] for time in disables) <= 1


@contextmanager
def drone_fault_bench(folder: Path, sink: str = VIRTUAL_RC, gimbal: bool = False) -> Iterator[DroneFaultBench]:
    """A drone flown by this kind of sink, with a `gimbal` beside it whose pan is moved too."""
    text = PROFILE.replace("SINK", sink)
    if gimbal:
        text = text.replace("'sim:'}", "'sim:', gimbal: 'sim:'}").replace("axes:\n", f"axes:\n{PAN}\n")
        text = text.replace("sinks: [", f"sinks: [{GIMBAL}, ")
    (folder / "bench.yaml").write_text(text)
    profile = load_profile(str(folder / "bench.yaml"))
    clock = SteppingClock()
    made = DroneFaultBench(clock)
    made.hold_at(0.0)
    with ExitStack() as stack:
        presets = Presets(folder / "presets.yaml")
        stack.callback(presets.close)
        rig = stack.enter_context(open_rig(profile, clock))
        made.rig = rig
        made.drone = rig.simulated_drones["drone"]
        connection = rig.connections["drone"]
        made.cable = connection._link = Cable(connection._link, clock.now)  # the far end of everything that is sent
        made.operator = Operator(profile.limits, [made.pad, made.keys], presets, profile.sticks, 2.0)
        flown = rig.drone(list(STICKS))
        assert flown is not None
        made.sink = flown
        flown.notify = made.hear
        made.loop = rig.loop(list(profile.limits), [made.operator])
        yield made
