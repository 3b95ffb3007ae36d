"""What `teleop play` does with a timelapse: its options, its summary and the shoot."""
