"""Files as sources: one file, or the model entries of one archive."""

import re
from collections.abc import Callable
from pathlib import Path

from sysmlc.sources.archive import entries, is_archive
from sysmlc.sources.error import SourceError
from sysmlc.sources.limits import DEFAULT_LIMITS, Limits
from sysmlc.sources.source import Source
from sysmlc.sources.whole import read_whole

_MODEL_ENTRY = re.compile(
    r"(^|/)com\.nomagic\.magicdraw\.uml_model(?!____sharepoints).*\.(shared_)?model$"
    r"|\.(uml|xmi|mdxml|aml|caex|sysml|kerml)$"
)


def is_model_entry(name: str) -> bool:
    """Whether an entry of an archive holds model content.

    Of MagicDraw's entries these are the project and its shared parts; diagrams, options and
    the snapshots of used projects are not.
    """
    return _MODEL_ENTRY.search(name) is not None


def load(
    path: Path,
    name: str,
    wanted: Callable[[str], bool] = is_model_entry,
    limits: Limits = DEFAULT_LIMITS,
) -> list[Source]:
    """The file as a source, or the wanted entries when it is an archive (told by content).

    ``name`` is what outputs call it. Raises SourceError.
    """
    source = Source(name, read_whole(path, name, limits))
    if not is_archive(source.data):
        return [source]
    found = entries(source, wanted, limits)
    if not found:
        raise SourceError("the archive holds no model", name)
    return found
