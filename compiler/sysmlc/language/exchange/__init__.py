"""Interchange of KerML and SysML v2 models: XMI files and project archives, in and out."""

from sysmlc.language.exchange.reader import read
from sysmlc.language.exchange.references import ExchangeDocument, link

__all__ = ["ExchangeDocument", "link", "read"]
