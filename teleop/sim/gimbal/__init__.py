"""A simulated gimbal with its focus motor and camera."""
