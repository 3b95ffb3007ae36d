"""Takes: what a run did, read back, judged, repeated, and made into keyframes. Nothing here opens a port."""
