"""The steps with which a real drone is commissioned, propellers off, and the bench on which they do it."""
