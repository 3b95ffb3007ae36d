"""Hostile messages for a rig by Zenoh: bytes that are nothing, JSON that is no command, commands with wrong values,
sticks of foreign sessions, floods, wrong keys. None is a command of one who has control, so nothing may move.
"""

from __future__ import annotations

import json
import random
from typing import Any

import zenoh

KEYS = ("command", "command/load", "command/stop/x", "command/clock", "stick", "state", "event", "alive", "alive/x/y")
VALUES: tuple[Any, ...] = (
    *(None, True, -1, 0, 1e308, 2**63, "", "pan", "a" * 300, "\u0000", "\ud83c", [], [[]], {}, {"pan": "x"}),
    *({"pan": 1e9}, {"pan": None}, {"x": {"y": {"z": {}}}}, "../../etc/passwd", "fleet.stop", ["a"] * 100),
)
DOS = (
    *("stick", "goto", "jog", "play", "start", "alive", "closed", "leave", "message", "preset_store", "take", "x"),
    *("release_control", "clear_keys", "record", "seek", "abort", "focus", "follow", "set_key", "plan", "resume"),
)
FIELDS = (
    "session",
    "name",
    "axes",
    "axis",
    "by",
    "seq",
    "time",
    "move",
    "sent",
    "held",
    "at",
    "text",
    "title",
    "number",
)


def message(rng: random.Random) -> tuple[str, bytes]:
    """A key below the rig's, and what is sent there."""
    key = rng.choice(KEYS)
    kind = rng.random()
    if kind < 0.2:
        return key, rng.randbytes(rng.choice((0, 1, 7, 100, 5000)))
    if kind < 0.3:
        return key, rng.choice(
            (b"[" * 5000, b'{"a":' * 900, b"NaN", b'{"do":NaN}', b'{"do":1e999}', b"\xff{}", b"{}" * 9)
        )
    fields: dict[str, Any] = {"do": rng.choice(DOS), "session": "stranger", "name": "Stranger"}
    if key == "command/load" and rng.random() < 0.5:
        fields = {
            "session": "stranger",
            "name": "x",
            "title": "t",
            "text": rng.choice(("a: [", "keyframes: 1", "x" * 9000)),
        }
    if key == "stick":
        fields |= {"seq": rng.randrange(99), "time": rng.random() * 1e6, "axes": {"pan": rng.uniform(-2, 2)}}
    for _ in range(rng.randrange(4)):
        fields[rng.choice(FIELDS)] = rng.choice(VALUES)
    if rng.random() < 0.1:
        fields.pop(rng.choice(list(fields)))
    return key, json.dumps(fields).encode("utf-8", "surrogatepass")


def send(session: zenoh.Session, rig: str, rng: random.Random, count: int) -> int:
    """Put or ask `count` messages, as fast as they leave; how many were answered."""
    answered = [0]

    def on_reply(_reply: zenoh.Reply) -> None:
        answered[0] += 1

    for _ in range(count):
        key, data = message(rng)
        if rng.random() < 0.5:
            session.put(f"teleop/{rig}/{key}", data, congestion_control=zenoh.CongestionControl.BLOCK)
        else:
            session.get(f"teleop/{rig}/{key}", on_reply, payload=data, timeout=5.0)
    return answered[0]
