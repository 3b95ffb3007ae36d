"""Random input devices: descriptors, reports, unplugging and plugging in, through all that reads a real device."""

from __future__ import annotations

import random
from collections.abc import Callable

from fake_hid import GAMEPAD, JOYSTICK, vectors

from teleop.config.inputs_section import InputSection
from teleop.inputs.hid.backend import DeviceInfo
from teleop.inputs.hid.device import open_inputs
from teleop.inputs.hid.recording import RecordedDevices, Recording, Row
from teleop.manual.interlock import Interlock

TICK = 0.01
SESSION = 400  # events of one device


def fuzz(events: int, seed: int) -> int:
    """Play so many events; how many ticks moved something. Raises AssertionError where one may not."""
    chance = random.Random(seed)
    moved = done = 0
    while done < events:
        rows = _rows(chance, descriptor := _descriptor(chance))
        moved += _play(Recording([_info(chance)], descriptor, rows), rows[-1].time + 1)
        done += len(rows)
    return moved


def _descriptor(chance: random.Random) -> bytes:
    known = bytearray(bytes.fromhex(chance.choice(vectors()["devices"])["descriptor"]))
    for _ in range(chance.choice((0, 0, 1, 5))):
        known[chance.randrange(len(known))] = chance.randrange(256)
    return bytes(known[: chance.choice((len(known), len(known), chance.randrange(len(known)) + 1))])


def _info(chance: random.Random) -> DeviceInfo:
    return DeviceInfo(b"fuzz", 0x1234, 0x5678, "", "Fuzz", *chance.choice((GAMEPAD, JOYSTICK)), 0)


def _rows(chance: random.Random, descriptor: bytes) -> list[Row]:
    time, rows = 0.0, []
    report = bytes([chance.choice((1, 2, 3))]) + b"\x80" * chance.choice((7, 12, 63))
    for _ in range(SESSION):
        time += chance.choice((0.001, 0.01, 0.01, 0.01, 0.3, 1.5))
        kind = chance.random()
        if kind < 0.01:
            rows += [Row(time, gone=True), Row(time + (gap := chance.choice((0.0, 0.5, 3.0))))]
            time += gap
            continue
        if kind < 0.3:
            changed = bytearray(report)
            changed[chance.randrange(len(changed))] = chance.choice((0, 127, 128, 255, chance.randrange(256)))
            report = bytes(changed)
        elif kind < 0.32:
            report = chance.randbytes(chance.randrange(1, 64))
        rows.append(Row(time, report))
    return rows


def _play(recording: Recording, end: float) -> int:
    now, moved, centered = [0.0], 0, False
    clock: Callable[[], float] = lambda: now[0]  # noqa: E731
    backend = RecordedDevices([recording], clock, lambda: 0.0)
    with open_inputs([InputSection()], clock, backend, polled=True) as inputs:
        lock = Interlock(inputs[0])
        while now[0] < end:
            held = lock.read(now[0], True)
            moves = any(held.deflections.values())
            centered = not held.trouble and (centered or not moves)
            assert not (lock.unlocked and moves and not centered), "motion without a center before it"
            assert all(-1 <= value <= 1 for value in held.deflections.values())
            moved += lock.unlocked and moves
            now[0] += TICK
    return moved
