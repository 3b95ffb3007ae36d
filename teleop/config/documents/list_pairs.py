"""Which entry of a changed list was which before: so that an editor's comment stays with what it is about."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

MOST = 40_000  # pairs to compare: more are taken in their order


def pairing(old: Sequence[Any], new: Sequence[Any]) -> list[tuple[int, int]]:
    """Places of the same entries in both lists, in order: as many as the shorter one has, and those that are likest."""
    count = min(len(old), len(new))
    if len(old) == len(new) or len(old) * len(new) > MOST:
        return [(index, index) for index in range(count)]
    if len(old) > len(new):
        return [(place, index) for index, place in pairing(new, old)]
    return _likest(old, new)


def _likest(few: Sequence[Any], many: Sequence[Any]) -> list[tuple[int, int]]:
    """Each of `few` with one of `many`."""
    spare = len(many) - len(few)
    best = [[0.0] * (spare + 1) for _ in range(len(few) + 1)]  # by how many of each are left, from the end
    skips = [[False] * (spare + 1) for _ in range(len(few) + 1)]
    for i in reversed(range(len(few))):
        for skipped in reversed(range(spare + 1)):
            taken = best[i + 1][skipped] + likeness(few[i], many[i + skipped])
            passed = best[i][skipped + 1] if skipped < spare else -1.0
            best[i][skipped], skips[i][skipped] = max((taken, False), (passed, True))
    pairs, skipped = [], 0
    for i in range(len(few)):
        while skips[i][skipped]:
            skipped += 1
        pairs.append((i, i + skipped))
    return pairs


def likeness(one: Any, other: Any) -> float:
    """1 for the same, 0 for nothing in common; of mappings the share of their keys that have the same value."""
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        keys = one.keys() | other.keys()
        return sum(key in one and key in other and one[key] == other[key] for key in keys) / max(len(keys), 1)
    return float(bool(one == other))
