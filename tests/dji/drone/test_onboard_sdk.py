"""The published Onboard SDK frames: each means what its maker's parameters say, and comes out byte for byte again."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from teleop.dji.drone.messages import NOBODY
from teleop.dji.drone.onboard_sdk import A3, M100, OnboardRegistry
from teleop.dji.frame import Frame, FrameReader
from teleop.dji.json_record import Transcriber, restore
from teleop.dji.message import Opaque

VECTORS = {
    vector["name"]: vector
    for vector in json.loads((Path(__file__).parents[2] / "data" / "onboard.json").read_text())["vectors"]
}
PLAIN = {name: vector for name, vector in VECTORS.items() if not vector["enc"]}
IDLE = dict.fromkeys((f"channel_{number}" for number in range(7, 16)), 1024)
ON = {"on": True, "back_to_rc": True}


def sticks(roll: int, pitch: int, throttle: int, yaw: int) -> dict[str, Any]:
    named = {"roll": roll, "pitch": pitch, "throttle": throttle, "yaw": yaw}
    return {**named, "gear": "down", "go_home": 1024, "mode": "p", **IDLE}


# What is not in the makers' parameters is in their bytes: the rates, the version's texts.
MEANINGS: dict[str, tuple[str, dict[str, Any]]] = {
    "vrc_enable_backtoreal": ("drone.virtual_rc", ON),
    "vrc_data_seed_arm": ("drone.sticks", sticks(364, 364, 364, 1684)),
    "vrc_data_seed_up": ("drone.sticks", sticks(1024, 1024, 1684, 1024)),
    "get_version": ("drone.version", {}),
    "activate": ("drone.activate", {"app_id": 1030093, "level": 2, "version": 50399744, "bundle": NOBODY}),
    "set_broadcast_freq": (
        "drone.frequency",
        {
            "time": "hz_1",
            "quaternion": "hz_10",
            "acceleration": "hz_50",
            "velocity": "hz_100",
            "angular_rate": "hz_50",
            "position": "hz_10",
            "magnetometer": "hz_1",
            "rc": "hz_10",
            "gimbal": "hz_50",
            "status": "hz_100",
            "battery": "hz_50",
            "control": "hz_10",
        },
    ),
    "set_control_obtain": ("drone.control", {"order": "obtain"}),
    "move_vel_body_yawrate_stable": (
        "drone.move",
        {
            "stable": True,
            "frame": "body",
            "yaw_control": "rate",
            "vertical": "velocity",
            "horizontal": "velocity",
            "x": 1.5,
            "y": -0.5,
            "z": 0.25,
            "yaw": -10.0,
        },
    ),
    "gimbal_angle": (
        "drone.gimbal_angle",
        {
            "yaw": -90.0,
            "roll": 0.0,
            "pitch": -45.0,
            "absolute": True,
            "yaw_ignored": False,
            "roll_ignored": True,
            "pitch_ignored": False,
            "duration": 2.0,
        },
    ),
    "ack_version_m100": (
        "drone.version",
        {
            "code": "not_activated",
            "checksum": 0xA6453AAC,
            "id": "041D492163",
            "version": "SDK-v1.0 BETA M100-03.01.01.00",
        },
    ),
    "ack_activate_0000": ("drone.activate", {"code": "ok"}),
    "ack_activate_ff01": ("drone.activate", {"code": "not_activated"}),
    "ack_setcontrol_0002": ("drone.control", {"code": "obtained"}),
    "push_lost_control_s2": ("drone.event", {"event": "control_lost"}),
    "header_only_ack": ("raw", {"value": ""}),
}


def frame_of(vector: dict[str, Any]) -> Frame:
    (frame,) = FrameReader().feed(bytes.fromhex(vector["hex"]), 0.0)
    assert isinstance(frame, Frame)
    return frame


def registry_of(vector: dict[str, Any]) -> OnboardRegistry:
    return A3 if vector.get("layout", "").startswith("A3") else M100


@pytest.mark.parametrize("name", PLAIN)
def test_published_frames_come_out_byte_for_byte(name: str) -> None:
    vector, registry = VECTORS[name], registry_of(VECTORS[name])
    frame = frame_of(vector)
    assert (frame.cmd_type, frame.sequence) == (vector["session"] | vector["ack"] << 5, vector["seq"])
    decoded = registry.decode(frame, bytes(vector.get("answers", b"")))
    data = decoded.message.encode() if frame.is_reply else decoded.message.data()
    assert Frame(data, frame.cmd_type, frame.sequence).encode().hex() == vector["hex"]
    record = json.loads(json.dumps(Transcriber(registry).record(frame)))
    assert restore(registry, record).hex() == vector["hex"]


@pytest.mark.parametrize("name", MEANINGS)
def test_published_frames_mean_what_their_makers_say(name: str) -> None:
    vector = VECTORS[name]
    decoded = M100.decode(frame_of(vector), bytes(vector.get("answers", b"")))
    assert (M100.name(decoded), decoded.message.fields()) == MEANINGS[name]


BROADCASTS = [name for name, vector in VECTORS.items() if "layout" in vector]
FIELDS = {
    "time": "time",
    "quaternion": "q",
    "acceleration": "a",
    "velocity": "v",
    "angular_rate": "w",
    "position": "pos",
    "gps": "gps",
    "rtk": "rtk",
    "magnetometer": "mag",
    "rc": "rc",
    "gimbal": "gimbal",
    "status": "status",
    "battery": "battery",
    "control": "ctrl",
}
"""The vectors' names for the parts, whose numbers they give in the order of the wire."""
SCALED = {"gps": {"longitude": 1e7, "latitude": 1e7}}
BITS = {
    "gimbal": ("pitch_limited", "roll_limited", "yaw_limited"),
    "velocity": ("valid",),
}


def numbers(name: str, part: Any) -> list[float]:
    """A part as the vectors have it: plain numbers, flags in one byte at the end."""
    if isinstance(part, int):
        return [part]
    if name == "control":
        return [part.mode, part.device | part.requested << 3 | part.virtual_rc << 4]
    bits = BITS.get(name, ())
    plain = [
        getattr(part, field.name) * SCALED.get(name, {}).get(field.name, 1)
        for field in part.layout.fields
        if field.name not in (*bits, "reserved")
    ]
    return plain + ([sum(getattr(part, bit) << place for place, bit in enumerate(bits))] if bits else [])


@pytest.mark.parametrize("name", BROADCASTS)
def test_every_part_of_a_broadcast_is_what_was_put_in(name: str) -> None:
    vector = VECTORS[name]
    broadcast: Any = registry_of(vector).decode(frame_of(vector)).message
    sent = {part: numbers(part, getattr(broadcast, part)) for part in FIELDS if getattr(broadcast, part) is not None}
    assert sent == {part: vector["fields"][short] for part, short in FIELDS.items() if short in vector["fields"]}
    assert broadcast.flags == vector["sdk_decoded"]["flag"]


def test_a_broadcast_of_the_other_layout_shows_nothing_that_was_not_sent() -> None:
    frame = frame_of(VECTORS["a3_bcast_full"])
    decoded = M100.decode(frame)
    assert (M100.name(decoded), decoded.message) == ("drone.broadcast", Opaque(b"\x02\0", frame.data[2:]))


def test_sticks_sent_as_settings_switch_nothing_on() -> None:
    decoded = M100.decode(frame_of(VECTORS["NEG_osdk_3.3.1_to_4.0.1_vrc_data_bug"]))
    assert isinstance(decoded.message, Opaque)
    assert M100.name(decoded) == "drone.virtual_rc"
