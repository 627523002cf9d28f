"""On what an outcome depends: the tool, the bytes of the inputs, and what was asked for."""

import os
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from hashlib import sha256
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from sysmlc import __version__, resources
from sysmlc.driver import registry
from sysmlc.driver.compilation import Opened, Request
from sysmlc.values import dataclass

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

EMPTY: Mapping[str, str] = {}
_RESOURCES = ("grammars", "metamodels", "templates")


@dataclass(frozen=True, slots=True)
class Dependencies:
    """All that an outcome depends on; ``inputs`` are name, digest and front end of each one.

    ``others`` is a digest of everything else.
    """

    others: str
    inputs: tuple[tuple[str, str, str], ...]

    def key(self, wordings: Mapping[str, str] = EMPTY) -> str:
        """Digest of it all, by file with what its text says instead of its bytes."""
        said = [(name, wordings.get(name, digest), by) for name, digest, by in self.inputs]
        return _digest([self.others, *map(repr, said)])

    def unit(self) -> str:
        """Digest of what it is that was compiled, whatever the inputs say."""
        return _digest(["unit", self.others, *(repr((name, by)) for name, _, by in self.inputs)])


def depends_on(
    opened: Opened, request: Request, wanted: Sequence[str], has_files: bool
) -> Dependencies:
    """What the outcome depends on.

    ``wanted`` is what ``--emit`` says, which is known before a back end is loaded; without
    ``has_files`` the outcome holds the findings only.
    """
    inputs = [(r.source.name, r.source.sha256, r.frontend.name) for r in opened.reading.recognised]
    return Dependencies(_digest(_others(opened, request, wanted, has_files)), tuple(inputs))


@cache
def tool_digest() -> str:
    """Digest of the tool itself, plug-ins included: what changes with each version of it.

    Files that change while a process runs are not what it runs.
    """
    version = f"{__version__} {sys.version} {sys.platform}"
    return _digest([version, *_stamps(_tool_files())])


def _digest(parts: Iterable[str]) -> str:
    text = "".join([f"{len(part)}:{part}" for part in parts])
    return sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def _others(
    opened: Opened, request: Request, wanted: Sequence[str], has_files: bool
) -> Iterator[str]:
    config = request.config
    yield tool_digest()
    yield repr(
        (has_files, tuple(wanted), request.strict_input, request.diagrams, len(config.models))
    )
    yield repr((sorted(config.rules.items()), config.suppress, _sorted(config.passes)))
    if any(found.frontend.name == "sysml" for found in opened.reading.recognised):
        yield from _library(request.library)
    for laid in opened.reading.overlays:
        yield repr((laid.source.name, laid.source.sha256))
    for beside in opened.drawings:
        yield repr((beside.name, beside.sha256))
    for finding in opened.sink:
        yield repr((finding.rule.code, finding.message, finding.subject, opened.root))
    yield from _stamps(_in_folder(request.templates))


def _library(path: str) -> Iterator[str]:
    from sysmlc.language.library import place

    found = place(path or None)
    yield str(found)
    yield from _stamps(_in_folder(found))


def _sorted(value: object) -> object:
    if isinstance(value, dict):
        return sorted((key, _sorted(inner)) for key, inner in value.items())
    return value


def _tool_files() -> Iterator[str]:
    """Our own files and those of plug-ins: who works on them must not see old outcomes."""
    yield from _in_folder(Path(__file__).parents[1])
    for name in _RESOURCES:
        yield from _in_folder(resources.path(name))
    for entry in registry.plug_ins():
        yield from _in_package(entry)


def _in_package(entry: "EntryPoint") -> Iterator[str]:
    spec = find_spec(entry.module.partition(".")[0])
    if spec is not None and spec.origin:
        has_folder = spec.submodule_search_locations is not None
        yield from _in_folder(Path(spec.origin).parent) if has_folder else [spec.origin]


def _in_folder(folder: Path | None) -> Iterator[str]:
    """Files below a folder; ``os.walk`` takes twice as long for hundreds of them."""
    folders = [str(folder)] if folder else []
    for path in folders:
        for entry in _entries(path):
            if not entry.is_dir():
                yield entry.path
            elif entry.name != "__pycache__" and not entry.is_symlink():
                folders.append(entry.path)


def _entries(folder: str) -> "list[os.DirEntry[str]]":
    try:
        return list(os.scandir(folder))
    except OSError:
        return []


def _stamps(files: Iterable[str]) -> list[str]:
    return sorted(map(_stamp, files))


def _stamp(path: str) -> str:
    try:
        stat = os.stat(path)  # noqa: PTH116 - hundreds of files at every start
    except OSError:
        return f"{path} gone"
    return f"{path} {stat.st_size} {stat.st_mtime_ns}"
