"""Interchange of KerML and SysML v2 models: XMI files and project archives, in and out."""

from sysmlc.language.exchange.projects import Project, Usage, open_archive, project
from sysmlc.language.exchange.reader import read
from sysmlc.language.exchange.references import ExchangeDocument, link
from sysmlc.language.exchange.usages import used

__all__ = [
    "ExchangeDocument",
    "Project",
    "Usage",
    "link",
    "open_archive",
    "project",
    "read",
    "used",
]
