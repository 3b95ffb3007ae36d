"""A rig in an operator's hand as `teleop live` builds it, on any clock, with every time that matters written down."""

from __future__ import annotations

import resource
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from time import monotonic, process_time, sleep

from fake_hid import FakeBackend, FakeDevice, real

from teleop.config.presets import Presets
from teleop.config.profile import load_profile
from teleop.core.axes import Axis
from teleop.core.clock import SystemClock, VirtualClock
from teleop.core.control_loop import ControlLoop
from teleop.core.events import Tick
from teleop.core.timing import PERIOD
from teleop.devices.rig import open_rig
from teleop.inputs.hid.device import open_inputs
from teleop.manual.operator import Operator

F310 = bytes.fromhex(real("Logitech F310")["descriptor"])
REST = bytes.fromhex("7f7f7f7f08000000")
RIGHT, TREMBLING = bytes.fromhex("ff7f7f7f08000000"), bytes.fromhex("fe7f7f7f08000000")
LEFT = bytes.fromhex("007f7f7f08000000")
PROFILE = """
name: Bench
links: {gimbal: "sim:"}
axes:
  pan:  {min: null, max: null, velocity: 60, acceleration: 240, jerk: 2400}
  tilt: {min: -50, max: 90, velocity: 60, acceleration: 240, jerk: 2400}
sinks: [{type: gimbal, link: gimbal, mode: speed, rate: 50, delay: 0.05}]
sticks: {start_range: 3, ramp: 0.1, low_pass: 0}
"""


class WorkingClock:
    """A clock that notes how long the loop works between two sleeps, and how late it wakes, in s.

    `own` is what this process computed meanwhile, in all its threads: what is left of `work` the machine did elsewhere.
    """

    def __init__(self, clock: SystemClock | VirtualClock) -> None:
        self.work: list[float] = []
        self.own: list[float] = []
        self.late: list[float] = []
        self._clock = clock
        self._woke = self._computed = 0.0

    def forget(self) -> None:
        """Start afresh; the work until now is not the loop's."""
        for noted in (self.work, self.own, self.late):
            noted.clear()
        self._woke = 0.0

    def now(self) -> float:
        return self._clock.now()

    def sleep_until(self, time: float) -> None:
        if self._woke:
            self.work.append(monotonic() - self._woke)
            self.own.append(process_time() - self._computed)
        self._clock.sleep_until(time)
        self._woke, self._computed = monotonic(), process_time()
        self.late.append(self._clock.now() - time)


class Watch:
    """`sent` has, for each tick in which a speed went out: the tick's time, when it went, and whether it moves pan."""

    def __init__(self) -> None:
        self.sent: list[tuple[float, float, bool]] = []
        self.ticks = self.skipped = 0
        self.each_tick: Callable[[Tick], object] = lambda _tick: None
        self._before = 0.0
        self._went = (0.0, False)

    def tap(self, send: Callable[[bytes], None]) -> Callable[[bytes], None]:
        """A link's `send` that is looked at: a speed command has 0x0E 0x01 after its 12 bytes of head, then the yaw."""

        def tapped(data: bytes) -> None:
            if data[12:14] == b"\x0e\x01":
                self._went = monotonic(), data[14:16] != b"\0\0"
            send(data)

        return tapped

    def observe(self, tick: Tick) -> None:
        if self._went[0]:
            self.sent.append((tick.time, *self._went))
            self._went = 0.0, False
        self.ticks += 1
        if self._before:
            self.skipped += round((tick.time - self._before) / PERIOD) - 1
        self._before = tick.time
        self.each_tick(tick)


class Bench:
    def __init__(self, loop: ControlLoop, pad: FakeDevice, watch: Watch, clock: WorkingClock) -> None:
        self.loop, self.pad, self.watch, self.clock = loop, pad, watch, clock


@contextmanager
def bench(
    folder: Path, clock: SystemClock | VirtualClock, device: Callable[[bytes], FakeDevice] = FakeDevice
) -> Iterator[Bench]:
    (folder / "rig.yaml").write_text(PROFILE)
    profile = load_profile(str(folder / "rig.yaml"))
    backend, pad, watch, working = FakeBackend(), device(F310), Watch(), WorkingClock(clock)
    backend.plug(pad)
    with ExitStack() as stack:
        inputs = stack.enter_context(open_inputs([], clock.now, backend))
        presets = Presets(folder / "presets.yaml")
        stack.callback(presets.close)
        operator = Operator(profile.limits, inputs, presets, profile.sticks, 2.0)
        rig = stack.enter_context(open_rig(profile, working))
        link = rig.connections["gimbal"]._link
        link.send = watch.tap(link.send)  # type: ignore[method-assign]
        yield Bench(rig.loop([Axis.PAN, Axis.TILT], [operator], [watch]), pad, watch, working)


class Hand(threading.Thread):
    """Reports 100 times a second what `holds` says for a time (s since its start), in real time."""

    def __init__(self, pad: FakeDevice, holds: Callable[[float], bytes]) -> None:
        super().__init__(daemon=True)
        self._pad, self._holds, self._over = pad, holds, threading.Event()

    def run(self) -> None:
        begin = monotonic()
        while not self._over.is_set():
            self._pad.report(self._holds(monotonic() - begin))
            sleep(PERIOD)

    def stop(self) -> None:
        self._over.set()
        self.join()


def rss() -> float:
    """Megabytes of this process now."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 1e6


def percentile(values: list[float], share: float) -> float:
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]
