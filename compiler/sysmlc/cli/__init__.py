"""The command line: one module a command, no logic; heavy imports inside the commands."""

from sysmlc.cli.group import main

__all__ = ["main"]
