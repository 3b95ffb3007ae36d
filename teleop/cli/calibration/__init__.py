"""`teleop calibrate delay` and `teleop calibrate signs`."""
