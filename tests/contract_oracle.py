"""The oracle of derived contracts: models of the corpus with the answers to temporal properties.

A property speaks of actions, states and parts in the words of the model; the README beside the
models explains the atoms.
"""

import json
import os
from collections.abc import Mapping
from pathlib import Path

from msgspec import Struct


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


def list_models() -> list[OracleModel]:
    """Return the models of the oracle; none without a corpus."""
    folder = Path(os.environ.get("SYSMLC_CORPUS", "nowhere")) / "contracts"
    return [_read_model(path) for path in sorted(folder.glob("*.expect.json"))]


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
