"""Timecode: a move follows MIDI timecode or LTC, or starts with it. It is no genlock."""

from teleop.exchange.timecode.server import serve

__all__ = ["serve"]
