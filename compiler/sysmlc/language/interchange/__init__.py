"""Interchange of KerML and SysML v2 models: XMI files and project archives, in and out."""

from sysmlc.language.interchange.projects import Project, Usage, open_archive, project, used
from sysmlc.language.interchange.reader import read
from sysmlc.language.interchange.references import ExchangeDocument, link
from sysmlc.language.interchange.writer import Files, interchange_path, write

__all__ = [
    "ExchangeDocument",
    "Files",
    "Project",
    "Usage",
    "interchange_path",
    "link",
    "open_archive",
    "project",
    "read",
    "used",
    "write",
]
