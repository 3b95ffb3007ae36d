"""Hostile MIDI and sound: `python tests/benchmarks/fuzz_midi.py [COUNT]`. Nothing may be raised, lock, or move.

Of each kind COUNT (100 000 unless given): messages of any bytes at a surface with every kind of control, quarter frames
of any order and time at the decoder and tracker of MIDI timecode, blocks of any sound at that of LTC.
"""

from __future__ import annotations

import random
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from midi_bench import LIMITS, OWN, section, state

from teleop.exchange.midi.feedback import Feedback
from teleop.exchange.midi.messages import read
from teleop.exchange.midi.surface import Surface
from teleop.exchange.timecode.ltc import LtcDecoder
from teleop.exchange.timecode.mtc import MtcDecoder
from teleop.exchange.timecode.tracker import Tracker


def surface(count: int, rng: random.Random) -> str:
    """A fader may send its axis somewhere, by a message of its own, and only within its ends."""
    own = Surface(section(), LIMITS)
    feedback, now, sent = Feedback(own), 0.0, 0
    for _ in range(count):
        now += rng.random() * 0.05
        data = [rng.randrange(256) for _ in range(rng.choice((0, 1, 2, 3, 3, 3, 3, 4, 40)))]
        if rng.random() < 0.5 and len(data) > 2:
            data[0], data[1], data[2] = rng.choice((0x90, 0xB0, 0xE0, 0xE1)), data[1] & 127, data[2] & 127
        known = read(data) is not None
        stop = own.stops(data)
        command = own.take(data, now)
        assert known or not (stop or command)
        here = state(pan=rng.uniform(-90, 90), tilt=rng.uniform(-50, 50), stopped=rng.random() < 0.1)
        goto = own.goto(here, now, OWN)
        for axis, to in (goto or {"axes": {}})["axes"].items():
            of = next(limits for name, limits in LIMITS.items() if name.value == axis)
            assert of.minimum <= to <= of.maximum
            sent += 1
        own.jogs()
        assert all(-1 <= each <= 1 for each in own.deflections(now).values())
        for message in feedback.messages(here, now):
            assert read(message) is not None
    return f"{sent} gotos by valid messages"


def quarter_frames(count: int, rng: random.Random) -> str:
    decoder, tracker, now, found = MtcDecoder(), Tracker(None, (1, 0, 0, 0)), 0.0, 0
    for _ in range(count):
        now += rng.random() * 0.02
        data = [rng.choice((0xF1, 0xF1, 0xF1, rng.randrange(256))), rng.randrange(256)][: rng.choice((1, 2, 2, 2, 2))]
        reading = decoder.take(data, now)
        if reading is not None:
            found += 1
            tracker.take(reading, now)
        tracker.look(now)
        assert tracker.reference(now) is None
    whole = 0
    for _ in range(count // 8):  # whole codes with any label, as a sender that is mad would have them
        label = [rng.randrange(16) for _ in range(8)]
        for piece, value in enumerate(label):
            now += 0.01 * rng.random()
            reading = decoder.take([0xF1, piece << 4 | value], now)
            if reading is not None:
                whole += 1
                tracker.take(reading, now)
        assert tracker.reference(now) is None
    return f"{found} and {whole} readings, none locked"


def sound(count: int, rng: random.Random) -> str:
    decoder, tracker, found = LtcDecoder(48000, 25.0), Tracker(25.0, (1, 0, 0, 0)), 0
    for number in range(count):
        size = rng.randrange(0, 200)
        if rng.random() < 0.5:
            block = rng.randbytes(size)
        else:  # square waves, which is what LTC looks like
            wave = rng.choice((5, 10, 12, 20, 40, 97))
            block = b"".join(b"\x00\x40" if k // wave % 2 else b"\x00\xc0" for k in range(size // 2))
        for reading in decoder.take(block):
            found += 1
            tracker.take(reading, number * 0.002)
        assert tracker.reference(number * 0.002) is None
    decoder.close()
    return f"{found} readings, none locked"


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
    for work in (surface, quarter_frames, sound):
        began = time.perf_counter()
        said = work(count, random.Random(20261129))
        print(f"{work.__name__}: {count} inputs, {said}, {time.perf_counter() - began:.1f} s")


if __name__ == "__main__":
    main()
