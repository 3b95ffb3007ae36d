"""A pad that the kernel takes for real, read through hidapi's hidraw backend and nothing of ours above it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from uhid import plugged_in
from waiting import wait_until

DEVICES = json.loads((Path(__file__).parents[1] / "data" / "hid.json").read_text())["devices"]
[PAD] = [device for device in DEVICES if device["name"].startswith("Gravis")]
RESTING = bytes.fromhex("7f7f0000")


def found() -> list[bytes]:
    import hidraw

    return [each["path"] for each in hidraw.enumerate(PAD["vendor_id"], PAD["product_id"])]


def read_on(device: Any) -> None:
    """Read beyond what was reported before the end; the kernel keeps 64 reports at most."""
    for _ in range(65):
        device.read(64, 2000)


def test_a_pad_is_found_reports_and_is_gone() -> None:
    with plugged_in(PAD, RESTING) as pad:
        import hidraw

        wait_until(found, "the pad among hidraw's devices")
        device = hidraw.device()
        device.open_path(found()[0])
        assert bytes(device.get_report_descriptor()) == bytes.fromhex(PAD["descriptor"])
        assert bytes(device.read(64, 2000)) == RESTING
        right = b"\xff" + RESTING[1:]
        pad.show(right)
        wait_until(lambda: bytes(device.read(64, 2000)) == right, "the stick to the right")
        pad.unplug()
        with pytest.raises(OSError, match="read error"):
            read_on(device)
        device.close()
        wait_until(lambda: not found(), "the pad gone")
