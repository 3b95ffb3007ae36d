"""A commissioning of a drone on the virtual clock, its operator who turns it, and every frame that is sent."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from teleop.commission.drone.bench import DroneBench
from teleop.commission.drone.link import DroneLink
from teleop.commission.drone.session_steps import WORD
from teleop.commission.drone.steps import drone_steps
from teleop.commission.findings import Findings
from teleop.commission.page import GO, RUBOUT, SKIP, Page, Stage
from teleop.commission.runner import Runner
from teleop.config.profile import load_profile
from teleop.core.clock import VirtualClock
from teleop.core.interfaces import Link
from teleop.dji.drone.messages import Activate
from teleop.dji.frame import Frame, FrameReader
from teleop.sim.drone.controls import Switch
from teleop.sim.drone.device import SimulatedDrone
from teleop.sim.drone.settings import DroneSettings

LONGEST = 400.0  # s
SWITCHES = {"to A": Switch.A, "to P": Switch.P, "to F": Switch.F}
TURNS = {
    "nose to the right": {"yaw": 45.0},
    "nose up": {"pitch": 45.0},
    "right side down": {"roll": 45.0},
    "Lift it": {"up": 0.5},
}


@dataclass
class DroneOperator:
    """Does what the page asks for: types, turns the drone and its switch, lays it down again."""

    drone: SimulatedDrone
    words: str = WORD
    skips: Callable[[Page], bool] = lambda _page: False
    hands: bool = True  # whether it is turned when that is asked for
    troubles: list[str] = field(default_factory=list)
    was: str = ""
    asked: float = 0.0
    done: bool = False

    def keys(self, page: Page, now: float) -> list[str]:
        seen = f"{page.key} {page.stage} {page.question}"
        if page.stage is Stage.ASKING and page.question and seen.split(" ", 2)[2] != self.was:
            self.was, self.asked, self.done = page.question, now, False
            if "After Enter" in page.question:
                self.drone.carry(now, 0.2)
            return []
        if now - self.asked < 0.3:
            return []
        match page.stage:
            case Stage.PROMPT:
                self.asked = now
                return [SKIP if self.skips(page) else GO]
            case Stage.SHOWN:
                self.asked, self.was = now, ""
                if page.trouble:
                    self.troubles.append(f"{page.key}: {page.trouble}")
                    return [SKIP]
                return [GO]
            case Stage.ASKING if not self.done:
                self.done = True
                return self._answer(page, now)
        return []

    def _answer(self, page: Page, now: float) -> list[str]:
        question = page.question
        if page.typed is not None:
            self.was = ""
            return ["x", RUBOUT, *self.words, GO]
        if "Turn the RC" in question:
            place = next(words for words in SWITCHES if words in question)
            self.drone.turn_switch(now, SWITCHES[place])
            return [GO]
        if "After Enter" in question:
            return [GO]
        if "where you are" in question:
            return ["y"]
        ways = next(ways for words, ways in TURNS.items() if words in question)
        if not self.hands:
            return ["n"]
        self.drone.carry(now, 0.8, **ways)
        return []


class DroneCommissionBench:
    """`settings` are those of the SimulatedDrone, `tick` is s between two turns.

    `sent` are all frames that went to it, with their times.
    """

    def __init__(
        self, settings: DroneSettings | None = None, switch: Switch = Switch.P, tick: float = 0.01, **options: Any
    ) -> None:
        self._tick = tick
        self.clock = VirtualClock(100.0)
        self.drone = SimulatedDrone(now=100.0, settings=settings or DroneSettings(), **options)
        self.drone.turn_switch(100.0, switch)
        self.link = DroneLink(load_profile("sim-drone"), self.clock, self.drone)
        self.sent: list[tuple[float, Frame]] = []
        self._reader = FrameReader()
        self.link.tap = self._tapped
        self.bench = DroneBench(self.link.open, Activate(0))
        self.runner = Runner(self.bench, drone_steps(self.bench), Findings("drone", device="drone"))
        self.operator = DroneOperator(self.drone)
        self.watch: Callable[[DroneCommissionBench], object] = lambda _bench: None
        self.longest = ""  # line of a page
        self.motors = False  # whether they ever ran

    def turn(self, *keys: str) -> None:
        self.runner.turn(self.clock.now(), keys)
        self.clock.sleep_until(self.clock.now() + self._tick)
        self.motors |= self.drone.autopilot.flight.motors
        self.watch(self)
        page = self.runner.page
        self.longest = max([self.longest, page.trouble, page.consent, page.question, *page.lines], key=len)

    def run(self) -> Findings:
        end = self.clock.now() + LONGEST
        while not self.runner.over:
            assert self.clock.now() < end, self.runner.page
            self.turn(*self.operator.keys(self.runner.page, self.clock.now()))
        return self.runner.findings

    def _tapped(self, link: Link) -> Link:
        bench, clock = self, self.clock

        class Tapped:
            def send(self, data: bytes) -> None:
                found = bench._reader.feed(data, clock.now())
                bench.sent += [(clock.now(), frame) for frame in found if isinstance(frame, Frame)]
                link.send(data)

            def receive(self) -> bytes:
                return link.receive()

        return Tapped()
