"""What compares commanded with measured motion while a rig runs."""
