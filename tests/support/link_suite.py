"""What every link must do, whatever carries its bytes: subclassed once for each transport, with an `ends` fixture."""

import itertools
import random
import threading

import pytest
from waiting import collect, wait_for_loss, wait_until

from teleop.core.errors import LinkError
from teleop.links import ClosableLink

Ends = tuple[ClosableLink, ClosableLink]


def some_frames(count: int, seed: int) -> list[bytes]:
    """Byte strings of the lengths that DJI frames have, some of them not a multiple of a CAN frame's 8 bytes."""
    dice = random.Random(seed)
    return [dice.randbytes(dice.choice((16, 19, 26, 40, 82))) for _ in range(count)]


class LinkSuite:
    """The fixture `ends` gives the host's and the device's open end."""

    def test_frames_arrive_whole_and_in_order_in_both_directions(self, ends: Ends) -> None:
        near, far = ends
        for there, back in zip(some_frames(40, 1), some_frames(40, 2), strict=True):
            near.send(there)
            far.send(back)
            assert collect(far, len(there)) == there
            assert collect(near, len(back)) == back

    def test_frames_that_wait_together_stay_in_order(self, ends: Ends) -> None:
        near, far = ends
        frames = some_frames(6, 3)
        for frame in frames:
            near.send(frame)
        sent = b"".join(frames)
        assert collect(far, len(sent)) == sent

    def test_silence_is_an_empty_string_and_not_an_error(self, ends: Ends) -> None:
        near, far = ends
        assert [near.receive(), far.receive(), near.receive()] == [b"", b"", b""]

    def test_a_closed_link_says_so_on_every_call(self, ends: Ends) -> None:
        near, _ = ends
        near.close()
        near.close()
        for _ in range(2):
            with pytest.raises(LinkError, match="closed"):
                near.send(b"x")
            with pytest.raises(LinkError, match="closed"):
                near.receive()


class UnpluggedSuite:
    """For links to hardware that can vanish: the fixture `unplug` makes it."""

    def test_a_link_whose_hardware_vanished_stays_lost(self, ends: Ends, unplug) -> None:
        near, _ = ends
        unplug()
        first = wait_for_loss(near)
        assert "\n" not in str(first)
        for _ in range(3):
            with pytest.raises(LinkError) as again:
                near.receive()
            assert str(again.value) == str(first)
            with pytest.raises(LinkError):
                near.send(b"x")
        near.close()


class CanSuite(LinkSuite):
    """For CAN buses: the fixture `inject(id, data, extended)` is a third node's transmission, seen by both ends."""

    def test_foreign_ids_are_counted_and_not_received(self, ends: Ends, inject) -> None:
        near, far = ends
        inject(0x530, b"duml")
        inject(0x222, b"extended", extended=True)
        inject(0x530, b"duml")
        far.send(b"the gimbal's")
        assert collect(near, 12) == b"the gimbal's"
        assert near.foreign == {0x530: 2, 0x222: 1}  # type: ignore[attr-defined]  # every CanLink has it

    def test_what_is_tapped_has_each_frame_once_and_another_host_is_counted(self, ends: Ends, inject) -> None:
        near, far = ends
        heard: list[tuple[int, bytes]] = []
        near.tap = lambda frame: heard.append((frame.id, frame.data))  # type: ignore[attr-defined]
        inject(0x223, b"other")
        wait_until(lambda: near.receive() == b"" and near.with_own_id == 1)  # type: ignore[attr-defined]
        near.send(b"question")
        arrived = bytearray()
        wait_until(lambda: arrived.extend(far.receive()) or arrived.endswith(b"question"))
        far.send(b"answer")
        assert collect(near, 6) == b"answer"
        assert heard == [(0x223, b"other"), (0x223, b"question"), (0x222, b"answer")]

    def test_frames_of_two_threads_never_interleave(self, ends: Ends) -> None:
        near, far = ends
        frames = [[bytes([mark]) * 26 for _ in range(20)] for mark in (1, 2)]

        def send(own: list[bytes]) -> None:
            for frame in own:
                near.send(frame)
                answered.wait()  # a burst would overflow udp_multicast's socket, which loses without a word

        answered = threading.Barrier(3)
        threads = [threading.Thread(target=send, args=(own,)) for own in frames]
        for thread in threads:
            thread.start()
        arrived = b""
        for _ in range(20):
            arrived += collect(far, 52)
            answered.wait()
        for thread in threads:
            thread.join()
        runs = [(mark, len(list(run))) for mark, run in itertools.groupby(arrived)]
        assert sum(length for _, length in runs) == 40 * 26
        assert all(length % 26 == 0 for _, length in runs)

    def test_nothing_is_held_back_on_a_free_bus(self, ends: Ends) -> None:
        near, far = ends
        near.send(b"12345678" * 3)
        assert collect(far, 24) == b"12345678" * 3
        wait_until(lambda: near.receive() == b"")
        assert not near.counts  # type: ignore[attr-defined]  # every CanLink has it
