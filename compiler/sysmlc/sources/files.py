"""Files as sources: one file, or the model entries of one archive."""

import re
from collections.abc import Callable
from pathlib import Path

from sysmlc.sources import package
from sysmlc.sources.archive import entries, is_archive, names
from sysmlc.sources.encoding import in_utf8
from sysmlc.sources.error import SourceError
from sysmlc.sources.limits import DEFAULT_LIMITS, Limits
from sysmlc.sources.source import Source
from sysmlc.sources.whole import read_whole

_MODEL_ENTRY = re.compile(
    r"(^|/)com\.nomagic\.magicdraw\.uml_model(?!____sharepoints).*\.(shared_)?model$"
    r"|\.(uml|xmi|mdxml|aml|caex|sysml|kerml|sysmlx|kermlx)$"
)


_LIBRARY_ENTRY = re.compile(
    r"(^|/)proxy\..*_resource_com\$dnomagic\$dmagicdraw\$duml_umodel\$d(shared_u)?model\$dsnapshot$"
)


_DESCRIPTION_ENTRY = re.compile(r"(^|/)\.(project|meta)\.json$")
"""What a project archive says about itself and its files (KerML 1.0, 10.3)."""


def is_model_entry(name: str) -> bool:
    """Whether an entry of an archive holds model content.

    Of MagicDraw's entries these are the project and its shared parts; diagrams, options and
    the snapshots of used projects are not.
    """
    return _MODEL_ENTRY.search(name) is not None


def is_library_entry(name: str) -> bool:
    """Whether an entry of an archive is a snapshot of what its model takes from elsewhere."""
    return _LIBRARY_ENTRY.search(name) is not None


def is_description_entry(name: str) -> bool:
    """Whether an entry of an archive describes the project that the archive holds."""
    return _DESCRIPTION_ENTRY.search(name) is not None


def is_wanted_entry(name: str) -> bool:
    """Whether an entry of an archive is read: a model, or what is needed to read one."""
    return is_model_entry(name) or _is_beside(name)


def _is_beside(name: str) -> bool:
    return is_library_entry(name) or is_description_entry(name)


def _is_plain_entry(name: str) -> bool:
    """XML at the top of an archive that holds nothing else: a packed export."""
    return name.lower().endswith(".xml") and "/" not in name


def load(
    path: Path,
    name: str,
    wanted: Callable[[str], bool] = is_wanted_entry,
    limits: Limits = DEFAULT_LIMITS,
) -> list[Source]:
    """The file as a source, or the wanted entries when it is an archive (told by content).

    ``name`` is what outputs call it. Raises SourceError.
    """
    source = Source(name, read_whole(path, name, limits))
    if not is_archive(source.data):
        return [in_utf8(source)]
    if package.is_package(name, listed := names(source)):
        package.check(name, listed, entries(source, package.is_relationships, limits))
    found = entries(source, wanted, limits) or entries(source, _is_plain_entry, limits)
    if all(_is_beside(source.name.partition("!")[2]) for source in found):
        raise SourceError("the archive holds no model", name)
    return [in_utf8(source) for source in found]
