"""What of a tracker's messages is passed on, and what is told of those that are not."""

from __future__ import annotations

import asyncio
import socket

import pytest
from fake_served import FakeServed

from teleop.config.exchange.freed import FreeDSection
from teleop.config.exchange.opentrackio import OpenTrackIOSection
from teleop.core.axes import Axis
from teleop.exchange import following, freed, opentrackio
from teleop.exchange.freed.codec import D1, encode
from teleop.exchange.freed.following import FreeDFollower
from teleop.exchange.opentrackio.following import OpenTrackIOFollower
from teleop.exchange.opentrackio.packets import JSON, packets
from teleop.exchange.opentrackio.sample import Moment, Pose, Source, encoded, identity, sample
from teleop.exchange.osc.commands import command
from teleop.links.osc_packets import Message

HOME = ("127.0.0.1", 5000)


@pytest.fixture
def clock(monkeypatch):
    class Clock:
        now = 100.0

    monkeypatch.setattr(following, "monotonic", lambda: Clock.now)
    return Clock


def freed_section(**keys: object) -> FreeDSection:
    return FreeDSection.model_validate({"type": "freed", "listen": "127.0.0.1:1", "as": "target", "camera": 2, **keys})


def message(x: float, y: float, z: float, camera: int = 2) -> bytes:
    return encode(D1(camera, 0, 0, 0, x, y, z))


def test_a_target_is_where_the_camera_looks(clock):
    fake = FakeServed()
    section = freed_section(position=[0.0, 0.0, 1.0], offset={"tilt": 2.0})
    FreeDFollower(section, fake.served, "freed").datagram_received(message(3.0, 3.0, 1.0), HOME)
    ((source, axes, at),) = fake.door.aims
    assert (source, at) == (1, 100.0)
    assert axes == {"pan": pytest.approx(45.0), "tilt": pytest.approx(2.0)}


def test_a_base_that_moves_keeps_the_target_in_sight(clock):
    fake = FakeServed()
    section = freed_section(**{"as": "base", "target": [0.0, 4.0, 1.0], "mount": 0.5})
    FreeDFollower(section, fake.served, "freed").datagram_received(message(4.0, 0.0, 0.5), HOME)
    assert fake.door.aims[0][1] == {"pan": pytest.approx(-45.0), "tilt": pytest.approx(0.0)}


def test_only_its_camera_counts_and_others_are_told_once(clock):
    fake = FakeServed()
    follower = FreeDFollower(freed_section(), fake.served, "freed")
    for _ in range(3):
        follower.datagram_received(message(1, 1, 1, camera=3), HOME)
    assert fake.door.aims == []
    assert fake.lines == ["freed: camera 3 from 127.0.0.1 is not followed: the entry has camera 2"]


def test_the_other_checksum_is_taken_with_one_warning(clock):
    fake = FakeServed()
    follower = FreeDFollower(freed_section(), fake.served, "freed")
    data = bytearray(message(1, 1, 1))
    data[28] = (0x100 - sum(data[:28])) & 0xFF
    for _ in range(3):
        clock.now += 0.02
        follower.datagram_received(bytes(data), HOME)
    assert len(fake.door.aims) == 3
    assert len(fake.lines) == 1
    assert "0x100" in fake.lines[0]


@pytest.mark.parametrize(("allow", "counts"), [([], False), (["192.168.1.20"], True), (["192.168.1.0/24"], True)])
def test_another_computer_moves_nothing_unless_it_is_allowed(clock, allow, counts):
    fake = FakeServed()
    follower = FreeDFollower(freed_section(listen="0.0.0.0:1", allow=allow), fake.served, "freed")
    follower.datagram_received(message(1, 1, 1), ("192.168.1.20", 7))
    follower.datagram_received(message(1, 1, 1), ("192.168.1.20", 7))
    assert bool(fake.door.aims) is counts
    told = ["freed: messages from 192.168.1.20 move nothing: add it to allow"]
    assert fake.lines == ([] if counts else told)


def test_of_two_senders_the_first_is_followed_until_it_is_silent(clock):
    fake = FakeServed()
    follower = FreeDFollower(freed_section(), fake.served, "freed")
    other = ("127.0.0.2", 7)
    follower.datagram_received(message(1, 1, 1), HOME)
    clock.now += 0.02
    follower.datagram_received(message(-1, 1, 1), other)
    assert len(fake.door.aims) == 1
    assert fake.lines == ["freed: 127.0.0.2 sends too, but 127.0.0.1 is followed"]
    clock.now += 1.1
    follower.datagram_received(message(-1, 1, 1), other)
    assert len(fake.door.aims) == 2


def test_a_flood_is_thinned(clock):
    fake = FakeServed()
    follower = FreeDFollower(freed_section(), fake.served, "freed")
    for _ in range(1000):
        clock.now += 0.0001
        follower.datagram_received(message(1, 1, 1), HOME)
    assert len(fake.door.aims) <= 13


def test_a_target_at_the_camera_is_told_and_not_aimed_at(clock):
    fake = FakeServed()
    FreeDFollower(freed_section(), fake.served, "freed").datagram_received(message(0, 0, 0), HOME)
    assert fake.door.aims == []
    assert fake.lines == ["freed: cannot be aimed at: the target is where the camera is"]


def track_section(**keys: object) -> OpenTrackIOSection:
    whole = {"type": "opentrackio", "listen": "127.0.0.1:1", "as": "target", "source": 4, **keys}
    return OpenTrackIOSection.model_validate(whole)


def samples(number: int, sequence: int = 1) -> list[bytes]:
    source = Source(number, identity("a", "b", 1), 50.0, "rig", "1")
    made = sample(source, Moment(1.0, 1, True), Pose(2.0, 2.0, 0.0, 0, 0, 0), None, "measured", False)
    return list(packets(encoded(made, JSON), JSON, sequence, 200))


def test_a_sample_in_segments_is_aimed_at_and_another_source_is_told(clock):
    fake = FakeServed()
    follower = OpenTrackIOFollower(track_section(), fake.served, "otrk")
    for data in (*samples(4), *samples(5, 100)):
        follower.datagram_received(data, HOME)
    assert [axes["pan"] for _, axes, _ in fake.door.aims] == [pytest.approx(45.0)]
    assert fake.lines == ["otrk: source 5 from 127.0.0.1 is not followed: the entry has source 4"]


GROUP = "239.135.1.77"


def test_a_multicast_group_is_joined_and_sent_to_on_its_interface():
    """Both ways, on the loopback interface."""

    async def both() -> FakeServed:
        listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        with listener:
            listener.bind((GROUP, 0))
            to = f"{GROUP}:{listener.getsockname()[1]}"
            inward = FakeServed(listener=listener)
            outward = FakeServed()
            outward.door.measure(pan=1.0, tilt=2.0)
            sends = {"type": "opentrackio", "to": to, "source": 4, "interface": "127.0.0.1", "latency": 0.0}
            section = OpenTrackIOSection.model_validate({**sends, "position": [3.0, 3.0, 0.0], "mtu": 300})
            tasks = [
                asyncio.create_task(opentrackio.serve(track_section(listen=to, interface="127.0.0.1"), inward.served)),
                asyncio.create_task(opentrackio.serve(section, outward.served)),
            ]
            async with asyncio.timeout(20):
                while not inward.door.aims:
                    outward.door.measure(pan=1.0, tilt=2.0)
                    await asyncio.sleep(0.01)
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
            return inward

    inward = asyncio.run(both())
    assert inward.door.aims[0][1]["pan"] == pytest.approx(45.0)


def test_a_serial_line_gets_whole_messages():
    import os
    import pty

    main, other = pty.openpty()

    async def some() -> bytes:
        fake = FakeServed()
        section = FreeDSection.model_validate(
            {"type": "freed", "to": f"serial:{os.ttyname(other)}@38400", "rate": 100.0, "latency": 0.0}
        )
        task = asyncio.create_task(freed.serve(section, fake.served))
        got = b""
        async with asyncio.timeout(20):
            while len(got) < 3 * 29:
                fake.door.measure(pan=1.0, tilt=2.0)
                await asyncio.sleep(0.01)
                os.set_blocking(main, False)
                try:
                    got += os.read(main, 4096)
                except BlockingIOError:
                    continue
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)
        return got

    try:
        got = asyncio.run(some())
    finally:
        os.close(main)
        os.close(other)
    one = encode(D1(1, 1.0, 2.0, 0, 0, 0, 0))
    assert got[:58] == one * 2


@pytest.mark.parametrize(
    ("address", "arguments", "asks"),
    [
        ("/teleop/track", (), {"do": "track", "attended": False}),
        ("/teleop/track/2", ("attended",), {"do": "track", "source": 2, "attended": True}),
        ("/teleop/track/2", (0.0,), None),
    ],
)
def test_a_button_of_osc_asks_for_it(address, arguments, asks):
    assert command(Message(address, arguments), [Axis.PAN]) == asks
