"""Interchange of KerML and SysML v2 models: XMI files and project archives, in and out."""

from sysmlc.language.interchange.element_ids import ExchangeDocument, link
from sysmlc.language.interchange.projects import (
    Project,
    ProjectUsage,
    open_archive,
    read_project,
    resolve_usages,
)
from sysmlc.language.interchange.reader import read
from sysmlc.language.interchange.writer import InterchangeFiles, interchange_path, write

__all__ = [
    "ExchangeDocument",
    "InterchangeFiles",
    "Project",
    "ProjectUsage",
    "interchange_path",
    "link",
    "open_archive",
    "read",
    "read_project",
    "resolve_usages",
    "write",
]
