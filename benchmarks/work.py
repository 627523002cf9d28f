"""What is measured in a process of its own: its CPU time, its memory, and the parsers beside it.

A script of works is called ``python SCRIPT WORK FILE [ARGUMENT...]`` and prints CPU seconds
(user and system) of the work itself, start-up aside, the growth of the resident memory to its
peak in bytes, and the bytes of XML that were read, as JSON.
"""

import json
import resource
import sys
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path

_KILOBYTE = 1024


class Measured:
    """CPU time and memory from its making on."""

    def __init__(self) -> None:
        self._start = time.process_time()
        self._memory = _peak()
        self.times: dict[str, float] = {}

    def lap(self, name: str) -> None:
        """Note the CPU time since the last lap."""
        now = time.process_time()
        self.times[name] = now - self._start
        self._start = now

    def memory(self) -> int:
        """Growth of the peak of the resident memory so far."""
        return _peak() - self._memory


Work = Callable[..., tuple[Measured, int]]
"""Does something with a file: what was measured, and the bytes of XML."""


def _peak() -> int:
    """Peak of the resident memory of this program; ``getrusage`` begins with that of its parent."""
    with suppress(OSError):
        lines = Path("/proc/self/status").read_text().splitlines()
        found = next((line for line in lines if line.startswith("VmHWM:")), "")
        if found:
            return int(found.split()[1]) * _KILOBYTE
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * _KILOBYTE


def lxml(path: Path, *_arguments: str) -> tuple[Measured, int]:
    """A tree of the whole file, and nothing done with it."""
    from lxml import etree

    measured = Measured()
    tree = etree.parse(str(path), etree.XMLParser(huge_tree=True))
    measured.lap("lxml")
    return measured, path.stat().st_size if tree is not None else 0


def expat(path: Path, *_arguments: str) -> tuple[Measured, int]:
    """The parser below ours, without handlers: the least that any reader needs."""
    from xml.parsers.expat import ParserCreate

    measured = Measured()
    ParserCreate(namespace_separator="}").Parse(path.read_bytes(), True)
    measured.lap("expat")
    return measured, path.stat().st_size


def run(works: Mapping[str, Work]) -> int:
    """Do the work that the command line names, once."""
    name, path, *arguments = sys.argv[1:]
    measured, size = works[name](Path(path), *arguments)
    json.dump({"times": measured.times, "memory": measured.memory(), "size": size}, sys.stdout)
    return 0
