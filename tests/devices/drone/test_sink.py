"""A drone in an operator's hands: what is sent in which tick, and what ends it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, cast

import pytest
from fake_drone_link import FakeTelemetry

from teleop.core.axes import STICKS, State
from teleop.core.errors import DeviceError, LinkError
from teleop.core.events import DeviceCommand, Tick
from teleop.core.setpoints import Stop, VelocityTarget
from teleop.devices.drone.control_mode import ControlMode
from teleop.devices.drone.sink import DroneSink
from teleop.dji.drone.broadcast_parts import Rc
from teleop.dji.drone.enums import FlightStatus, RcGear, RcMode

ROLL = STICKS[0]
CENTERED = dict.fromkeys(STICKS, 0.0)


class FakeMode:
    """A way to hold a drone that confirms at once; `sent` is what it was asked to send, in order."""

    what, period, alone = "control", 0.02, "nobody flies it"
    gap, taken, repeats, patience = 0.0, float("-inf"), False, 1.0

    def __init__(self) -> None:
        self.sent: list[Any] = []
        self.on = False
        self.refused: list[str] = []
        self.fault: Exception | None = None
        self.notify: Any = None

    def refusals(self, _seen: Any, _now: float) -> Iterator[str]:
        yield from self.refused

    def warnings(self, _seen: Any, _now: float) -> Iterator[str]:
        yield from ()

    def take(self, _seen: Any, _now: float) -> None:
        self.sent.append("take")
        self.on = True

    def watch(self, _seen: Any, _now: float) -> None: ...

    def drive(self, sticks: Any, _seen: Any, _now: float) -> None:
        if self.fault:
            raise self.fault
        self.sent.append(dict(sticks))

    def neutral(self, _seen: Any, _now: float) -> None:
        self.sent.append("neutral")

    def withdraw(self) -> None: ...

    def give_back(self, _now: float) -> None:
        self.sent.append("give back")
        self.on = False

    def give_back_again(self, _now: float) -> None: ...

    def contradicted(self, _seen: Any, _now: float) -> bool:
        return False

    def held(self, _seen: Any, _now: float) -> bool:
        return self.on

    def tell(self, word: str, _seen: Any, _now: float) -> str:
        return {"arm": "arm: asked for"}[word]


class Bench:
    """A drone that is ready; `hands` is which sticks somebody holds, `motion` where the planner has them."""

    def __init__(self, by_script: bool = False) -> None:
        self.mode = FakeMode()
        self.seen = FakeTelemetry(
            status=FlightStatus.STANDBY, battery=80, rc=Rc(0, 0, 0, 0, RcMode.F, RcGear.DOWN), control=None
        )
        self.sink = DroneSink(cast(ControlMode, self.mode), self.seen.real, 0.0, 20)
        self.sink.by_script = by_script
        self.messages: list[str] = []
        self.sink.notify = self.messages.append
        self.now = 0.0
        self.hands: dict[Any, Any] = dict.fromkeys(STICKS, VelocityTarget(0.0))
        self.motion = dict(CENTERED)

    def tick(self, *commands: str, count: int = 1) -> None:
        for _ in range(count):
            self.now = round(self.now + 0.01, 6)
            self.seen.since = self.now
            motion = {axis: State(position, 0.0, 0.0) for axis, position in self.motion.items()}
            actions = [DeviceCommand("drone", command) for command in commands]
            self.sink.write(Tick(self.now, motion, self.hands, actions, {}))

    def engaged(self) -> Bench:
        self.tick("engage")
        self.tick(count=20)
        assert self.sink.engaged
        self.mode.sent.clear()
        return self


def test_nothing_is_sent_before_an_operator_engages_it() -> None:
    bench = Bench()
    bench.motion[ROLL] = 0.5
    bench.tick("arm", count=100)
    assert bench.mode.sent == []
    assert set(bench.messages) == {"drone: arm refused: it is not engaged"}


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda bench: bench.hands.clear(), "no input holds its sticks"),
        (lambda bench: bench.motion.update({ROLL: 0.03}), "center its sticks"),
        (lambda bench: bench.seen.parts.update(battery=20), "the battery is at 20 %"),
        (lambda bench: bench.seen.parts.update(rc=Rc(0, 0, 0, 0, RcMode.P, RcGear.DOWN)), "it must be in F"),
        (lambda bench: bench.mode.refused.append("of its own"), "of its own"),
    ],
)
def test_it_is_not_engaged_unless_everything_is_ready(change: Any, reason: str) -> None:
    bench = Bench()
    change(bench)
    bench.tick("engage")
    assert bench.mode.sent == []
    assert len(bench.messages) == 1
    assert bench.messages[0].startswith("drone: not engaged: ")
    assert reason in bench.messages[0]


def test_a_stick_counts_only_while_somebody_asks_for_it() -> None:
    bench = Bench().engaged()
    bench.motion |= {ROLL: 0.5, STICKS[1]: 0.5}
    del bench.hands[ROLL]
    bench.tick(count=10)
    assert bench.mode.sent[-1] == CENTERED | {STICKS[1]: 0.5}


@pytest.mark.parametrize("trouble", ["hands", "stop", "disengage", "battery", "control lost"])
def test_whatever_ends_it_ends_in_neutral_and_one_giving_back(trouble: str) -> None:
    bench = Bench().engaged()
    if trouble == "hands":
        bench.hands.clear()
    elif trouble == "stop":
        bench.hands[ROLL] = Stop()
    elif trouble == "battery":
        bench.seen.parts["battery"] = 5
    elif trouble == "control lost":
        bench.seen.control_lost += 1
    bench.tick(*(["disengage"] if trouble == "disengage" else []))
    bench.tick(count=300)
    assert not bench.sink.engaged
    assert bench.mode.sent.count("give back") == 1
    assert bench.mode.sent[-2:] == ["neutral", "give back"]


def test_without_ticks_its_sticks_are_neutral_after_a_fifth_of_a_second() -> None:
    bench = Bench().engaged()
    bench.motion[ROLL] = 0.5
    bench.tick(count=10)
    bench.mode.sent.clear()
    for _ in range(30):
        bench.now = round(bench.now + 0.01, 6)
        bench.seen.since = bench.now
        bench.sink.report(bench.now)
    assert bench.mode.sent
    assert set(bench.mode.sent) == {"neutral"}


def test_a_script_that_cannot_engage_ends_the_run() -> None:
    bench = Bench(by_script=True)
    bench.motion[ROLL] = 0.5
    with pytest.raises(DeviceError, match="drone: not engaged: center its sticks"):
        bench.tick()


def test_what_ends_a_scripts_engagement_ends_the_run() -> None:
    bench = Bench(by_script=True)
    bench.tick(count=20)
    assert bench.sink.engaged
    bench.seen.parts["battery"] = 5
    with pytest.raises(DeviceError, match="the battery is at 5 %"):
        bench.tick(count=100)


def test_a_lost_link_says_what_becomes_of_a_drone_that_is_held() -> None:
    bench = Bench().engaged()
    bench.mode.fault = LinkError("unplugged")
    with pytest.raises(LinkError, match="unplugged; nothing more reaches the drone: nobody flies it"):
        bench.tick(count=10)


def test_leaving_gives_it_back_and_where_nothing_was_taken_sends_nothing() -> None:
    idle = Bench()
    idle.tick()
    assert idle.sink.release(idle.now) is None
    assert idle.mode.sent == []
    bench = Bench().engaged()
    while (again := bench.sink.release(bench.now)) is not None:
        assert again < 10.0
        bench.now = again
        bench.seen.since = again
    assert bench.mode.sent[-2:] == ["neutral", "give back"]


def test_an_unknown_command_is_told() -> None:
    bench = Bench().engaged()
    bench.tick("dance")
    bench.tick("arm")
    assert bench.messages[-2:] == ["drone: unknown command dance", "drone: arm: asked for"]
