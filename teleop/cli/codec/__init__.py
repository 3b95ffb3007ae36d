"""`teleop decode` and `teleop encode`: bytes to JSON lines and back."""
