"""A sequence file: read, checked, compiled to a move, and played."""
