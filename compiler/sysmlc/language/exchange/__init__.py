"""Interchange of KerML and SysML v2 models: XMI files and project archives, in and out."""

from sysmlc.language.exchange.files import Files
from sysmlc.language.exchange.projects import Project, Usage, open_archive, project
from sysmlc.language.exchange.reader import read
from sysmlc.language.exchange.references import ExchangeDocument, link
from sysmlc.language.exchange.usages import used
from sysmlc.language.exchange.writer import interchange_path, write

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
