"""A hundred thousand damaged descriptors: `python tests/benchmarks/fuzz_hid.py [DESCRIPTORS] [SEED]`.

Each is a published descriptor with damage done to it, a few items drawn from such descriptors, or noise; one of its
reports is read, at times too short. Nothing may raise or exceed the limits of the parser, and what is found must be
what a slow reader finds that looks at one bit after another. The slowest is printed, for people to judge.
"""

from __future__ import annotations

import json
import random
import sys
from pathlib import Path
from time import perf_counter

from teleop.inputs.hid.descriptor.fields import Field
from teleop.inputs.hid.descriptor.items import LONGEST, split
from teleop.inputs.hid.descriptor.parser import MAX_FIELDS, MAX_REPORT_FIELDS, Descriptor, parse_descriptor
from teleop.inputs.hid.descriptor.report import Control, read_report

_VECTORS = json.loads((Path(__file__).parents[1] / "data" / "hid.json").read_text())
PUBLISHED = [bytes.fromhex(known["descriptor"]) for known in _VECTORS["devices"] + _VECTORS["made"]]


def pieces(descriptor: bytes) -> list[bytes]:
    """Its short items, one by one."""
    places = [item.at for item in split(descriptor)[0]]
    return [descriptor[start:end] for start, end in zip(places, [*places[1:], len(descriptor)], strict=True)]


PIECES = [piece for descriptor in PUBLISHED for piece in pieces(descriptor)]


def harm(data: bytes, rng: random.Random) -> bytes:
    """A flipped bit, a cut, a gap, a piece twice, or items and numbers that mean the worst."""
    at, end = sorted((rng.randrange(len(data) + 1), rng.randrange(len(data) + 1)))
    near = min(end, at + 8)
    return rng.choice(
        (
            data[:at] + bytes((rng.randrange(256),)) + data[at + 1 :],
            data[:at],
            data[:at] + data[near:],
            data[:near] + data[at:],
            data[:at] + rng.choice(PIECES) + data[at:],
            data[:at] + rng.randbytes(rng.randrange(1, 6)) + data[at:],
            data[:at] + bytes((rng.choice((0x77, 0x97, 0x2B, 0x1B, 0x27, 0x17, 0x87)),)) + b"\xff" * 4 + data[at:],
        )
    )


def some_descriptor(rng: random.Random) -> bytes:
    chance = rng.random()
    if chance < 0.05:
        return rng.randbytes(rng.randrange(300))
    if chance < 0.25:
        return b"".join(rng.choices(PIECES, k=rng.randrange(80)))
    data = rng.choice(PUBLISHED)
    for _ in range(rng.randrange(1, 9)):
        data = harm(data, rng)
    return data[:LONGEST]


def bit_by_bit(field: Field, data: bytes) -> list[tuple[int, int | None]]:
    """Value and raw number of what a field says in the bytes behind the report id, as slowly as can be."""
    found: list[tuple[int, int | None]] = []
    for place in range(field.bit, field.bit + field.count * field.size, field.size):
        if place + field.size > 8 * len(data):
            break
        value = sum((data[bit // 8] >> bit % 8 & 1) << bit - place for bit in range(place, place + field.size))
        if field.minimum < 0 and value >= 1 << field.size - 1:
            value -= 1 << field.size
        if field.usages is None:
            found.append((value, None))
        elif field.minimum <= value <= field.maximum and value - field.minimum < len(field.usages):
            found.append((1, value))
    return found


def check(descriptor: Descriptor, report: bytes, controls: list[Control]) -> None:
    assert len(descriptor.fields) <= MAX_FIELDS
    number = (report[0] if report else None) if descriptor.numbered else 0
    data = report[1:] if descriptor.numbered else report
    mine = [field for field in descriptor.fields if field.report_id == number]
    assert sum(field.count for field in mine) <= MAX_REPORT_FIELDS
    expected = [found for field in mine for found in bit_by_bit(field, data)]
    assert [(control.value, control.raw) for control in controls] == expected


def some_report(descriptor: Descriptor, rng: random.Random) -> bytes:
    number, length = rng.choice(list(descriptor.lengths.items()) or [(0, 8)])
    report = rng.choice((rng.randbytes, bytes))(max(0, min(length, 600) + rng.choice((0, 0, 0, -1, -3, 2))))
    return bytes((number % 256,)) + report[1:] if descriptor.numbered else report


def main(descriptors: int = 100_000, seed: int = 0) -> int:
    rng = random.Random(seed)
    fields = controls = warned = 0
    slowest = (0.0, b"")
    for _ in range(descriptors):
        data = some_descriptor(rng)
        try:
            began = perf_counter()
            parsed = parse_descriptor(data)
            report = some_report(parsed, rng)
            found = read_report(parsed, report)
            slowest = max(slowest, (perf_counter() - began, data))
            check(parsed, report, found)
        except Exception:
            sys.stdout.write(f"failed with the descriptor {data.hex()}\n")
            raise
        fields += len(parsed.fields)
        controls += len(found)
        warned += bool(parsed.warnings)
    sys.stdout.write(
        f"{descriptors} descriptors, seed {seed}: {warned} warned of, {fields} fields, {controls} controls read, "
        f"nothing raised\nslowest: {slowest[0] * 1e3:.0f} ms for {len(slowest[1])} bytes, {slowest[1][:40].hex()}...\n"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
