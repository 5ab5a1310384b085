"""Who acts when a control is moved: the loop of the notebook, and nobody else."""

import asyncio
from collections.abc import Callable

LONG = 600  # letters of an error that a person is shown


def message_of(error: Exception) -> str:
    """Put an error into words for a person."""
    words = str(error)[:LONG] or type(error).__name__
    return f"That did not work: {words}"


def attempt(action: Callable[[], object], tell: Callable[[str], object]) -> None:
    """Do it, and tell a person of an error."""
    try:
        action()
    except Exception as error:  # a student's own code may raise anything
        tell(message_of(error))


class Actor:
    """A caller of actions, in the loop where it was made.

    Callbacks of widgets may come on another thread, with a loop of its own; their actions are
    handed on. Without a loop, as in a script, they are done at once.
    """

    def __init__(self) -> None:
        try:
            self.loop: asyncio.AbstractEventLoop | None = asyncio.get_running_loop()
        except RuntimeError:
            self.loop = None

    def __call__(
        self, action: Callable[[], object], fail: Callable[[str], None] | None = None
    ) -> None:
        """Have it done; with `fail`, tell that in words what goes wrong, and go on."""

        def act() -> None:
            action() if fail is None else attempt(action, fail)

        if self.loop is None or self.loop.is_closed():
            act()
        else:
            self.loop.call_soon_threadsafe(act)
