"""A commissioning of a rig: its link opened, its steps in their order, and the profile written with what was found."""
