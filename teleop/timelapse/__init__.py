"""A sequence that is shot frame by frame: its schedule, its budget, its journal and its source."""
