"""The published and peer-made frames: each means what its maker's parameters say, and comes out byte for byte again."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from teleop.dji.frame import Frame, FrameReader
from teleop.dji.gimbal.r_sdk import R_SDK

VECTORS = json.loads((Path(__file__).parents[2] / "data" / "r-sdk.json").read_text())["vectors"]


def position(yaw: float, roll: float, pitch: float, seconds: float, **flags: bool) -> tuple[str, dict[str, Any]]:
    usual = {"absolute": True, "yaw_ignored": False, "roll_ignored": False, "pitch_ignored": False}
    return "gimbal.position", {"yaw": yaw, "roll": roll, "pitch": pitch, "time_for_action": seconds, **usual, **flags}


def speed(yaw: float, roll: float, pitch: float, take_over: bool = True, **other: int) -> tuple[str, dict[str, Any]]:
    angles = {"yaw": yaw, "roll": roll, "pitch": pitch}
    return "gimbal.speed", {**angles, "take_over": take_over, "ignore_focal_length": False, **other}


# By the vector's command and parameters. Where a peer clamps or wraps the time, the time is what it sent.
MEANINGS: dict[tuple[str, str], tuple[str, dict[str, Any]]] = {
    ("position", "yaw=32,roll=48,pitch=64,ctrl=0x01,time=20"): position(3.2, 4.8, 6.4, 2.0),
    ("position", "yaw=-50,roll=25,pitch=0,time_ms=300,mode=incremental,invalid=pitch"): position(
        -5.0, 2.5, 0.0, 0.3, absolute=False, pitch_ignored=True
    ),
    ("position", "yaw=1200,roll=0,pitch=-300,time_ms=2000,mode=absolute,invalid=none"): position(120, 0, -30, 2.0),
    ("position", "yaw_deg=180,pitch_deg=146,roll_deg=30,time_ms=25500,mode=absolute"): position(180, 30, 146, 25.5),
    ("position", "yaw_deg=179.9,roll_deg=30,pitch_deg=146,time_s=10"): position(179.9, 30, 146, 10),
    ("position", "yaw_deg=0,roll_deg=0,pitch_deg=-56,time_s=25.5"): position(0, 0, -56, 25.5),
    ("position", "yaw_deg=45,pitch_deg=0,roll_deg=0,time_ms=2000,mode=absolute"): position(45, 0, 0, 2.0),
    ("position", "yaw=32767,roll=-32768,pitch=-32768,time_ms=500,mode=absolute,invalid=none"): position(
        3276.7, -3276.8, -3276.8, 0.5
    ),
    ("position", "yaw=10,roll=0,pitch=-10,time_ms=100,mode=incremental,invalid=none"): position(
        1, 0, -1, 0.1, absolute=False
    ),
    ("position", "yaw=450,roll=0,pitch=0,time_ms=25600,mode=absolute,invalid=none"): position(45, 0, 0, 0.0),
    ("position", "yaw_deg=-45.5,roll_deg=1.2,pitch_deg=-3.4,ctrl=1,time=20"): position(-45.5, 1.2, -3.4, 2.0),
    ("position", "yaw_deg=180,roll_deg=-180,pitch_deg=0,ctrl=1,time=20"): position(180, -180, 0, 2.0),
    ("position", "yaw_deg=12.3,pitch_deg=-4.5,roll_deg=6.7,time_ms=30000,mode=absolute"): position(
        12.3, 6.7, -4.5, 25.5
    ),
    ("position", "yaw=1,roll=-1,pitch=1,time_ms=900,mode=absolute,invalid=none"): position(0.1, -0.1, 0.1, 0.9),
    ("speed", "yaw=3600,roll=-3600,pitch=1,ctrl=0x88"): speed(360, -360, 0.1, ignore_focal_length=True),
    ("speed", "yaw_dps=0,roll_dps=0,pitch_dps=-12.5,ctrl=0x80"): speed(0, 0, -12.5),
    ("speed", "yaw=300,roll=0,pitch=0,peer_default_ctrl"): speed(30, 0, 0, take_over=False, reserved=4),
    ("speed", "yaw=0,roll=0,pitch=0,ctrl=0x80"): speed(0, 0, 0),
    ("speed", "yaw=0,roll=0,pitch=0,ctrl=0x00"): speed(0, 0, 0, take_over=False),
    ("speed", "yaw=0,roll=0,pitch=300,ctrl=0x80"): speed(0, 0, 30),
    ("speed", "yaw_dps=30,pitch_dps=0,roll_dps=0,ctrl=0x80"): speed(30, 0, 0),
    ("get_angle", "data_type=2 (joint)"): ("gimbal.angles", {"kind": "joint"}),
    ("push_enable", "enable=1"): ("gimbal.push_settings", {"switch": "on"}),
    ("set_limits", "pitch_max=145,pitch_min=55,yaw_max=179,yaw_min=179,roll_max=30,roll_min=30"): (
        "gimbal.set_limits",
        {
            "operation": "execute",
            "pitch_max": 145,
            "pitch_min": 55,
            "yaw_max": 179,
            "yaw_min": 179,
            "roll_max": 30,
            "roll_min": 30,
        },
    ),
    ("set_stiffness", "pitch=46,yaw=65,roll=54 (wire order pitch,roll,yaw)"): (
        "gimbal.set_stiffness",
        {"operation": "execute", "pitch": 46, "roll": 54, "yaw": 65},
    ),
    ("camera", "command=0x000b"): ("camera.command", {"command": "end_center_focus"}),
    ("camera", "start rec 0x0003"): ("camera.command", {"command": "record"}),
    ("camera", "command=0x0001"): ("camera.command", {"command": "shutter"}),
    ("camera_1byte", "command=11 (DJI demo packs ONE byte; V2.5 text says uint16)"): (
        "camera.short_command",
        {"command": "end_center_focus"},
    ),
    ("camera_1byte", "command=2 (DJI demo packs ONE byte; V2.5 text says uint16)"): (
        "camera.short_command",
        {"command": "stop_shutter"},
    ),
    ("get_limits", "ctrl=1"): ("gimbal.limits", {"operation": "execute"}),
    ("get_stiffness", "ctrl=1"): ("gimbal.stiffness", {"operation": "execute"}),
    ("get_version", "device_id=1"): ("gimbal.version", {"device": 1}),
    ("joystick", "0,0,0"): ("gimbal.joystick", {"pitch": 0, "roll": 0, "yaw": 0}),
    ("dial", "speed=-2048"): ("gimbal.dial", {"speed": -2048}),
    ("set_user_param", "0x23 motor on (wake)"): (
        "gimbal.set_parameters",
        {"parameters": [{"id": "motor", "value": "00"}]},
    ),
    ("orientation", "portrait +90"): ("gimbal.orientation", {"mode": 0xFE, "orientation": "portrait"}),
    ("follow_mode", "lock"): ("gimbal.mode", {"mode": "lock", "action": "none"}),
    ("autotune_start", "TLV 00 01 01"): ("gimbal.calibrate", {"start": True, "type": 0}),
    ("autotune_stop", "TLV 00 01 00"): ("gimbal.calibrate", {"start": False, "type": 0}),
    ("focus_set", "pos=4095"): ("focus.set", {"control": 0, "position": 4095}),
    ("focus_set", "pos=4096"): ("focus.set", {"control": 0, "position": 4096}),
    ("focus_calib_stop", ""): ("focus.calibrate", {"motor": 0, "action": "stop"}),
    ("focus_get", ""): ("focus.get", {"motor": 0}),
    ("camera_status", "1"): ("camera.status", {"query": "recording"}),
    ("empty_payload", "0E/06 without data"): ("gimbal.stiffness", {"operation": None}),
    ("seq_wrap", "three frames after Seq_Init_Data=0xFFFC (peer goes 0xFFFD -> 0x0003)"): (
        "gimbal.joystick",
        {"pitch": 0, "roll": 0, "yaw": 0},
    ),
}


@pytest.mark.parametrize("vector", VECTORS, ids=lambda vector: f"{vector['command']} {vector['params']}")
def test_published_frames(vector: dict[str, Any]) -> None:
    (frame,) = FrameReader().feed(bytes.fromhex(vector["hex"]), 0.0)
    assert isinstance(frame, Frame)
    assert (frame.cmd_type, frame.sequence) == (vector["cmd_type"], vector["sequence"])
    assert frame.data == bytes((vector["cmd_set"], vector["cmd_id"])) + bytes.fromhex(vector["payload"])
    decoded = R_SDK.decode(frame)
    assert (R_SDK.name(decoded), decoded.message.fields()) == MEANINGS[vector["command"], vector["params"]]
    assert Frame(decoded.message.data(), frame.cmd_type, frame.sequence).encode().hex() == vector["hex"]


def test_every_class_has_its_own_name_and_direction() -> None:
    directions = [(cls.name, reply) for cls in R_SDK.messages for reply in (False, True) if cls.reply in (reply, None)]
    assert len(directions) == len(set(directions))
