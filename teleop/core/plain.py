"""Text that others have written, in one line that a terminal only prints."""

from __future__ import annotations

import re

# Control characters, ends of lines and paragraphs, changes of the direction of writing, and bytes that are no text.
_ACTS = re.compile("[\x00-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069\ud800-\udfff]")


def plain(text: str) -> str:
    r"""`text` as it is, but what would act on a terminal or end the line is written as in Python: `\x1b`, `\n`."""
    return _ACTS.sub(_written, text)


def _written(found: re.Match[str]) -> str:
    character = found[0]
    if "\udc80" <= character <= "\udcff":  # a byte of a file's name that is no UTF-8
        return f"\\x{ord(character) - 0xDC00:02x}"
    return character.encode("unicode_escape").decode()
