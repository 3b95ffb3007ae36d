"""A rig in hands beyond this process: what comes in by the door, who has control, and what the others see of it."""
