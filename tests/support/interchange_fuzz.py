"""Hostile files of other programs: valid ones with bytes, numbers and lines changed, and what must not come of it."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np
from made_motions import content, made_motion

from teleop.core.axes import Axis
from teleop.core.errors import TeleopError
from teleop.interchange import companion, otio, usd
from teleop.interchange.child import answer
from teleop.interchange.motion import MOST_DEGREES, MOST_FRAMES, Motion
from teleop.interchange.rotation import ORDERS
from teleop.interchange.table import BY_NAME, Hints, WriteOptions

WORDS = [
    *(b"nan", b"inf", b"-inf", b"1e999", b"-1e308", b"9" * 30, b"0x10", b"1,5", b"--1", b"1_0", b"1e-400", b"-", b"0"),
    *(b"\xef\xbb\xbf", b"\xff\xfe", b"\0", b"\r", b"\n", b"\r\n\r\n", b"\t", b",,", b";", b'"', b"'''", b"#", b" "),
    *(b"<!DOCTYPE a>", b"<!ENTITY b 'c'>", b"&b;", b"<", b"/>", b"{", b"}", b"[[[[", b"null", b"true", b"Axes = "),
    *(b"\xc3\x28", b"\xf0\x9f\x8e\xa5", b'units="rad"', b"() -> ", b"@/etc/passwd@", b"timeSamples"),
    b'"OTIO_SCHEMA": "X.1"',
]
LONGEST = 40_000  # bytes of a mutation


def valid(name: str, *, binary: bool = True) -> Sequence[bytes]:
    """Files of a format to begin with."""
    few, many = made_motion(5), made_motion(40)
    files = [content(name, few), content(name, many), content(name, made_motion(3, focus=False))]
    if name == "usd" and binary:
        files.append(usd.write(few, WriteOptions(None, few.axes), ".usdc"))
    return files


def mutated(raw: bytes, chance: random.Random) -> bytes:
    """A file with one to six changes."""
    data = bytearray(raw)
    for _ in range(chance.randint(1, 6)):
        place = chance.randrange(len(data) + 1)
        length = chance.choice([1, 1, 2, 8, 40, 400])
        match chance.randrange(7):
            case 0:
                data[place : place + 1] = bytes([chance.randrange(256)])
            case 1:
                del data[place : place + length]
            case 2:
                data[place:place] = chance.choice(WORDS)
            case 3:
                data[place : place + length] = chance.choice(WORDS)
            case 4:
                data[place:place] = data[place : place + length] * chance.choice([1, 1, 3, 20])
            case 5:
                del data[place:]
            case _:
                lines = bytes(data).split(b"\n")
                first, second = chance.randrange(len(lines)), chance.randrange(len(lines))
                lines[first], lines[second] = lines[second], lines[first]
                data = bytearray(b"\n".join(lines))
    return bytes(data[:LONGEST])


def hints(chance: random.Random) -> Hints:
    """What a user might have said, or not."""
    from fractions import Fraction

    rate = chance.choice([None, Fraction(24), Fraction(24000, 1001)])
    columns = chance.choice([None, None, ["pan", "tilt", "roll", "focus"], ["pan", "tilt", "roll"], ["pan"]])
    return Hints(rate, chance.choice([None, *ORDERS]), columns, chance.choice([None, [Axis.PAN]]), None, None)


def _extracted(module: str, name: str) -> Callable[[bytes, Hints, Path], Motion | None]:
    """As the child process does it, without one."""

    def read(raw: bytes, given: Hints, folder: Path) -> Motion | None:
        import json

        file = folder / f"fuzz{BY_NAME[name].endings[-1]}"
        file.write_bytes(raw)
        code, text = answer(module, file)
        assert code in (0, 3, 4), code
        if code:
            return None
        return {"usd": usd, "otio": otio}[module].motion_of(json.loads(text), "fuzz", given)

    return read


def _direct(name: str) -> Callable[[bytes, Hints, Path], Motion | None]:
    return lambda raw, given, _folder: BY_NAME[name].load().read(raw, "fuzz", given)


def _beside(raw: bytes, given: Hints, _folder: Path) -> Motion | None:
    found = companion.parsed(raw, "fuzz")
    if found is not None:
        companion.hints_of(found, "fuzz", given, BY_NAME["raw"])
    return None


READERS: Mapping[str, Callable[[bytes, Hints, Path], Motion | None]] = {
    **{name: _direct(name) for name in ("chan", "csv", "arcm", "raw", "kuper", "blender")},
    "usd": _extracted("usd", "usd"),
    "otio": _extracted("otio", "otio"),
    "companion": _beside,
}


def seeds(name: str, *, binary: bool = True) -> Sequence[bytes]:
    """Valid files to change."""
    if name == "companion":
        motion = made_motion(5)
        return [companion.text(motion, BY_NAME["raw"], [Axis.PAN, Axis.TILT], ["focus"]).encode()]
    return valid(name, binary=binary)


def attack(name: str, count: int, seed: int, folder: Path, *, binary: bool = True) -> int:
    """Read so many hostile files; how many of them were taken for valid. Any error but TeleopError passes through.

    `binary`: also of a format whose library has unbounded memory, so only in a process that is bounded.
    """
    chance, taken = random.Random(seed), 0
    start, read, refusals = seeds(name, binary=binary), READERS[name], list[str]()
    for _ in range(count):
        raw, given = mutated(chance.choice(start), chance), hints(chance)
        try:
            motion = read(raw, given, folder)
        except TeleopError as error:
            refusals.append(str(error))
            continue
        if motion is not None:
            check(motion)
            taken += 1
    assert not [text for text in refusals if "\n" in text or not text or len(text) > 2000]
    return taken


def check(motion: Motion) -> None:
    """A path that was read is one."""
    assert 0 < len(motion.times) <= MOST_FRAMES
    assert np.isfinite(motion.times).all()
    assert (np.diff(motion.times) > 0).all()
    for axis, column in motion.positions.items():
        assert len(column) == len(motion.times)
        assert (np.abs(column) <= (2 * MOST_DEGREES if axis.is_angle else 1.001)).all(), (axis, column)
    assert motion.rate is None or motion.rate > 0
