"""Small test moves that measure a gimbal: its delay, and which way it counts."""
