"""The oracle of derived contracts: models of the corpus with the answers to temporal properties.

A property speaks of actions and states in the words of the model. ``translate`` writes it with the
variables of the component's contract; the README beside the models explains the atoms.
"""

import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from msgspec import Struct

_ATOM = re.compile(r"(?P<kind>running|finished)\((?P<path>[\w.]+)\)|(?P<region>\w+)\.state\b")


class Property(Struct, frozen=True):
    """A property of a component, and whether it holds."""

    name: str
    ltl: str
    holds: bool
    needs_derived: bool


class OracleModel(Struct, frozen=True):
    """A model of the oracle with the expected answers about one of its components."""

    path: Path
    component: str
    properties: tuple[Property, ...]

    @property
    def text(self) -> str:
        """The model as the corpus has it."""
        return self.path.read_text("utf-8")


def list_models() -> list[OracleModel]:
    """Return the models of the oracle; none without a corpus."""
    folder = Path(os.environ.get("SYSMLC_CORPUS", "nowhere")) / "contracts"
    return [_read_model(path) for path in sorted(folder.glob("*.expect.json"))]


def _read_model(path: Path) -> OracleModel:
    expectation = json.loads(path.read_text("utf-8"))
    properties = (
        Property(entry["name"], entry["ltl"], entry["holds"], entry["needs_derived"])
        for entry in expectation["properties"]
    )
    return OracleModel(
        path.parent / expectation["model"], expectation["component"], tuple(properties)
    )


def require(model: OracleModel, formulas: Mapping[str, str]) -> str:
    """Return the text of the model with one requirement for each named formula."""
    subject = model.component.partition("::")[2]
    lines = (
        f"    requirement def R_{name} {{ subject it : {subject}; require constraint {name} "
        f'{{ language "ltl" /* {formula} */ }} }}'
        for name, formula in formulas.items()
    )
    head, _, _ = model.text.rstrip().rpartition("}")
    return "\n".join((head.rstrip(), *lines, "}", ""))


def translate(ltl: str, variables: Iterable[str]) -> str:
    """Write a property with the variables of a contract; an atom without a variable stays."""
    names = list(variables)
    return _ATOM.sub(lambda match: _translate_atom(match, names), ltl)


def _translate_atom(match: re.Match[str], names: list[str]) -> str:
    region = match["region"]
    if region:
        is_region = f"{region}_state" in names
        return f"{region}_state" if is_region else _name_machine(match[0], names)
    action = match["path"].rpartition(".")[2]
    started = [f"{prefix}_{action}" for prefix in ("run", "do") if f"{prefix}_{action}" in names]
    if "." in match["path"] or not started:
        return _translate_whole(match, names)
    return started[0] if match["kind"] == "running" else f"({started[0]} & done_{action})"


def _name_machine(atom: str, names: list[str]) -> str:
    """Return ``state`` for the machine whose contract the component has, else the atom."""
    return "state" if atom == "Heater.state" and "state" in names else atom


def _translate_whole(match: re.Match[str], names: list[str]) -> str:
    """Return the end of the activity itself: a token reaches its final node."""
    performed = {"cycle", "pickPlace", "pack", "work", "job"}
    if match["kind"] == "running" or match["path"] not in performed:
        return match[0]
    return f"({' | '.join(_list_final_tokens(names))})"


def _list_final_tokens(names: list[str]) -> Iterator[str]:
    return (name for name in names if name.startswith("at_") and name.endswith("_to_done"))
