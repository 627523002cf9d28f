"""What is remembered about elements that are no more."""

from collections.abc import Set as AbstractSet

from sysmlc.language.tree import Node


def forget(holder: object, stale: AbstractSet[Node]) -> None:
    """Drop what an object remembers about nodes, alone, together or with something else."""
    for memo in vars(holder).values():
        if isinstance(memo, set):
            memo -= stale
        elif isinstance(memo, dict):
            for key in stale & memo.keys():
                del memo[key]
            for about in [one for one in memo if isinstance(one, tuple)]:
                if not stale.isdisjoint(about):
                    del memo[about]
