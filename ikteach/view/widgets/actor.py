"""Who acts when a control is moved: the loop of the notebook, and nobody else."""

import asyncio
from collections.abc import Callable

LONG = 600  # letters of an error that a person is shown


def in_words(error: Exception) -> str:
    """What went wrong, as the person is told."""
    words = str(error)[:LONG] or type(error).__name__
    return f"That did not work: {words}"


class Actor:
    """Has things done by the loop in which it was made.

    Callbacks of widgets may come on another thread, with a loop of its own; what they ask for is
    handed on. Without a loop, as in a script, it is done at once.
    """

    def __init__(self) -> None:
        try:
            self.loop: asyncio.AbstractEventLoop | None = asyncio.get_running_loop()
        except RuntimeError:
            self.loop = None

    def __call__(
        self, action: Callable[[], object], fail: Callable[[str], None] | None = None
    ) -> None:
        """Do it; with `fail`, tell that in words what went wrong, and go on."""

        def act() -> None:
            try:
                action()
            except Exception as error:
                if fail is None:
                    raise
                fail(in_words(error))

        if self.loop is None or self.loop.is_closed():
            act()
        else:
            self.loop.call_soon_threadsafe(act)
