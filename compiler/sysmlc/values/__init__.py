"""``dataclass`` with the standard library's words and meaning, made in a sixth of its time.

Every value of the project is declared with it and changed with ``replace``; ``field``, ``fields``
and what else there is are the standard library's own. Type checkers see ``dataclasses`` itself.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from dataclasses import dataclass as dataclass
    from dataclasses import replace as replace
else:
    from sysmlc.values.slotted import dataclass as dataclass
    from sysmlc.values.slotted import replace as replace

__all__ = ["dataclass", "replace"]
