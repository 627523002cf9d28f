"""The back end ``spot``: contracts as formulas for Spot, with ltlsynt's --part-file beside."""

from sysmlc.backends.forms import FormBackend


def _split(text: str) -> dict[str, str]:
    formula, _, parts = text.partition("\n")
    return {".spot.ltl": f"{formula}\n", ".spot.part": parts}


BACKEND = FormBackend(
    "spot", "contracts for Spot (.spot.ltl, .spot.part)", (("spot", ".spot.ltl"),), _split
)
