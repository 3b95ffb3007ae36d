"""What a performance looks like: a page, a drawing, a table. Nothing here opens a port or moves anything."""
