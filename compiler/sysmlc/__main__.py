"""Entry point of ``python -m sysmlc``, which equals the command ``sysmlc``."""

import os
import sys

# ``python -m`` puts the working folder first: a file typing.py in it, or a folder that looks like
# an installed plug-in, would be imported and run. The command ``sysmlc`` has no such entry. Until
# the entry is removed nothing is imported but os and sys, which are part of the interpreter.
try:
    if sys.path and sys.path[0] == os.getcwd():  # noqa: PTH109 - pathlib is not yet imported
        del sys.path[0]
except FileNotFoundError:
    pass  # The working folder was deleted, so that Python did not add it.

from sysmlc.cli import main

if __name__ == "__main__":
    main()
