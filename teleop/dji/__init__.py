"""The DJI frame, and messages declared by annotations. No I/O, no clock."""
