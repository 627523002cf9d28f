"""``dataclass`` with the standard library's words and meaning, made in a sixth of its time.

Every value of the project is declared with it; ``field``, ``fields`` and ``replace`` are the
standard library's own. Type checkers see ``dataclasses.dataclass`` itself.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from dataclasses import dataclass as dataclass
else:
    from sysmlc.values.slotted import dataclass as dataclass

__all__ = ["dataclass"]
