"""The model libraries that models refer to: where they are, and their files, parsed on demand."""

import os
from collections.abc import Iterable, Mapping
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path

from sysmlc.diagnostics import Sink
from sysmlc.language.text import parse
from sysmlc.language.tree import Document, Node
from sysmlc.sources import Fault, Source, SourceError, is_archive, read_entries
from sysmlc.sources.files import read_whole
from sysmlc.sources.source import DEFAULT_LIMITS
from sysmlc.support import resources

VARIABLE = "SYSML_LIBRARY_PATH"
"""Environment variable: the folder or .kpar of the standard library."""
_MAX_CACHED_FILES = 256
"""Files of libraries that stay in memory."""
_SUFFIXES = {".sysml": "sysml", ".kerml": "kerml"}
SHIPPED = "sysmlc:"
"""Prefix of the names of library files that come with sysmlc."""
_DISTRIBUTION = "sysml"
"""The distribution whose model files are the standard library; they are read as data only."""


class Library:
    """Files of a library and their root members; a file is parsed when a name in it is looked up.

    ``label`` names the library and its origin, for users. ``is_core`` marks the core that is
    bundled with sysmlc, which has only the names that production models use.
    """

    def __init__(
        self, sources: Iterable[Source], *, label: str = "", is_core: bool = False
    ) -> None:
        self._sources = {source.name: source for source in sources}
        self._parsed: dict[str, Document] = {}
        self._loaded: set[str] = set()
        self._searched: set[str] = set()
        self._stems: dict[str, list[str]] = {}
        for path in self._sources:
            self._stems.setdefault(_stem(path), []).append(path)
        self.label = label
        self.is_core = is_core

    def roots(self, name: str) -> list[Node]:
        """Return the root members with that name.

        Files with that name are searched first, then files whose text mentions the name.
        """
        # A library file is mostly named after its package, so most names need one file.
        members = self._find_roots(self._stems.get(name, ()), name)
        return members or self._find_roots(self._paths_mentioning(name), name)

    def names(self) -> list[str]:
        """Return the names of the root members of all files, sorted."""
        documents = map(self._parse, self.paths())
        members = (member for document in documents for member in document.root.members)
        names = {name for member in members for name in (member.name, member.short_name)}
        return sorted(name for name in names if name is not None)

    def packages(self, name: str) -> list[Node]:
        """Return the root members of the files whose text mentions a name."""
        documents = map(self._parse, self._paths_mentioning(name))
        return [member for document in documents for member in document.root.members]

    def document(self, path: str) -> Document:
        """Return one file of the library. Raises KeyError if there is no such file."""
        document = self._parse(path)
        self._loaded.add(path)
        return document

    def paths(self) -> list[str]:
        """Return the names of all files, sorted."""
        return sorted(self._sources)

    def stems(self) -> list[str]:
        """Return the names of all files without folders and suffixes, sorted."""
        return sorted(self._stems)

    def loaded_documents(self) -> list[Document]:
        """Return the documents that the model refers to so far, by path.

        Documents that were searched without success are not among them.
        """
        return [self._parsed[path] for path in sorted(self._loaded)]

    def clear_targets(self) -> None:
        """Remove what references were resolved to, so that another model can use the library.

        A model may have a package of the same name as one of the library, and names in the library
        then lead to that package.
        """
        for path in self._searched:
            for node in self._parsed[path].root.walk():
                for relation in node.relations:
                    relation.reference.clear_targets()
        self._loaded.clear()
        self._searched.clear()

    def _parse(self, path: str) -> Document:
        document = self._parsed.get(path)
        if document is None:
            source = self._sources[path]
            text = source.data.decode("utf-8-sig", "replace")
            document = parse(text, path, _SUFFIXES[_suffix(path)], Sink(), source)
            self._parsed[path] = document
        self._searched.add(path)
        return document

    def _find_roots(self, paths: Iterable[str], name: str) -> list[Node]:
        roots: list[Node] = []
        for path in paths:
            members = self._parse(path).root.members
            matching = [member for member in members if name in (member.name, member.short_name)]
            if matching:
                self._loaded.add(path)
                roots += matching
        return roots

    def _paths_mentioning(self, name: str) -> list[str]:
        """Return the files whose text has the name; all files for a name that texts escape."""
        # Texts may write such a name with escapes, so its bytes are not in them.
        if not name.isprintable() or "'" in name or "\\" in name:
            return self.paths()
        return [path for path in self.paths() if name.encode() in self._sources[path].data]


def _stem(path: str) -> str:
    return path.rpartition("/")[2].rpartition("!")[2].rpartition(".")[0]


def _suffix(path: str) -> str:
    return path[path.rfind(".") :]


def find_library(
    path: str | Path | None = None, environment: Mapping[str, str] = os.environ
) -> Library:
    """Return the library at ``path``, else that of the environment, the installed one, or the core.

    ``path`` is a folder with .sysml and .kerml files, a folder of .kpar archives or one .kpar. Some
    wheels of the distribution come without model files (Linux on ARM, musl): they count as not
    installed. Raises SourceError if the requested library is missing or has no model files.
    """
    requested = requested_path(path, environment)
    if requested:
        sources = _read_sources(Path(requested))
        if not sources:
            raise SourceError("has no .sysml or .kerml files", requested, fault=Fault.MISSING)
        origin = "--library" if path else VARIABLE
        return _reuse_library(tuple(sources), f"{requested} ({origin})")
    installed = _find_installed()
    if installed is not None:
        return _reuse_library(tuple(_read_sources(installed)), _label_of_installed(installed))
    return load_core()


def requested_path(path: str | Path | None, environment: Mapping[str, str] = os.environ) -> str:
    """Return the folder or archive that an option, else the environment names; empty for none."""
    return str(path) if path else environment.get(VARIABLE, "")


def find_library_path(
    path: str | Path | None, environment: Mapping[str, str] = os.environ
) -> Path | None:
    """Return the folder or archive that ``find_library`` reads, or None for the core."""
    requested = requested_path(path, environment)
    return Path(requested) if requested else _find_installed()


def load_core() -> Library:
    """Return the core library that is bundled with sysmlc."""
    sources = _read_sources(resources.path("metamodels", "core"))
    return _reuse_library(tuple(sources), "core of sysmlc (bundled)", is_core=True)


def _reuse_library(sources: tuple[Source, ...], label: str, *, is_core: bool = False) -> Library:
    """Return the library of these files, with the documents that this process has parsed."""
    library = _make_library(sources, label, is_core)
    library.clear_targets()
    return library


@lru_cache(maxsize=4)
def _make_library(sources: tuple[Source, ...], label: str, is_core: bool) -> Library:
    return Library(sources, label=label, is_core=is_core)


def _find_installed() -> Path | None:
    """Return the folder of model files of the installed distribution, which is not imported."""

    try:
        spec = find_spec(_DISTRIBUTION)
    except (ImportError, ValueError):
        return None
    if spec:
        for folder in spec.submodule_search_locations or ():
            models = Path(folder) / "stdlib"
            if models.is_dir():
                return models
    return None


def _label_of_installed(models: Path) -> str:
    """Return name and version of the distribution, from the name of its metadata folder."""
    folders = models.parents[1].glob(f"{_DISTRIBUTION}-*.dist-info")
    version = next((folder.stem.partition("-")[2] for folder in folders), "of unknown version")
    return f"{_DISTRIBUTION} {version} (installed)"


def _read_sources(path: Path) -> list[Source]:
    """Return the model files of a folder or archive, named relative to it. Raises SourceError."""
    if path.is_dir():
        return _read_folder(path)
    source = Source(path.name, read_whole(path, str(path), DEFAULT_LIMITS))
    if is_archive(source.data):
        return read_entries(source, _is_model)
    return [source] if _is_model(path.name) else []


def _read_folder(folder: Path) -> list[Source]:
    sources: list[Source] = []
    for parent, _, files in os.walk(folder):
        for file in files:
            suffix = _suffix(file)
            if suffix in _SUFFIXES or suffix == ".kpar":
                path = Path(parent) / file
                name = path.relative_to(folder).as_posix()
                source = _read_source(path, name)
                sources += read_entries(source, _is_model) if suffix == ".kpar" else [source]
    return sorted(sources, key=lambda source: source.name)


def _read_source(path: Path, name: str) -> Source:
    try:
        status = path.stat()
    except OSError as problem:
        raise SourceError(problem.strerror or "not there", str(path), fault=Fault.MISSING) from None
    return _read_unchanged(path, name, status.st_size, status.st_mtime_ns)


@lru_cache(_MAX_CACHED_FILES)
def _read_unchanged(path: Path, name: str, _size: int, _changed: int) -> Source:
    """Read a file; the result is cached until its size or modification time changes."""
    return Source(name, read_whole(path, name, DEFAULT_LIMITS))


def _is_model(name: str) -> bool:
    return _suffix(name) in _SUFFIXES
