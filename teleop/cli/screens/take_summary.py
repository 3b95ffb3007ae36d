"""The take that is being written, in a few words for the title of a view."""

from __future__ import annotations

from collections.abc import Callable

from teleop.recording.writer import Recorder

FAILS = "TAKE FAILED"


def take_words(recorder: Recorder | None) -> Callable[[], str]:
    """`take 12.3 s`, or that it fails; "" where none is written. May be asked at any time, from any thread."""

    def words() -> str:
        if recorder is None:
            return ""
        return FAILS if recorder.trouble else f"take {recorder.seconds:.1f} s"

    return words
