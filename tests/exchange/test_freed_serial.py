"""FreeD over a serial line: a pseudo-terminal, with nobody who reads it, or whose other end goes."""

from __future__ import annotations

import asyncio
import os
import tty
from contextlib import suppress

import pytest
from fake_served import FakeServed

from teleop.config.exchange.freed import FreeDSection
from teleop.core.errors import TeleopError
from teleop.exchange import freed


def sent_to(fake: FakeServed, descriptor: int) -> asyncio.Task[None]:
    entry = {"type": "freed", "to": f"serial:{os.ttyname(descriptor)}@38400", "rate": 100.0, "latency": 0.0}
    return asyncio.create_task(freed.serve(FreeDSection.model_validate(entry), fake.served))


async def measured_until(fake: FakeServed, task: asyncio.Task[None], seconds: float) -> None:
    """The rig reports until the task has ended, or for so many seconds."""
    end = asyncio.get_running_loop().time() + seconds
    while not task.done() and asyncio.get_running_loop().time() < end:
        fake.door.measure(pan=1.0, tilt=2.0)
        await asyncio.sleep(0.01)


def test_a_line_that_goes_is_an_error_by_which_the_entry_is_served_again() -> None:
    far, near = os.openpty()
    tty.setraw(near)

    async def run() -> None:
        fake = FakeServed()
        task = sent_to(fake, near)
        await measured_until(fake, task, 0.1)
        os.close(near)
        os.close(far)
        await measured_until(fake, task, 20)
        with pytest.raises(TeleopError, match="/dev/"):
            await task

    asyncio.run(run())


def test_a_line_that_takes_nothing_holds_nothing_up() -> None:
    far, near = os.openpty()
    tty.setraw(near)
    os.set_blocking(near, False)
    with suppress(BlockingIOError):
        while True:
            os.write(near, bytes(4096))

    async def run() -> None:
        fake = FakeServed()
        task = sent_to(fake, near)
        await measured_until(fake, task, 0.2)
        assert not task.done()
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)

    asyncio.run(asyncio.wait_for(run(), 20))
    os.close(far)
    os.close(near)
