"""What is wrong with a trigger as it is written."""

from __future__ import annotations


class WrittenError(ValueError):
    """What stands after a trigger's kind is not what that needs; the text says what would be right."""
