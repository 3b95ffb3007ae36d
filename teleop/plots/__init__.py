"""Pages, pictures and tables of moves and takes. Nothing here opens a port or moves anything."""
