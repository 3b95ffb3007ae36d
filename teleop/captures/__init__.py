"""Captures: the traffic of a link as a file that other programs read, and what can be learned from one."""
