"""A glance at what is installed: ``importlib.metadata`` takes ten times as long to import."""

import os
import sys
from importlib.machinery import PathFinder

_FOLDERS = (".dist-info", ".egg-info")
_OURS = "sysmlc-"


def may_be_named(group: str) -> bool:
    """Whether a distribution other than ours may have entry points of this group.

    No is certain. Where distributions may be found in ways that are not looked at here (zip files,
    eggs, finders of their own), the answer is yes.
    """
    if any(hasattr(one, "find_distributions") and one is not PathFinder for one in sys.meta_path):
        return True
    sign = group.encode()
    return any(_may_name(sign, folder) for folder in dict.fromkeys(sys.path))


def _may_name(sign: bytes, folder: str) -> bool:
    if folder.lower().endswith(".egg"):
        return True
    try:
        names = os.listdir(folder or ".")  # noqa: PTH208 - a Path for each name costs as much again
    except FileNotFoundError:
        return False
    except OSError:
        return True
    others = (name for name in names if name.lower().endswith(_FOLDERS))
    return any(sign in _text(folder, name) for name in others if not name.startswith(_OURS))


def _text(folder: str, name: str) -> bytes:
    try:
        with open(os.path.join(folder, name, "entry_points.txt"), "rb") as stream:  # noqa: PTH118, PTH123
            return stream.read()
    except OSError:
        return b""
