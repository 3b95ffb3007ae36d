"""Work that neither the control thread nor the end of the program may wait for: a file on a slow disk."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from threading import Thread


def in_background(work: Callable[[], None], after: Future[None] | None, name: str) -> Future[None]:
    """Call `work`, once `after` is over, in a thread that ends with the program whatever the disk does.

    An executor's thread would be waited for.
    """
    future: Future[None] = Future()

    def run() -> None:
        try:
            if after is not None:
                after.exception()
            work()
        except BaseException as error:  # noqa: BLE001 - whatever it is, the one who asks for the result gets it
            future.set_exception(error)
        else:
            future.set_result(None)

    Thread(target=run, name=name, daemon=True).start()
    return future
