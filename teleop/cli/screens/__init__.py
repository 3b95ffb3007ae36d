"""What the commands show on the terminal: views of runs, tables, folded lines."""
