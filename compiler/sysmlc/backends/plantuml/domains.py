"""Physical things and information look different where they flow (thesis 3.4.1)."""

from collections.abc import Iterable

from sysmlc.ir.query import DOMAINS

# The template gives these PlantUML variables their colours and line styles; a name of the model
# never has a ``$`` that is not escaped.


def styled(arrow: str, domain: str) -> str:
    """The arrow in the style of a domain; one that has a style of its own stays."""
    if domain not in DOMAINS or "[" in arrow:
        return arrow
    for sign in ("-", "."):
        if sign * 2 in arrow:
            return arrow.replace(sign * 2, f"{sign}[${domain}_line]{sign}", 1)
    return arrow


def coloured(row: str, domain: str) -> str:
    """Escaped text in the colour of a domain."""
    return f"<color:${domain}>{row}</color>" if domain in DOMAINS else row


def in_order(found: Iterable[str]) -> tuple[str, ...]:
    """The domains among these, each once, as legends list them."""
    there = set(found)
    return tuple(domain for domain in DOMAINS if domain in there)
