"""The signs of the broadcast, found by turning and lifting the drone in the hand; and plausible fields at rest."""

from __future__ import annotations

import math
from collections.abc import Generator
from typing import NamedTuple

from teleop.commission.drone.base import ActivatedStep, check_on_ground, until_or_key, wait
from teleop.commission.drone.bench import DroneBench
from teleop.commission.findings import Fact, Findings, Subject
from teleop.commission.step import Question, Script, Wait
from teleop.core.errors import DeviceError
from teleop.devices.drone.control_mode import attitude

TURNED = 25.0  # deg that count as a turn
OTHERS = 0.7  # of it that another angle may turn by the way
LIFTED = 0.3  # m
PATIENCE = 30.0  # s for the operator to turn it
QUICK = 10.0  # deg/s: a rate that says which way it turns
RISES = 0.05  # m/s
PLANET = 90.0, 180.0  # deg


class Turn(NamedTuple):
    """`place` among roll, pitch, yaw; what the operator does, which the documents count as positive."""

    name: str
    place: int
    does: str


TURNS = (
    Turn("yaw", 2, "Turn its nose to the right, by 45 degrees"),
    Turn("pitch", 1, "Tilt its nose up, by 45 degrees"),
    Turn("roll", 0, "Tilt its right side down, by 45 degrees"),
)
ANGLE = {turn.name: Subject(f"sign.{turn.name}", f"Sign of {turn.name} in the attitude", 1) for turn in TURNS}
RATE = {turn.name: Subject(f"sign.rate.{turn.name}", f"Sign of the rate of {turn.name}", 1) for turn in TURNS}
HEIGHT = Subject("sign.height", "Height grows when it is lifted", True)
CLIMB = Subject("sign.climb", "Sign of the vertical velocity when it is lifted", 1)
NORM = Subject("broadcast.quaternion", "The attitude is a unit quaternion", True)
STILL = Subject("broadcast.still", "Velocity at rest", 0.0, "m/s")
BATTERY = Subject("broadcast.battery", "Battery is a percentage", True)
HEALTH = Subject("broadcast.gps", "Health of the GPS, of 5")
LATITUDE = Subject("broadcast.latitude", "Latitude comes before longitude", True)


class Fields(ActivatedStep):
    """Whether what it broadcasts at rest can be true."""

    key, title = "fields", "The broadcast at rest"
    about = ("Leave the drone where it is: its broadcast is read for 1 s.", "Nothing is sent, nothing moves.")
    subjects = (NORM, STILL, BATTERY, HEALTH, LATITUDE)

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        bench = self.bench
        yield from wait(bench, 1.0, "reading")
        facts: list[Fact] = []
        turned, velocity, battery = bench.get("quaternion"), bench.get("velocity"), bench.get("battery")
        if turned is None:
            facts.append(NORM.not_seen("no attitude came"))
        else:
            norm = math.hypot(turned.q0, turned.q1, turned.q2, turned.q3)
            facts.append(NORM.found(abs(norm - 1) < 0.02, f"its length is {norm:.3f}"))
        if velocity is None or not velocity.valid:
            facts.append(STILL.not_seen("no valid velocity came"))
        else:
            speed = math.hypot(velocity.x, velocity.y, velocity.z)
            facts.append(STILL.found(round(speed, 2), "broadcast", within=0.3))
        known = battery is not None
        facts.append(BATTERY.found(0 <= battery <= 100, f"{battery}") if known else BATTERY.not_seen("no battery came"))
        facts += yield from self._place()
        return facts

    def _place(self) -> Generator[Wait | Question, str, list[Fact]]:
        """Where it is, asked without keeping it: a report says nothing of the place."""
        position = self.bench.get("position")
        if position is None:
            return [HEALTH.not_seen("no position came"), LATITUDE.not_seen("no position came")]
        facts = [HEALTH.found(position.health, "broadcast")]
        if not position.health:
            return [*facts, LATITUDE.not_seen("the GPS has no fix")]
        latitude, longitude = math.degrees(position.latitude), math.degrees(position.longitude)
        if abs(latitude) > PLANET[0]:
            return [*facts, LATITUDE.found(False, "the first number cannot be a latitude")]
        text = f"Is this where you are: latitude {latitude:.2f}, longitude {longitude:.2f} deg?"
        answer = yield Question(text, {"y": "yes", "n": "no, exchanged", "u": "unknown"})
        if answer == "u":
            return [*facts, LATITUDE.not_seen("the operator does not know")]
        return [*facts, LATITUDE.found(answer == "y", "the operator compared the place")]


class Signs(ActivatedStep):
    """Which way it counts: turned about each axis in turn, then lifted, by hand."""

    key, title = "signs", "Signs, by turning it in the hand"
    about = (
        "Take the drone in your hands, its propellers off and its motors off.",
        "Turn it as you are asked: nose right, nose up, right side down. Then lift it.",
        "Nothing is sent, and nothing moves but what you move.",
    )
    subjects = (*ANGLE.values(), *RATE.values(), HEIGHT, CLIMB)

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        check_on_ground(self.bench)
        facts: list[Fact] = []
        for turn in TURNS:
            facts += yield from self._turn(turn)
        return [*facts, *(yield from self._lift())]

    def _turn(self, turn: Turn) -> Generator[Wait | Question, str, list[Fact]]:
        angle, rate = ANGLE[turn.name], RATE[turn.name]
        watch = _Turning(self.bench, turn)
        yield Question(f"Hold it level. After Enter: {turn.does.lower()}.", {"enter": "ready"})
        watch.begin()
        if not (yield from until_or_key(self.bench, watch.turned, f"{turn.does}, quickly, and hold it.", PATIENCE)):
            how = "no such turn was seen"
            return [angle.not_seen(how), rate.not_seen(how)]
        how = f"turned by hand: {watch.way:+.0f} deg"
        found = [angle.found(1 if watch.way > 0 else -1, how)]
        found.append(
            rate.found(watch.rate_sign, f"its fastest rate was {watch.fastest:+.0f} deg/s")
            if watch.rate_sign
            else rate.not_seen("no rate came that says which way")
        )
        return found

    def _lift(self) -> Generator[Wait | Question, str, list[Fact]]:
        bench = self.bench
        watch = _Lifting(bench)
        yield Question("Hold it low and level. After Enter: lift it by half a meter.", {"enter": "ready"})
        watch.begin()
        if not (yield from until_or_key(bench, watch.lifted, "Lift it by half a meter, quickly.", PATIENCE)):
            return [HEIGHT.not_seen("no lift was seen"), CLIMB.not_seen("no lift was seen")]
        found = [HEIGHT.found(watch.way > 0, f"lifted by hand: {watch.way:+.1f} m")]
        found.append(
            CLIMB.found(watch.climb_sign, f"its fastest vertical velocity was {watch.fastest:+.1f} m/s")
            if watch.climb_sign
            else CLIMB.not_seen("no vertical velocity came that says which way")
        )
        return found


class _Turning:
    """Watches one turn: the angles from where it began, and the fastest rate of its axis."""

    def __init__(self, bench: DroneBench, turn: Turn) -> None:
        self._bench, self._index = bench, turn.place
        self._first: tuple[float, float, float] | None = None
        self.way = self.fastest = 0.0  # deg, deg/s

    def begin(self) -> None:
        self._first = self._angles()

    def turned(self) -> bool:
        """Whether it has turned about its axis, and about no other as far."""
        check_on_ground(self._bench)
        rate, angles = self._bench.get("angular_rate"), self._angles()
        if rate is not None:
            now = math.degrees((rate.x, rate.y, rate.z)[self._index])
            self.fastest = now if abs(now) > abs(self.fastest) else self.fastest
        if angles is None:
            raise DeviceError("the drone broadcasts no attitude")
        if self._first is None:
            self._first = angles
        ways = [math.remainder(now - first, 360) for now, first in zip(angles, self._first, strict=True)]
        self.way = ways.pop(self._index)
        return abs(self.way) >= TURNED and all(abs(other) <= OTHERS * abs(self.way) for other in ways)

    @property
    def rate_sign(self) -> int:
        return 0 if abs(self.fastest) < QUICK else 1 if self.fastest > 0 else -1

    def _angles(self) -> tuple[float, float, float] | None:
        quaternion = self._bench.get("quaternion")
        return None if quaternion is None else attitude(quaternion)


class _Lifting:
    """Watches a lift: the height from where it began, and the fastest vertical velocity."""

    def __init__(self, bench: DroneBench) -> None:
        self._bench = bench
        self._first: float | None = None
        self.way = self.fastest = 0.0  # m, m/s

    def begin(self) -> None:
        self._first = self._height()

    def lifted(self) -> bool:
        check_on_ground(self._bench)
        velocity, height = self._bench.get("velocity"), self._height()
        if velocity is not None and velocity.valid and abs(velocity.z) > abs(self.fastest):
            self.fastest = velocity.z
        if height is None:
            raise DeviceError("the drone broadcasts no position")
        if self._first is None:
            self._first = height
        self.way = height - self._first
        return abs(self.way) >= LIFTED

    @property
    def climb_sign(self) -> int:
        return 0 if abs(self.fastest) < RISES else 1 if self.fastest > 0 else -1

    def _height(self) -> float | None:
        position = self._bench.get("position")
        return None if position is None else position.height
