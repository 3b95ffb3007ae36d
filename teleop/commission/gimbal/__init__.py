"""The steps with which a real gimbal is commissioned, and the bench on which they do it."""
