"""A real gimbal's own traffic: some 400 frames/s on three ids (docs/protocol-facts.md, "The gimbal on CAN")."""

from __future__ import annotations

from teleop.sim.gimbal.foreign_traffic import ForeignTraffic


def test_it_is_400_frames_a_second_however_often_one_looks() -> None:
    traffic = ForeignTraffic(100.0)
    assert traffic.due(100.0) == []
    frames = [frame for look in range(1, 201) for frame in traffic.due(100.0 + look / 200)]
    assert abs(len(frames) - 400) <= 1
    assert {can_id for can_id, _ in frames} == {0x530, 0x531, 0x426}
    assert len({data for _, data in frames}) == len(frames), "none is sent twice"


def test_a_pause_is_not_made_up_for() -> None:
    traffic = ForeignTraffic(0.0)
    assert len(traffic.due(60.0)) == 40
    assert traffic.due(60.0) == []
    assert len(traffic.due(60.05)) == 20


def test_every_frame_looks_like_the_begin_of_one_of_ours() -> None:
    """So that a program that reads these ids by mistake shows it; the data is a CAN frame's 8 bytes."""
    assert all(data[0] == 0xAA and len(data) == 8 for _, data in ForeignTraffic(0.0).due(0.05))
