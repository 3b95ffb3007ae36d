"""DFMoco 2.0.0: Dragonframe, or another program, drives the rig as a controller of stepper motors."""

from __future__ import annotations

from teleop.exchange.dfmoco.server import serve

__all__ = ["serve"]
