"""Random input devices, descriptors, reports and plug events, through all that is between a device and the motion.

What reads them is the reader of real devices; behind it are the operator and the live planner, on the virtual clock. An
oracle of its own looks at the devices' values alone: an axis may set off only by a control that was seen at its rest
before, since the device was plugged in, and is deflected now. Nothing may raise.
"""

from __future__ import annotations

import math
import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path

from fake_hid import GAMEPAD, JOYSTICK, vectors
from input_oracle import Oracle

from teleop.config.inputs_section import InputSection
from teleop.config.operator_settings import SticksSection
from teleop.config.presets import Presets
from teleop.core.axes import Axis, Limits, State
from teleop.core.interfaces import Feedback
from teleop.core.operator_input import Command, Held, Press
from teleop.inputs.hid.backend import DeviceInfo
from teleop.inputs.hid.descriptor.fields import Field
from teleop.inputs.hid.descriptor.parser import Descriptor, parse_descriptor
from teleop.inputs.hid.device import open_inputs
from teleop.inputs.hid.recording import RecordedDevices, Recording, Row
from teleop.manual.operator import Operator
from teleop.planner.live import Live

TICK = 0.01
SESSION = 400  # events of one device
GAPS, WEIGHTS = (0.0, 0.001, 0.01, 0.05, 0.3, 1.5), (1, 10, 40, 6, 2, 0.3)  # s between two reports
MIDDLE, LIMITS = Limits(-math.inf, math.inf, 60, 240, 2400), Limits(-90, 90, 60, 240, 2400)
RIG = {Axis.PAN: MIDDLE, Axis.TILT: LIMITS, Axis.ROLL: LIMITS, Axis.FOCUS: Limits(0, 1, 0.5, 2, 10)}


@dataclass
class Tally:
    """What came of so many events."""

    events: int = 0
    ticks: int = 0
    moving: int = 0  # ticks
    starts: int = 0  # of axes, each judged
    devices: int = 0
    plugs: int = 0

    def add(self, other: Tally) -> None:
        for each in fields(self):
            setattr(self, each.name, getattr(self, each.name) + getattr(other, each.name))

    def __str__(self) -> str:
        return (
            f"{self.events} events of {self.devices} devices ({self.plugs} plug events) in {self.ticks} ticks: "
            f"{self.starts} times an axis set off, {self.moving} ticks moved something"
        )


def fuzz(events: int, seed: int) -> Tally:
    """Play so many events. Raises AssertionError for a motion without a hand, and whatever the program raises."""
    chance, tally = random.Random(seed), Tally()
    while tally.events < events:
        recordings = [_recording(chance, number) for number in range(chance.choice((1, 1, 1, 2, 3)))]
        rows = [row for each in recordings for row in each.rows]
        tally.devices += len(recordings)
        tally.plugs += sum(not row.report for row in rows)
        tally.events += len(rows)
        _Run(chance, recordings, tally).play()
    return tally


def _recording(chance: random.Random, number: int) -> Recording:
    known = chance.choice(vectors()["devices"])
    descriptor = _harmed(chance, bytes.fromhex(known["descriptor"]))
    ids = (known["vendor_id"], known["product_id"]) if chance.random() < 0.3 else (0x1234, 0x5678)
    serial, port = chance.choice((("", ""), ("", f"1-{number}"), (f"S{number}", ""), ("clone", f"1-{number}")))
    usage = chance.choice((GAMEPAD, JOYSTICK))
    info = DeviceInfo(b"fuzz %d" % number, *ids, serial, f"Fuzz {number}", *usage, 0, port)
    return Recording([info], descriptor, list(_Reports(chance, parse_descriptor(descriptor)).rows()))


def _harmed(chance: random.Random, descriptor: bytes) -> bytes:
    known = bytearray(descriptor)
    for _ in range(chance.choice((0, 0, 0, 1, 5))):
        known[chance.randrange(len(known))] = chance.randrange(256)
    return bytes(known[: chance.choice((len(known),) * 5 + (chance.randrange(len(known)) + 1,))])


class _Reports:
    """Reports that a device with this descriptor may send, and some that it may not."""

    def __init__(self, chance: random.Random, descriptor: Descriptor) -> None:
        self._chance = chance
        fields = [each for each in descriptor.fields if each.bit + each.size <= 600 and each.size <= 32]
        self._fields: dict[int, list[Field]] = {}
        for each in fields:
            self._fields.setdefault(each.report_id, []).append(each)
        self._numbered = descriptor.numbered
        self._places = chance.choice((("middle",), ("middle",), ("middle", "low", "high")))
        self._bits = {number: self._rest(own) for number, own in self._fields.items()}
        self._calm = 0  # reports for which nothing is touched
        self._lengths = {number: min(max(n, 1), 75) for number, n in descriptor.lengths.items()}

    def _rest(self, fields: Sequence[Field]) -> int:
        bits = 0
        for each in fields:
            places = {"low": each.minimum, "middle": (each.minimum + each.maximum + 1) // 2, "high": each.maximum}
            at = places[self._chance.choice(self._places)]
            bits = _put(bits, each, 0 if each.maximum - each.minimum == 1 or each.usages else at)
        return bits

    def rows(self) -> Iterator[Row]:
        chance, time = self._chance, 0.0
        for _ in range(SESSION):
            time += chance.choices(GAPS, WEIGHTS)[0]
            if chance.random() < 0.01:
                yield Row(time, gone=True)
                time += chance.choice((0.0, 0.5, 3.0))
                yield Row(time)
            else:
                yield Row(time, self._report())

    def _report(self) -> bytes:
        chance = self._chance
        if not self._fields or chance.random() < 0.01:
            return chance.randbytes(chance.randrange(1, 64))
        number = chance.choice(list(self._fields))
        self._calm -= 1
        if chance.random() < 0.03:
            self._places, self._calm = ("middle",), chance.choice((5, 40, 80))
            self._bits = {each: self._rest(own) for each, own in self._fields.items()}
        elif self._calm < 0:
            for _ in range(chance.choice((0, 0, 0, 0, 1, 3))):
                self._turn(number, chance.choice(self._fields[number]))
        data = self._bits[number].to_bytes(80, "little")[: self._lengths.get(number, 8)]
        length = len(data) + chance.choices((0, 1, -1, -3), (97, 1, 1, 1))[0]
        return bytes([number & 0xFF]) * self._numbered + (data + b"\0")[: max(length, 1)]

    def _turn(self, number: int, field: Field) -> None:
        low, high = sorted((field.minimum, field.maximum))
        middle = (low + high) // 2
        at = self._chance.choice((middle, middle, middle + 1, low, high, high + 1, self._chance.randint(low, high)))
        self._bits[number] = _put(self._bits[number], field, at)


def _put(bits: int, field: Field, value: int) -> int:
    mask = (1 << field.size) - 1
    return bits & ~(mask << field.bit) | (value & mask) << field.bit


class _Keys:
    """A terminal on which a STOP is cleared now and then, so that the devices go on moving something."""

    name = "keys"

    def __init__(self, chance: random.Random) -> None:
        self._chance = chance

    def read(self, now: float) -> Held:
        return Held(presses=[Press(Command.CLEAR)] if self._chance.random() < 0.02 else [])


class _Shelf(Presets):
    """Presets that are on no disk."""

    def _save(self) -> None:
        self._name()


@dataclass
class _Run:
    chance: random.Random
    recordings: Sequence[Recording]
    tally: Tally
    now: float = 0.0
    limits: Mapping[Axis, Limits] = field(default_factory=lambda: RIG)

    def play(self) -> None:
        backend = RecordedDevices(self.recordings, lambda: self.now, lambda: 0.0)
        with open_inputs(self._sections(), lambda: self.now, backend, polled=True) as inputs:
            keys, shelf = _Keys(self.chance), _Shelf(Path("presets"))
            operator = Operator(self.limits, [*inputs, keys], shelf, SticksSection(start_range=3), 1.0)
            live, oracle = Live(self.limits, TICK), Oracle(inputs)
            live.reset({axis: State(0.0) for axis in self.limits})
            operator.start(0.0, live.motion)
            end = max(each.end for each in self.recordings) + 1
            while self.now < end:
                before = live.motion
                demand, _ = operator.read(self.now, Feedback(before, {}))
                self.tally.starts += oracle.judge(operator.status, before, after := live.step(demand, 1))
                self.tally.ticks += 1
                self.tally.moving += any(state.velocity for state in after.values())
                self.now += TICK

    def _sections(self) -> list[InputSection]:
        """None, one for any device, some by name that share a model, and one that has to be held."""
        by_name = [{"device": {"name": f"Fuzz {number}"}} for number in range(len(self.recordings))]
        alike = [{"device": {"vendor": 0x1234}}, {"device": {"vendor": 0x1234}, "name": "Other"}]
        return [
            InputSection.model_validate(each)
            for each in self.chance.choice(([{}], by_name, by_name, alike, [{"enable": "Button 9"}]))
        ]
