"""Timed keys to a checked move: segments, the quadratic program, and why a move is infeasible."""
