"""The files of a reader who follows the documentation, under the names that the pages use."""

import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path

from dialects.enterprise_architect import write_xmi
from dialects.magicdraw import write_mdzip

ROOT = Path(__file__).parents[2]
READER_MODELS = Path(__file__).with_name("reader_models")
LEGO = ROOT / "examples/lego-recipe/lego-recipe.uml"
GATE = ROOT / "examples/baygate-behaviour"

COPIES = {
    "plant.sysml": READER_MODELS / "plant.sysml",
    "plant/plant.sysml": READER_MODELS / "plant.sysml",
    "models/plant.sysml": READER_MODELS / "plant.sysml",
    "cart.gr1.json": READER_MODELS / "cart.gr1.json",
    "line.gr1.json": READER_MODELS / "line.gr1.json",
    "filler.gr1.json": READER_MODELS / "filler.gr1.json",
    "amba.tlsf": READER_MODELS / "amba.tlsf",
    "schemas/plant.xsd": READER_MODELS / "plant.xsd",
    "model.uml": LEGO,
    "recipe.uml": ROOT / "examples/four-tasks/four-tasks.uml",
    "plant.aml": ROOT / "examples/baygate/baygate.aml",
    "gate.uml": ROOT / "examples/baygate/gate.uml",
    "flows.yaml": ROOT / "examples/baygate/baygate.overlay.yaml",
    "hall.sysml": ROOT / "examples/robots/hall.sysml",
    "hall.uml": ROOT / "examples/robots/hall.uml",
    "robots.uml": ROOT / "examples/robots/hall.uml",
    "company.profile.uml": ROOT / "metamodels/sysmlc.profile.uml",
    "profile.profile.uml": ROOT / "metamodels/sysmlc.profile.uml",
    "../profiles/company.profile.uml": ROOT / "metamodels/sysmlc.profile.uml",
    "my-library": ROOT / "metamodels/core",
    "my-templates": ROOT / "templates",
    "examples": ROOT / "examples",
    "benchmarks": ROOT / "benchmarks",
}
"""Files and folders that are copied for every page, and their sources."""

PAGE_COPIES = {
    "docs/map-a-recipe-to-a-plant.md": {"plant.aml": ROOT / "examples/four-tasks/cell.aml"},
    "sysmlc simulate --help": {
        "gate.uml": GATE / "baygate-behaviour.uml",
        "wrong-id.yaml": GATE / "scenarios/gate.yaml",
    },
}
"""Files with another source for some pages."""

CONFIGURATION = '[[model]]\nname = "plant"\nfiles = ["plant.uml"]\n'


def supply_files(page: str, folder: Path, sysmlc: Callable[..., object]) -> None:
    """Create all files in *folder* that the commands of a page refer to.

    *sysmlc* runs the command line in the folder, for those files that are outputs of sysmlc.
    """
    (folder / ".git").mkdir()
    for name, source in (COPIES | PAGE_COPIES.get(page, {})).items():
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        (shutil.copytree if source.is_dir() else shutil.copyfile)(source, target)
    for name in ("plant.mdzip", "model.mdzip", "models/plant.mdzip"):
        (folder / name).write_bytes(write_mdzip(LEGO.read_bytes()))
    (folder / "Plant.xmi").write_bytes(write_xmi(LEGO.read_bytes()))
    _supply_code_blocks(folder)
    sysmlc("plant.sysml", "--emit", "uml,contracts", "-o", "compiled")
    shutil.copyfile(folder / "compiled/uml/plant.uml", folder / "plant.uml")
    shutil.copyfile(
        folder / "compiled/contracts/Plant.Gate.contract.json", folder / "gate.contract.json"
    )
    _supply_recorded_run(folder)
    _supply_old_and_new(folder)
    if page == "sysmlc build --help":
        (folder / "sysmlc.toml").write_text(CONFIGURATION)


def _supply_recorded_run(folder: Path) -> None:
    """Write a run of the gate in which nothing happens."""
    contract = json.loads((folder / "gate.contract.json").read_text("utf-8"))
    first_values = {
        name: "false" if variable["type"] == "bool" else str(variable["type"][0])
        for name, variable in contract["variables"].items()
    }
    rows = (first_values, first_values.values())
    (folder / "monday.csv").write_text("".join(f"{','.join(row)}\n" for row in rows))


def _supply_code_blocks(folder: Path) -> None:
    """Write the scenario and the model that pages show."""
    page = (ROOT / "docs/simulate-a-scenario.md").read_text(encoding="utf-8")
    (folder / "gripper.yaml").write_text(_search(r"<!-- scenario -->\n```yaml\n(.*?)```", page))
    page = (ROOT / "docs/elementary-actions.md").read_text(encoding="utf-8")
    (folder / "cells.sysml").write_text(_search(r"(    package Cells \{\n.*?\n    \}\n)", page))


def _search(pattern: str, text: str) -> str:
    match = re.search(pattern, text, re.DOTALL)
    assert match, pattern
    return match[1]


def _supply_old_and_new(folder: Path) -> None:
    """Write older versions of a plant and of a model, with another name of one element."""
    (folder / "old").mkdir()
    plant = (folder / "plant.aml").read_text(encoding="utf-8")
    (folder / "old/plant.aml").write_text(plant.replace('Name="BayGate"', 'Name="Gate"'))
    model = (folder / "plant.uml").read_text(encoding="utf-8")
    (folder / "new.uml").write_text(model)
    (folder / "old.uml").write_text(model.replace('name="opened"', 'name="isOpen"'))
