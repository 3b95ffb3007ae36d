"""Findings made by hand."""

from __future__ import annotations

from dataclasses import replace

from teleop.commission.findings import Findings, Subject

SIGN = Subject("sign.speed.pan", "Sign of pan in speed commands (0E 01)", 1)
LAG = Subject("speed.lag.pan", "Lag of pan", None, "s")
COMMAND = Subject("reply.command", "Replies have command set and id", True)
FOCUS = Subject("focus.present", "A focus motor answers <0E 12>", True)
LIMIT = Subject("limits.pitch_max", "Limit of the gimbal: pitch max", 145.0, "deg")

FOUND = replace(
    Findings(
        "DJI RS 3 Pro",
        model="RS 3 Pro",
        firmware="03.01.00.10",
        adapter="slcan:/dev/ttyACM0",
        program="0.2.0",
        date="2026-11-29",
        serials={"gimbal": "0M6CH7R0A1B2C3"},
    ),
    facts=(
        replace(COMMAND.found(True, "26 bytes"), step="replies"),
        replace(SIGN.found(-1, "measured"), step="speed-pan"),
        replace(LAG.found(0.08, "estimated"), step="speed-pan"),
        replace(FOCUS.not_seen("skipped"), step="focus"),
        replace(LIMIT.found(145.0, "asked"), step="settings"),
    ),
)
UPDATED = replace(FOUND, firmware="04.00.00.00", serials={}).with_facts(
    [
        replace(SIGN.found(1, "measured"), step="speed-pan"),
        replace(LAG.found(0.083, "estimated"), step="speed-pan"),
        replace(FOCUS.found(True, "asked"), step="focus"),
        replace(LIMIT.not_seen("no answer"), step="settings"),
    ]
)
