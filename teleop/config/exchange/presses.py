"""What a press of a button may ask for, whatever protocol the button speaks."""

from __future__ import annotations

PRESSES = (
    *("clear", "record", "stop_recording", "shutter", "pause", "resume", "abort", "recenter"),
    *("set_key", "clear_keys", "next_key", "previous_key", "to_start"),
)
"""Commands of the door that need nothing but a press; STOP is one of its own."""
