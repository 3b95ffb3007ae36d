"""A console that others can reach is announced by mDNS, under a name of its own, and taken back at its end."""

from __future__ import annotations

import asyncio
import json
import subprocess
import sys

import pytest

from teleop.gateway import discovery
from teleop.gateway.discovery import Announcement, announced, browse
from teleop.gateway.own_addresses import addresses_of

LOOPBACK = "127.0.0.1"


def test_two_rigs_of_a_name_are_announced_under_two_and_found_with_what_they_are(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(discovery, "QUIET", 0.2)  # both begin at once here: nothing is said twice

    async def work() -> None:
        ready, over = asyncio.Barrier(3), asyncio.Event()

        async def rig(what: Announcement) -> None:
            async with announced(what):
                await ready.wait()
                await over.wait()

        rigs = [Announcement("Studio A.1", LOOPBACK, 8470, True, {"zenoh": "tcp/127.0.0.1:7447"})]
        rigs.append(Announcement("Studio A.1", LOOPBACK, 8471))
        tasks = [asyncio.create_task(rig(each)) for each in rigs]
        await ready.wait()
        found = {each.port: each for each in await browse(1.5, [LOOPBACK])}
        over.set()
        await asyncio.gather(*tasks)
        assert {each.name for each in found.values()} == {"Studio A-1", "Studio A-1-2"}
        first = {"rig": "Studio A.1", "api": "/api", "tls": "1", "zenoh": "tcp/127.0.0.1:7447"}
        assert (found[8470].text, found[8470].url) == (first, "https://127.0.0.1:8470")
        assert found[8471].text == {"rig": "Studio A.1", "api": "/api", "tls": "0"}

    asyncio.run(work())


def test_the_rig_is_taken_back_when_what_announces_it_is_left_alone() -> None:
    what = Announcement("left alone", LOOPBACK, 8472)
    command = [sys.executable, "-m", "teleop.gateway.announcer"]

    async def work(process: subprocess.Popen[bytes]) -> None:
        network, added, removed = discovery._network([LOOPBACK]), asyncio.Event(), asyncio.Event()

        def changed(zeroconf, service_type, name, state_change) -> None:
            if name.startswith("left alone"):
                (removed if state_change.name == "Removed" else added).set()

        browser = discovery._browser(network, changed)
        await asyncio.wait_for(added.wait(), 30)
        assert process.stdin is not None
        process.stdin.close()  # as when the gateway was killed
        await asyncio.wait_for(removed.wait(), 30)  # by its goodbye: its record lives for more than an hour
        await browser.async_cancel()
        await network.async_close()

    with subprocess.Popen(command, stdin=subprocess.PIPE) as process:
        assert process.stdin is not None
        process.stdin.write(json.dumps(what.as_settings()).encode() + b"\n")
        process.stdin.flush()
        asyncio.run(work(process))
        assert process.wait(10) == 0


def test_a_name_that_no_label_may_have_is_made_one() -> None:
    for name in ("", "." * 80, "ü" * 80, "a\nb"):
        label = discovery._label(name)
        assert label
        assert len(label.encode()) <= 63
        assert "." not in label
        assert label.isprintable()


def test_every_address_is_all_but_those_of_this_computer_alone() -> None:
    assert addresses_of("192.0.2.7") == ["192.0.2.7"]
    assert LOOPBACK not in addresses_of("0.0.0.0")
