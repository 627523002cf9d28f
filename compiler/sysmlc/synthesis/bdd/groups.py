"""What is tied together: groups of names of which none is spoken of with one of another group."""

from collections.abc import Collection, Iterable


def tied(names: Iterable[str], together: Iterable[Collection[str]]) -> list[frozenset[str]]:
    """The names in groups, in the order of their first ones; ``together`` tie those among them."""
    home = {name: name for name in names}

    def head(name: str) -> str:
        while home[name] != name:
            home[name] = name = home[home[name]]
        return name

    for one in together:
        known = [head(name) for name in sorted(one) if name in home]
        for name in known[1:]:
            home[head(name)] = head(known[0])
    found: dict[str, list[str]] = {}
    for name in home:
        found.setdefault(head(name), []).append(name)
    return [frozenset(members) for members in found.values()]
