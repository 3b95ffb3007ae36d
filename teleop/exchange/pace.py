"""Slots of time at a steady rate: each begins where it is due by the first one, so that no delay adds up."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from time import monotonic


async def slots(rate: float) -> AsyncIterator[float]:
    """When each slot is due (s, by the monotonic clock), once it is; those that were slept over are left out."""
    begin, number = monotonic(), 0
    while True:
        due = begin + number / rate
        if (wait := due - monotonic()) > 0:
            await asyncio.sleep(wait)
        else:
            await asyncio.sleep(0)
        yield due
        number = max(number + 1, int((monotonic() - begin) * rate))
