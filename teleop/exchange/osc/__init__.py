"""OSC: commands of buttons and faders, and feedback for them."""

from __future__ import annotations

from teleop.exchange.osc.server import serve

__all__ = ["serve"]
