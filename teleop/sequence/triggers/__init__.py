"""What may start a move that waits at its start position."""
