"""What changed between two models, whoever wrote them: added, renamed, rewired ..."""

from sysmlc.ir.compare.change import Change, Ref, What
from sysmlc.ir.compare.changes import compare

__all__ = ["Change", "Ref", "What", "compare"]
