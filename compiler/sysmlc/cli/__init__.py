"""The command line: one module a command, no logic; heavy imports inside the commands."""

import gc

_NEW_OBJECTS = 200_000
"""New objects before the garbage collector looks for cycles: a compilation makes hardly any."""


def main() -> None:
    """Run the command ``sysmlc``; imports make objects, too, so they come behind."""
    gc.set_threshold(_NEW_OBJECTS)
    from sysmlc.cli.group import main as run

    run()


__all__ = ["main"]
