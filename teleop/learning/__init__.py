"""What one pass of a move teaches the next: the measured error becomes a correction of the commanded motion."""
