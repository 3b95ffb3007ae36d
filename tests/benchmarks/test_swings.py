"""How often a leg swings: `pytest tests/benchmarks/test_swings.py -s -n 0` prints the shares of random moves.

Each has 3 to 5 keys on whole seconds and degrees, and any overshoot is allowed. A swing is more than twice what an
independent linear programme finds to be the least, and more than is tolerated of any way. 16 % of such moves swung
when one tight place made all of a leg undirected.
"""

from __future__ import annotations

import random
import sys
from itertools import pairwise

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.overshoot import LEAST, SHARE
from teleop.planner.keyframes.planner import Key, attempt
from tests.support.move_lp import least_overshoot_lp

PAN = Axis.PAN
SIM = Limits(-180, 180, 120, 240, 1200)
MOVES = 60
ANY = 360.0  # deg


def whole_number_move(rng: random.Random) -> list[tuple[float, float]]:
    times = np.cumsum([0, *(rng.randint(1, 8) for _ in range(rng.randint(2, 4)))]).tolist()
    return [(float(time), float(rng.randint(-60, 60))) for time in times]


def test_no_leg_swings() -> None:
    rng = random.Random(17)
    planned = overshot = beyond = swings = 0
    for _ in range(MOVES):
        keys = whole_number_move(rng)
        move = attempt({PAN: [Key(*key, where=str(i), overshoot=ANY) for i, key in enumerate(keys)]}, {PAN: SIM})
        if move is None:
            continue
        planned += 1
        least = least_overshoot_lp(keys, SIM) or 0.0
        ways = [abs(last - first) for (_, first), (_, last) in pairwise(keys)]
        excess = [(each.size, max(LEAST, SHARE * ways[int(each.first)])) for each in move.overshoots]
        overshot += bool(excess)
        beyond += any(size > tolerated for size, tolerated in excess)
        swings += any(size > max(2 * least, tolerated) for size, tolerated in excess)
    sys.stdout.write(
        f"{planned} of {MOVES} planned: {overshot / planned:.0%} overshoot, {beyond / planned:.0%} by more than is "
        f"tolerated where the file does not say, {swings / planned:.0%} swing\n"
    )
    assert planned > MOVES / 2
    assert swings == 0
