"""YAML text to checked objects, with the place of every mistake."""
