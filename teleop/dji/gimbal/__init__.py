"""The messages of the handheld gimbal (R SDK 2.5)."""
