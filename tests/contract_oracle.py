"""The oracle of derived contracts: models of the corpus with the answers to temporal properties.

A property speaks of actions, states and parts in the words of the model; the README beside the
models explains the atoms.
"""

import json
import os
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from msgspec import Struct

ORDER = ("broken", "not-decided", "holds-if-actions-end", "holds")
"""The verdicts about a conjunct; that about a formula is the first one of its conjuncts."""


class Property(Struct, frozen=True):
    """A property of a component, and whether it holds."""

    name: str
    ltl: str
    holds: bool
    vacuous: bool
    needs_derived: bool

    @property
    def verdict(self) -> str:
        """The expected verdict."""
        if not self.holds:
            return "broken"
        return "holds-if-actions-end" if self.needs_derived else "holds"


class OracleModel(Struct, frozen=True):
    """A model of the oracle with the expected answers about one of its components."""

    path: Path
    component: str
    unreachable: list[str]
    write_conflicts: list[str]
    properties: tuple[Property, ...]

    @property
    def text(self) -> str:
        """The model as the corpus has it."""
        return self.path.read_text("utf-8")


def list_models(folder: str = "contracts") -> list[OracleModel]:
    """Return the models of the oracle in a folder of the corpus; none without a corpus."""
    models = Path(os.environ.get("SYSMLC_CORPUS", "nowhere")) / folder
    return [_read_model(path) for path in sorted(models.glob("*.expect.json"))]


def _read_model(path: Path) -> OracleModel:
    expectation = json.loads(path.read_text("utf-8"))
    names = Property.__struct_fields__
    return OracleModel(
        path.parent / expectation["model"],
        expectation["component"],
        expectation["unreachable"],
        expectation["write_conflicts"],
        tuple(Property(*(entry[name] for name in names)) for entry in expectation["properties"]),
    )


def require(model: OracleModel) -> str:
    """Return the text of the model with a requirement about its component for each property."""
    subject = f"subject it : {model.component.partition('::')[2]};"
    return _add_members(model.text, _write_requirements(model, "requirement def", subject))


def satisfy(model: OracleModel) -> str:
    """Return the text of the model with a requirement for each property, which it satisfies.

    SysML v1 states the subject of a requirement in this way.
    """
    subject = model.component.partition("::")[2]
    names = " ".join(f"satisfy 'R_{item.name}';" for item in model.properties)
    text, count = re.subn(rf"def {subject}\b[^{{]*{{", rf"\g<0> {names}", model.text, count=1)
    assert count == 1
    return _add_members(text, _write_requirements(model, "requirement", ""))


def group_entries(document: dict) -> dict[str, list[dict]]:
    """Return the entries of a document of ``contracts check`` about each property by its name."""
    entries: dict[str, list[dict]] = {}
    for entry in document["requirements"]:
        entries.setdefault(entry["requirement"].rpartition("::R_")[2], []).append(entry)
    return entries


def combine_verdicts(entries: Iterable[dict]) -> str:
    """Return the verdict about a formula from the entries about its conjuncts."""
    return min((entry["verdict"] for entry in entries), key=ORDER.index)


def _write_requirements(model: OracleModel, keyword: str, subject: str) -> Iterator[str]:
    for item in model.properties:
        constraint = f"require constraint '{item.name}' {{ language \"ltl\" /* {item.ltl} */ }}"
        yield f"    {keyword} 'R_{item.name}' {{ {subject} {constraint} }}"


def _add_members(text: str, lines: Iterable[str]) -> str:
    head, _, _ = text.rstrip().rpartition("}")
    return "\n".join((head.rstrip(), *lines, "}", ""))
