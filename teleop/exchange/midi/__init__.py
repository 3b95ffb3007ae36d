"""MIDI controllers: faders, wheels and buttons with feedback."""

from teleop.exchange.midi.server import serve

__all__ = ["serve"]
