"""A bus that passes less than the rig sends: what arrives is never old, nothing is cut, and the link is reported."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import can.interfaces
import pytest
from faulty_bus import FaultyBus, register

from teleop.config.profile import load_profile
from teleop.core.axes import Axis
from teleop.core.clock import VirtualClock
from teleop.core.events import Action
from teleop.core.run_state import Result
from teleop.core.setpoints import PositionTarget, VelocityTarget
from teleop.devices.link_notes import LinkNotes
from teleop.devices.rig import open_rig
from teleop.dji.frame import Frame, FrameReader
from teleop.dji.gimbal import camera, focus
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.gimbal.session import Session
from teleop.links import open_link
from teleop.sim.gimbal.device import SimulatedGimbal

QUEUE = 10  # CAN frames, Linux's txqueuelen
PROFILE = """
name: Slow
links: {{gimbal: "faulty:demo"}}
axes:
  pan: {{min: -180, max: 180, velocity: 20, acceleration: 60, jerk: 600}}
  focus: {{min: 0, max: 1, velocity: 0.2, acceleration: 1, jerk: 10}}
sinks:
  - {{type: gimbal, link: gimbal, mode: {mode}, rate: 50}}
  - {{type: focus, link: gimbal, rate: 50}}
  - {{type: camera, link: gimbal}}
"""


class HookedClock(VirtualClock):
    """Calls `hook` whenever time has passed."""

    def __init__(self) -> None:
        super().__init__()
        self.hook: Callable[[float], None] = lambda _now: None

    def sleep_until(self, time: float) -> None:
        super().sleep_until(time)
        self.hook(self.now())


class Moving:
    """Pan and focus move for `seconds`, the camera records at 2 s; then all comes to rest."""

    def __init__(self, seconds: float) -> None:
        self._seconds, self._end, self._recorded = seconds, math.inf, False

    def start(self, now: float, motion) -> None:
        self._end = now + self._seconds

    def read(self, now: float, _feedback: object):
        acts = []
        if not self._recorded and now > self._end - self._seconds + 2:
            self._recorded, acts = True, [Action.RECORD]
        if now >= self._end:
            return {Axis.PAN: VelocityTarget(0.0), Axis.FOCUS: VelocityTarget(0.0)}, acts
        there = math.sin(now)
        return {
            Axis.PAN: VelocityTarget(18.0 * math.copysign(1, there)),
            Axis.FOCUS: PositionTarget(0.5 + 0.4 * there),
        }, acts

    def next_change(self, now: float) -> float:
        return now if now < self._end + 1 else math.inf


@dataclass
class Heard:
    """What the gimbal heard: messages, how old each was, and what the links counted."""

    result: Result = Result.FAILED
    reasons: list[str] = field(default_factory=list)
    messages: list = field(default_factory=list)
    ages: dict[type, list[float]] = field(default_factory=dict)
    damage: int = 0
    frames: int = 0  # CAN frames
    counts: dict[str, int] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    gimbal: SimulatedGimbal = field(default_factory=SimulatedGimbal)


Runs = Callable[[str, float], Heard]


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Runs:
    """What was heard in a mode over a bus that passes a share of what the rig sends; each is run once, on virtual time.

    The tests look at the same runs from several sides, and change nothing in them.
    """
    known: dict[tuple[str, float], Heard] = {}

    def heard(mode: str, share: float) -> Heard:
        per_second = math.inf if math.isinf(share) else share * heard(mode, math.inf).frames / 11
        if (mode, share) not in known:
            with pytest.MonkeyPatch.context() as patch:
                known[mode, share] = run(mode, per_second, tmp_path_factory.mktemp("rig"), patch)
        return known[mode, share]

    return heard


def run(mode: str, per_second: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, seconds: float = 10.0) -> Heard:
    """A run over a bus that passes so many CAN frames a second."""
    register(monkeypatch)
    monkeypatch.setattr(can.interfaces, "VALID_INTERFACES", can.interfaces.VALID_INTERFACES | {"faulty"})
    (tmp_path / "rig.yaml").write_text(PROFILE.format(mode=mode))
    clock, heard, reader = HookedClock(), Heard(), FrameReader()
    far = open_link("virtual:demo", host=False, now=clock.now)
    sent: dict[int, float] = {}
    with open_rig(load_profile(str(tmp_path / "rig.yaml")), clock) as rig:
        connection, bus = rig.connections["gimbal"], FaultyBus.opened[-1]
        session = connection.session
        assert isinstance(session, Session)
        numbered = session._send

        def note(message):
            frame, sequence = numbered(message)
            sent[sequence] = clock.now()
            return frame, sequence

        monkeypatch.setattr(session, "_send", note)
        bus.room, credit, before = QUEUE, 0.0, clock.now()

        def pass_bytes(now: float) -> None:
            nonlocal credit, before
            credit = min(credit + (now - before) * per_second, QUEUE)
            before = now
            heard.frames += QUEUE - bus.room if math.isinf(per_second) else 0
            passed = QUEUE - bus.room if math.isinf(per_second) else int(credit)
            credit -= 0 if math.isinf(per_second) else passed
            bus.room = min(bus.room + passed, QUEUE)
            data = far.receive()
            heard.gimbal.receive(data, now)
            for found in reader.feed(data, now):
                if not isinstance(found, Frame):
                    heard.damage += 1
                    continue
                message = R_SDK.decode(found, b"").message
                heard.messages.append(message)
                heard.ages.setdefault(type(message), []).append(now - sent[found.sequence])
            if answer := heard.gimbal.advance(now):
                far.send(answer)

        clock.hook = pass_bytes
        notes = LinkNotes([connection], heard.notes.append)
        ended = rig.loop([Axis.PAN, Axis.FOCUS], [Moving(seconds)], [notes]).run()
        pass_bytes(clock.now())
        heard.counts = dict(connection.counts)
    far.close()
    heard.result, heard.reasons = ended.result, list(ended.reasons)
    return heard


@pytest.fixture(params=["position", "speed", "stick"])
def mode(request: pytest.FixtureRequest) -> str:
    return request.param


STREAMS = {"position": gimbal.Position, "speed": gimbal.Speed, "stick": gimbal.Joystick}


@pytest.mark.parametrize("share", [0.85, 0.6])
def test_commands_over_a_slow_bus_are_rarer_and_never_old(mode: str, share: float, runs: Runs) -> None:
    free = runs(mode, math.inf)
    assert (free.result, free.notes) == (Result.DONE, [])
    slow = runs(mode, share)
    assert (slow.result, slow.reasons) == (Result.DONE, [])
    assert slow.damage == 0
    assert slow.counts["superseded"] > 20
    assert slow.counts["lost_replies"] == 0  # what never left is not waited for
    for kind in (STREAMS[mode], focus.Set):
        assert max(slow.ages[kind]) < 0.1, kind
    assert slow.notes == [
        "link gimbal cannot keep up: faulty:demo takes less than is sent, and older commands are skipped; set a lower"
        " rate: in the profile's sinks, or use a faster adapter"
    ]
    assert slow.counts["cannot_keep_up"] == 1


def test_orders_and_the_last_word_of_each_stream_arrive(mode: str, runs: Runs) -> None:
    slow = runs(mode, 0.6)
    orders = [each for each in slow.messages if isinstance(each, camera.Command)]
    assert [order.command for order in orders] == [camera.CameraCommand.RECORD, camera.CameraCommand.STOP]
    last = {type(each): each for each in slow.messages}
    assert not slow.gimbal.controlled
    if mode == "stick":
        assert last[gimbal.Joystick] == gimbal.Joystick(pitch=0, roll=0, yaw=0)
    if mode == "speed":
        assert last[gimbal.Speed] == gimbal.Speed(0.0, 0.0, 0.0, take_over=False, ignore_focal_length=True)
        kinds = [type(each) for each in slow.messages if isinstance(each, gimbal.Speed | gimbal.Position)]
        assert kinds[-1] in (gimbal.Speed, gimbal.Position)
        assert gimbal.Position not in kinds[:-1]


def test_a_hiccup_is_not_a_link_that_cannot_keep_up(runs: Runs) -> None:
    assert runs("position", 1.2).notes == []
