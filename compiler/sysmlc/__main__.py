"""``python -m sysmlc``: the same as the command ``sysmlc``."""

from sysmlc.cli import main

if __name__ == "__main__":
    main()
