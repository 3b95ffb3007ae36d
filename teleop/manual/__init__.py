"""A rig moved by hand: which input may move what, and how a stick becomes a velocity."""
