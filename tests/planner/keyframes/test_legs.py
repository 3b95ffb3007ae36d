"""Legs from rest to rest, and repeated ones with fewer passes."""

from __future__ import annotations

from itertools import pairwise

from teleop.core.axes import Axis
from teleop.planner.keyframes.keys import Key
from teleop.planner.keyframes.legs import legs, shortened
from teleop.planner.keyframes.repeat import Repeat, repeated

PAN = Axis.PAN


def bounced(times: int, mode: Repeat = Repeat.BOUNCE):
    keys = [
        Key(at, position, where=f"key {at + 1}") for at, position in enumerate([0, 40, 0 if mode == "loop" else 60])
    ]
    return legs(PAN, repeated({PAN: keys}, times, mode)[PAN])


def test_a_dwell_is_a_leg_of_its_own() -> None:
    keys = [Key(0, 0), Key(2, 10, hold=1), Key(4, 20), Key(6, 30)]
    assert [[point.time for point in leg] for leg in legs(PAN, keys)] == [[0, 2], [2, 3], [3, 4, 6]]


def test_a_repeated_leg_is_the_same_with_fewer_passes() -> None:
    for mode in Repeat:
        (leg,) = bounced(99, mode)
        short, kept = shortened(leg)
        assert len(short) < 15
        assert len(kept) == len(leg) - 1
        for (first, last), number in zip(pairwise(leg), kept, strict=True):
            like = short[number : number + 2]
            assert {first.where, last.where} == {point.where for point in like}
            assert abs(last.position - first.position) == abs(like[1].position - like[0].position)
        assert (short[0], short[-1].position) == (leg[0], leg[-1].position)
        assert all(last.time > first.time for first, last in pairwise(short))


def test_a_leg_that_never_repeats_itself_is_whole() -> None:
    keys = [Key(at, (at * 7) % 11, where=f"key {at}") for at in range(30)]
    (leg,) = legs(PAN, keys)
    assert shortened(leg)[0] is leg
    (leg,) = legs(PAN, [Key(key.at, key.position) for key in keys])
    assert shortened(leg)[0] is leg
