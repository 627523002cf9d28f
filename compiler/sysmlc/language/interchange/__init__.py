"""Interchange of KerML and SysML v2 models: XMI files and project archives.

The module ``writer`` is imported when a file is written, because it needs lxml.
"""

from sysmlc.language.interchange.element_ids import ExchangeDocument, link
from sysmlc.language.interchange.projects import (
    Project,
    ProjectUsage,
    open_archive,
    read_project,
    resolve_usages,
)
from sysmlc.language.interchange.reader import read

__all__ = [
    "ExchangeDocument",
    "Project",
    "ProjectUsage",
    "link",
    "open_archive",
    "read",
    "read_project",
    "resolve_usages",
]
