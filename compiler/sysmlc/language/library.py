"""The model libraries that a model refers to: where they are, and their files, read when needed."""

import json
import os
from collections.abc import Iterable, Mapping
from functools import lru_cache
from pathlib import Path

from sysmlc.cache import Cache
from sysmlc.diagnostics import Sink
from sysmlc.language.stored import read
from sysmlc.language.tree import Document, Node
from sysmlc.sources import Fault, Source, SourceError, entries, is_archive

VARIABLE = "SYSML_LIBRARY_PATH"
"""Environment variable: the folder or .kpar of the standard library."""
_REMEMBERED = 256
"""Files of libraries that are kept in memory."""
_SUFFIXES = {".sysml": "sysml", ".kerml": "kerml"}
_DISTRIBUTION = "sysml"
"""The distribution whose model files are the standard library; they are read as data only."""


class Library:
    """Files of a library and their root members, each file read when a name of it is asked for.

    ``label`` names the library and how it was found, for users. ``is_core`` marks the core that is
    bundled with sysmlc, which has only the names that production models use.
    """

    def __init__(
        self,
        sources: Iterable[Source],
        cache: Cache | None = None,
        *,
        label: str = "",
        is_core: bool = False,
    ) -> None:
        self._sources = {source.name: source for source in sources}
        self._cache = cache
        self._documents: dict[str, Document] = {}
        self._indexing: dict[str, Document] = {}
        self._speaking: dict[str, list[str]] = {}
        self._stems: dict[str, list[str]] = {}
        for path in self._sources:
            self._stems.setdefault(_stem(path), []).append(path)
        self._index: dict[str, list[str]] | None = None
        self.label = label
        self.is_core = is_core

    def roots(self, name: str) -> list[Node]:
        """Root members with that name: a file named like it is asked first, then the index."""
        found = self._named(self._stems.get(name, ()), name)
        if found or not self._sources:
            return found
        if self._index is None:
            self._index = self._indexed()
        return self._named(self._index.get(name, ()), name)

    def names(self) -> list[str]:
        """The names of the root members of all files, sorted."""
        if self._index is None:
            self._index = self._indexed()
        return sorted(self._index)

    def packages(self, name: str) -> list[Node]:
        """The root members of the files whose text has a name, whether they were read or not."""
        known = self._speaking.get(name)
        if known is None:
            said = name.encode()
            known = [path for path in self.paths() if said in self._sources[path].data]
            self._speaking[name] = known
        for path in known:
            self._indexing[path] = self._read(path)
        return [member for path in known for member in self._indexing[path].root.members]

    def is_same(self, other: "Library") -> bool:
        """Whether the files of both say the same."""
        return self.is_core is other.is_core and self._sources == other._sources

    def _named(self, paths: Iterable[str], name: str) -> list[Node]:
        members = (member for path in paths for member in self.document(path).root.members)
        return [member for member in members if name in (member.name, member.short)]

    def document(self, path: str) -> Document:
        """One file of the library. Raises KeyError for one that it has not."""
        document = self._documents.get(path)
        if document is None:
            document = self._documents[path] = self._read(path)
        return document

    def _read(self, path: str) -> Document:
        document = self._documents.get(path) or self._indexing.get(path)
        if document is None:
            source = self._sources[path]
            document = read(source, path, _SUFFIXES[_suffix(path)], Sink(), self._cache)
        return document

    def paths(self) -> list[str]:
        """Names of all files, sorted."""
        return sorted(self._sources)

    def loaded(self) -> list[Document]:
        """The documents that were asked for so far, by path.

        Those that only the index was made of are not among them: it may have come from the cache.
        """
        return [self._documents[path] for path in sorted(self._documents)]

    def _indexed(self) -> dict[str, list[str]]:
        """Which files have which root members; kept in the cache under the files' digests."""
        key = f"{self._digest()}-library-names" if self._cache else ""
        kept = self._cache.get(key) if self._cache else None
        if kept is not None:
            return _index_of(kept)
        index: dict[str, list[str]] = {}
        for path in self.paths():
            document = self._indexing[path] = self._read(path)
            for member in document.root.members:
                for name in {member.name, member.short} - {None}:
                    index.setdefault(str(name), []).append(path)
        if self._cache:
            self._cache.put(key, json.dumps(index, sort_keys=True).encode())
        return index

    def _digest(self) -> str:
        from hashlib import sha256

        parts = [f"{path} {self._sources[path].sha256}" for path in self.paths()]
        return sha256("\n".join(parts).encode()).hexdigest()


def _index_of(kept: bytes) -> dict[str, list[str]]:
    index: dict[str, list[str]] = json.loads(kept)
    return index


def _stem(path: str) -> str:
    return path.rpartition("/")[2].rpartition("!")[2].rpartition(".")[0]


def _suffix(path: str) -> str:
    return path[path.rfind(".") :]


def find(
    path: str | Path | None = None,
    environment: Mapping[str, str] = os.environ,
    cache: Cache | None = None,
) -> Library:
    """The library at ``path``, else of the environment, of the installed distribution, our own.

    ``path`` is a folder with .sysml and .kerml files, a folder of .kpar archives or one .kpar.
    Some wheels of the distribution come without model files (Linux on ARM, musl): they count as
    not installed. Raises SourceError when the library that was asked for is missing or has no
    model files.
    """
    asked = asked_for(path, environment)
    if asked:
        sources = _read(Path(asked))
        if not sources:
            raise SourceError("has no .sysml or .kerml files", asked, fault=Fault.MISSING)
        return Library(sources, cache, label=f"{asked} ({'--library' if path else VARIABLE})")
    installed = _installed()
    if installed is not None:
        return Library(_read(installed), cache, label=_label_of_installed(installed))
    return core(cache)


def asked_for(path: str | Path | None, environment: Mapping[str, str] = os.environ) -> str:
    """The folder or archive that an option, else the environment names; empty for none."""
    return str(path) if path else environment.get(VARIABLE, "")


def place(path: str | Path | None, environment: Mapping[str, str] = os.environ) -> Path | None:
    """The folder or archive that ``find`` reads; None for the small library of our own."""
    asked = asked_for(path, environment)
    return Path(asked) if asked else _installed()


def core(cache: Cache | None = None) -> Library:
    """The core that is bundled with sysmlc."""
    from sysmlc import resources

    files = _read(resources.path("metamodels", "core"))
    return Library(files, cache, label="core of sysmlc (bundled)", is_core=True)


def _installed() -> Path | None:
    """The folder of model files of the installed distribution, which is not imported."""
    from importlib.util import find_spec

    try:
        spec = find_spec(_DISTRIBUTION)
    except (ImportError, ValueError):
        return None
    for folder in (spec.submodule_search_locations or ()) if spec else ():
        models = Path(folder) / "stdlib"
        if models.is_dir():
            return models
    return None


def _label_of_installed(models: Path) -> str:
    """Return name and version of the distribution, which the name of its metadata folder has."""
    folders = models.parents[1].glob(f"{_DISTRIBUTION}-*.dist-info")
    version = next((folder.stem.partition("-")[2] for folder in folders), "of unknown version")
    return f"{_DISTRIBUTION} {version} (installed)"


def _read(path: Path) -> list[Source]:
    """The model files of a folder or archive, named relative to it. Raises SourceError."""
    try:
        if path.is_dir():
            return _of_folder(path)
        source = Source(path.name, path.read_bytes())
    except OSError as problem:
        raise SourceError(problem.strerror or "not there", str(path), fault=Fault.MISSING) from None
    if is_archive(source.data):
        return entries(source, _is_model)
    return [source] if _is_model(path.name) else []


def _of_folder(folder: Path) -> list[Source]:
    found: list[Source] = []
    for below, _, files in os.walk(folder):
        for file in files:
            suffix = _suffix(file)
            if suffix in _SUFFIXES or suffix == ".kpar":
                path = Path(below) / file
                name = path.relative_to(folder).as_posix()
                source = _source(path, name)
                found += entries(source, _is_model) if suffix == ".kpar" else [source]
    return sorted(found, key=lambda source: source.name)


def _source(path: Path, name: str) -> Source:
    told = path.stat()
    return _kept(path, name, told.st_size, told.st_mtime_ns)


@lru_cache(_REMEMBERED)
def _kept(path: Path, name: str, _size: int, _changed: int) -> Source:
    """The file as it was changed last: a process that compiles again need not read it."""
    return Source(name, path.read_bytes())


def _is_model(name: str) -> bool:
    return _suffix(name) in _SUFFIXES
