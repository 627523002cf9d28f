"""Differences of two models for their authors: added, renamed, rewired ..."""

from sysmlc.ir.compare.changes import compare
from sysmlc.ir.compare.facts import Change, Ref, What

__all__ = ["Change", "Ref", "What", "compare"]
