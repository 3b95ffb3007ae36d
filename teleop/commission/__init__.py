"""Commissioning: what a real device is asked, step by step, and what it was found to do. No terminal, no files."""
