"""The output of one compilation: artefacts with their trace, and how they reach the disk."""

import os
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Artefact:
    """One file that a back end makes.

    ``path`` is relative to the output folder, with ``/``; ``trace`` names the elements (ids)
    that the content comes from: an error about one of them withholds the file.
    """

    path: str
    text: str
    trace: tuple[str, ...] = ()
    backend: str = ""


class Output:
    """What the back ends of one compilation have made so far."""

    def __init__(self) -> None:
        self._artefacts: dict[str, Artefact] = {}

    def add(self, path: str, text: str, trace: Iterable[str] = (), backend: str = "") -> None:
        """Add a file. Raises ValueError when the path is taken or leaves the folder."""
        if path.startswith("/") or ".." in path.split("/"):
            raise ValueError(f"output path {path!r} leaves the output folder")
        if path in self._artefacts:
            raise ValueError(f"output path {path!r} is written twice")
        self._artefacts[path] = Artefact(path, text, tuple(dict.fromkeys(trace)), backend)

    def artefacts(self) -> list[Artefact]:
        """All files, sorted by path."""
        return [self._artefacts[path] for path in sorted(self._artefacts)]


def write_if_changed(target: Path, text: str) -> bool:
    """Write UTF-8 text with LF, in one step, if the file differs; say whether it was written."""
    data = text.encode("utf-8")
    if target.is_file() and target.read_bytes() == data:
        return False
    target.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=".sysmlc-")
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(data)
        Path(temporary).chmod(0o644)
        Path(temporary).replace(target)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise
    return True
