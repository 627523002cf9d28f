"""The command line: one module a command, no logic; heavy imports inside the commands."""

import gc
import sys
from typing import TYPE_CHECKING, NoReturn

from sysmlc.cli.supervisor import can_supervise, supervise

if TYPE_CHECKING:
    from sysmlc.cli.supervisor import SharedState

_NEW_OBJECTS = 200_000
"""New objects before the garbage collector looks for cycles: a compilation makes hardly any."""


def main() -> None:
    """Run the command ``sysmlc`` in a child process, which ends when it reaches a limit.

    The fork comes before the imports, which would make it slow.
    """
    if can_supervise():
        supervise(_run)
    _run(None)


def _run(shared: "SharedState | None") -> NoReturn:
    """Run the command line in this process, with limits if a parent process shares memory.

    Imports make objects too, so the threshold of the garbage collector is set before them.
    """
    gc.set_threshold(_NEW_OBJECTS)
    from sysmlc.cli.group import main as run
    from sysmlc.cli.limits import LIMITS

    if shared is not None:
        LIMITS.enforce(shared)
    run()
    sys.exit()


__all__ = ["main"]
