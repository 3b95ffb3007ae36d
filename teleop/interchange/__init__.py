"""Files of other programs: a camera's path by the frame, and cues as markers, to them and from them."""
