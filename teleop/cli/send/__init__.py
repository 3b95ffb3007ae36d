"""`teleop send`: one command to a gimbal or a drone, and its reply."""
