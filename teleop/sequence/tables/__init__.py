"""Tables by the frame in a sequence: match-moves, tracks, moves of other motion-control systems."""
