"""Entry point of ``python -m sysmlc``, which equals the command ``sysmlc``."""

import os
import sys

# ``python -m`` puts the working folder first: a file jinja2.py in it, or a folder that looks like
# an installed plug-in, would be imported and run. The command ``sysmlc`` has no such entry.
if sys.path and sys.path[0] == os.getcwd():  # noqa: PTH109 - pathlib is not yet imported
    del sys.path[0]

from sysmlc.cli import main

if __name__ == "__main__":
    main()
