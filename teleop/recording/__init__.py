"""Takes: recorded, read back, reported, replayed. Nothing here opens a port."""
