"""Simulated devices: they obey nothing but real frames, over any link."""
