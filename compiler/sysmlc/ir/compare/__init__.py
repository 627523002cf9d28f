"""Differences of two models for their authors: added, renamed, rewired ..."""

from sysmlc.ir.compare.change import Change, Ref, What
from sysmlc.ir.compare.changes import compare

__all__ = ["Change", "Ref", "What", "compare"]
