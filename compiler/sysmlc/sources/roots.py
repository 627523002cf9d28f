"""Which files a reference in a model may reach."""

import os
import re
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import unquote

from msgspec import Struct

_LONGEST = 4096
"""No file system has longer paths; looking for one takes a call for each of its parts."""
_WORKSPACE = re.compile(r"platform:/resource/([^/]+)/(.+)")
_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]+:")


class Roots(Struct, frozen=True):
    """Folders that references may lead into; nothing outside them is ever opened."""

    folders: tuple[Path, ...]

    def resolve(self, base: Path, href: str) -> Path | None:
        """The file that ``href`` in the file ``base`` names, if it is there and allowed.

        Anything with a scheme (http, pathmap) is never followed, but for Eclipse's
        ``platform:/resource/Project/file``: the project is a folder above the file ``base``, or
        beside one. Symbolic links count as where they lead. A path that no file system can
        hold leads nowhere, which ``os.path.isfile`` answers and ``Path.is_file`` raises.
        """
        path = unquote(href.partition("#")[0])
        if not path or len(path) > _LONGEST or "\0" in path:
            return None
        targets = (Path(os.path.realpath(place)) for place in _places(base, path))
        allowed = (target for target in targets if self.allows(target))
        return next((one for one in allowed if os.path.isfile(one)), None)  # noqa: PTH113

    def allows(self, path: Path) -> bool:
        """Whether the real place of the path is inside one of the folders."""
        real = Path(os.path.realpath(path))
        return any(real.is_relative_to(os.path.realpath(folder)) for folder in self.folders)


def _places(base: Path, path: str) -> Iterator[Path]:
    workspace = _WORKSPACE.fullmatch(path)
    if workspace is None:
        if not _SCHEME.match(path):
            yield base.parent / path
        return
    for folder in base.parents:
        if folder.name == workspace[1]:
            yield folder / workspace[2]
        yield folder / workspace[1] / workspace[2]
