"""Takes: recorded, read back, reported, replayed. Nothing here opens a port."""

ENDING = ".mcap"
"""Of a take's file."""
