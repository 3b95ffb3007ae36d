"""A controller on a rig with a door: what it moves, what it is sent, and what becomes of it when its port goes."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Awaitable, Callable, Sequence
from pathlib import Path
from typing import Any

import mido
import pytest
from remote_bench import RemoteBench
from served_bench import PACE, REAL, beside_a_rig, until

from teleop.config.exchange.midi import MidiSection
from teleop.core.errors import DeviceError
from teleop.exchange.midi import feedback, server
from teleop.exchange.served import Served

CONTROLS = [
    {"sends": "note 1", "press": "stop"},
    {"sends": "note 2", "press": "clear"},
    {"sends": "note 3", "press": "preset 1"},
    {"sends": "note 4", "press": "store 1"},
    {"sends": "note 5", "press": "play nudge"},
    {"sends": "cc 7", "position": "pan"},
    {"sends": "bend", "speed": "pan"},
    {"sends": "cc 60", "jog": "tilt", "step": 1.0},
]
SECTION = MidiSection.model_validate({"type": "midi", "port": "desk", "controls": CONTROLS})


class Desk:
    """A controller that is plugged in and out."""

    has_feedback = True

    def __init__(self) -> None:
        self.is_there = True
        self.got: list[mido.Message] = []
        self.opened = 0
        self._hear: Callable[[Sequence[int]], object] | None = None

    def open(self, hear: Callable[[Sequence[int]], object]) -> Desk:
        if not self.is_there:
            raise DeviceError("no MIDI input has desk in its name; there is none")
        self._hear = hear
        self.opened += 1
        return self

    def send(self, data: Sequence[int]) -> None:
        self.got.append(mido.Message.from_bytes(data))

    def close(self) -> None:
        self._hear = None

    def play(self, *messages: mido.Message) -> None:
        assert self._hear is not None
        for message in messages:
            self._hear(message.bytes())


def with_desk(folder: Path, work: Callable[[RemoteBench, Desk], Awaitable[Any]], pace: float = PACE) -> list[str]:
    desk = Desk()

    async def serve(served: Served) -> None:
        await server.serve_port(SECTION, served, desk.open)

    async def plugged(bench: RemoteBench, _served: Served) -> None:
        await until(lambda: desk.got, "the first feedback")
        await work(bench, desk)

    return beside_a_rig(folder, serve, plugged, pace)


def cc(number: int, value: int) -> mido.Message:
    return mido.Message("control_change", control=number, value=value)


def note(number: int) -> mido.Message:
    return mido.Message("note_on", note=number, velocity=100)


def test_a_fader_sends_its_axis_and_its_motor_follows_it(tmp_path: Path) -> None:
    async def work(bench: RemoteBench, desk: Desk) -> None:
        desk.play(cc(7, 64))
        desk.play(cc(7, 80))
        await until(lambda: abs(bench.at() - (360 * 80 / 127 - 180)) < 1e-3 and bench.rests)
        assert bench.state["holder"] is None
        bench.say("goto", brief=True, axes={"pan": -90.0})
        await until(lambda: desk.got[-1] == cc(7, 32))

    lines = with_desk(tmp_path, work)
    assert lines == ["MIDI desk: connected"]


def test_stop_is_obeyed_from_a_button_while_another_has_control_and_its_light_burns(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def work(bench: RemoteBench, desk: Desk) -> None:
        bench.say("take_control")
        bench.say("goto", axes={"pan": 150.0})
        await until(lambda: bench.speed() > 5)
        desk.play(cc(60, 1), *(cc(7, value) for value in range(128)))
        await asyncio.sleep(0.1)
        assert bench.state["holder"] == "Anna"
        desk.play(note(1))
        await until(lambda: bench.state["stopped"] and bench.rests)
        assert bench.state["stopped_by"] == "MIDI desk"
        await until(lambda: mido.Message("note_on", note=1, velocity=127) in desk.got)

    monkeypatch.setattr(feedback, "OLD", math.inf)  # the clock of the rig is not the machine's
    assert any("Anna has control" in line for line in with_desk(tmp_path, work))


def test_clicks_jog_and_presets_are_stored_and_recalled(tmp_path: Path) -> None:
    async def work(bench: RemoteBench, desk: Desk) -> None:
        desk.play(*[cc(60, 1)] * 5)
        await until(lambda: abs(bench.state["axes"]["tilt"]["commanded"] - 5) < 1e-6 and bench.rests)
        desk.play(note(4))
        await until(lambda: "1" in bench.state["presets"])
        desk.play(*[cc(60, 127)] * 3)
        await until(lambda: abs(bench.state["axes"]["tilt"]["commanded"] - 2) < 1e-6 and bench.rests)
        desk.play(note(3))
        await until(lambda: abs(bench.state["axes"]["tilt"]["commanded"] - 5) < 1e-6 and bench.rests)

    with_desk(tmp_path, work)


def test_a_wheel_with_a_spring_moves_while_it_is_heard_and_frees_control(tmp_path: Path) -> None:
    async def work(bench: RemoteBench, desk: Desk) -> None:
        async def held(condition: Callable[[], object]) -> None:
            while not condition():
                desk.play(mido.Message("pitchwheel", pitch=8191))
                await asyncio.sleep(0.02)

        await held(lambda: bench.speed() > 50)
        assert bench.state["holder"] == "MIDI desk"
        await until(lambda: bench.rests)  # held still: nothing is heard
        desk.play(mido.Message("pitchwheel", pitch=0))
        await until(lambda: bench.state["holder"] is None)
        await held(lambda: bench.speed() > 5)
        desk.play(mido.Message("pitchwheel", pitch=0))
        await until(lambda: bench.rests and bench.state["holder"] is None)

    assert any("held and not heard" in line for line in with_desk(tmp_path, work, REAL))


@pytest.mark.parametrize("by", [cc(7, 127), mido.Message("pitchwheel", pitch=8191)])
def test_what_a_lost_port_moves_comes_to_rest_and_the_port_is_opened_again(
    tmp_path: Path, by: mido.Message, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server, "LOOK", 0.05)

    async def work(bench: RemoteBench, desk: Desk) -> None:
        desk.play(cc(7, 64))
        while bench.speed() < 40:
            desk.play(by)
            await asyncio.sleep(0.005)
        desk.is_there = False
        await until(lambda: bench.rests)
        assert bench.at() < 170
        await until(lambda: bench.state["holder"] is None)
        desk.is_there = True
        await until(lambda: desk.opened == 2 and desk._hear)
        desk.play(note(1))
        await until(lambda: bench.state["stopped"])

    lines = with_desk(tmp_path, work, REAL)
    assert sum("the port is gone" in line for line in lines) == 1
    assert lines.count("MIDI desk: connected") == 2


def test_a_flood_moves_nothing_and_a_stop_in_it_counts(tmp_path: Path) -> None:
    async def work(bench: RemoteBench, desk: Desk) -> None:
        assert desk._hear is not None
        desk.play(note(1))
        for number in range(20_000):
            desk._hear([number & 255, number >> 3 & 255, number >> 7 & 255])
        await until(lambda: bench.state["stopped"])
        assert bench.rests

    with_desk(tmp_path, work)
