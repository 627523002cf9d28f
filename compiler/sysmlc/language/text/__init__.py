"""The textual notations of KerML and SysML v2: text becomes a tree."""

from sysmlc.language.text.parser import parse

__all__ = ["parse"]
