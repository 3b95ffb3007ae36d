"""`teleop fleet` and its commands."""
