"""The command line: one module for each command, which imports what it needs when it runs."""

import gc
import signal
import sys
from typing import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from sysmlc.cli.supervisor import SharedState

_NEW_OBJECTS = 200_000
"""New objects that start the garbage collector; a compilation creates hardly any cycles."""


def main() -> None:
    """Run the command ``sysmlc`` in a child process, which ends when it reaches a limit."""
    # While modules are imported, Ctrl-C ends the process like any other program, without a
    # traceback. The commands handle it afterwards. A process that ignores it goes on to do so.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from sysmlc.cli.supervisor import can_supervise, supervise

    # The fork comes before the imports: forking a large process takes longer.
    if can_supervise():
        supervise(_run)
    _run(None)


def _run(shared: "SharedState | None") -> NoReturn:
    """Run the command line in this process, with limits if a parent process shares memory."""
    # Set before the imports, which create objects too.
    gc.set_threshold(_NEW_OBJECTS)
    from sysmlc.cli.group import main as run
    from sysmlc.cli.limits import LIMITS

    if shared is not None:
        LIMITS.enforce(shared)
    run()
    sys.exit()


__all__ = ["main"]
