"""Mutated models of every kind that sysmlc reads: XMI, AutomationML, SysML v2 and KerML.

A mutant is determined by its seed and the list of models that it is chosen from.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from random import Random

from lxml import etree

from dialects.magicdraw import write_mdzip, write_xml
from dialects.mutations import damage, mutate
from fuzz.aml_changes import AML_CHANGES
from fuzz.byte_damages import DAMAGES, TEXT_DAMAGES, mutate_archive
from fuzz.interchange_changes import INTERCHANGE_CHANGES
from fuzz.text_changes import mutate_text
from fuzz.xmi_changes import XMI_CHANGES

_EXAMPLES = Path(__file__).parents[2] / "examples"
_AML = (".aml", ".amlx")
_TEXTS = (".sysml", ".kerml", ".xt")
_INTERCHANGE = (".sysmlx", ".kermlx")
SUFFIXES = {
    "xmi": (".uml", ".xml", ".mdxml", ".mdzip", ".xmi"),
    "aml": _AML,
    "v2": (*_TEXTS, *_INTERCHANGE, ".kpar"),
}
"""Suffixes of the files of each kind of model."""
PROJECTS = ("ice-lab", "showcase/*")
"""Folders of the corpus whose texts form one model."""
_RECIPES = sorted(_EXAMPLES.glob("*/*.sysml"))
_PROJECT_SHARE = 0.1
"""Share of projects and recipes among the mutants of SysML v2."""
_DAMAGED_SHARE = 0.12
"""Share of texts whose bytes are damaged too."""
_LEVELS = b"""[recipe.levels]
recipe = "RecipePrimitives::Recipe"
task = "RecipePrimitives::Task"
machine-service = "RecipePrimitives::MachineService"
machine = "ISA95EquipmentHierarchy::ProductionEquipment"
opc-ua-call = "OpcUaBinding::OpcUaMethod"
"""


@dataclass(frozen=True, slots=True)
class Mutant:
    """A mutated model: the name to compile, a description of the changes, and its files."""

    seed: int
    name: str
    description: str
    files: tuple[tuple[str, bytes], ...]


def list_models(
    corpus: Path | None, largest: int, kinds: Sequence[str] = ("xmi", "aml")
) -> list[Path]:
    """Return the examples and the models of *corpus* up to *largest* bytes, projects as folders."""
    suffixes = {suffix for kind in kinds for suffix in SUFFIXES[kind]}
    paths = corpus.rglob("*") if corpus else ()
    corpus_models = [
        path for path in paths if path.suffix in suffixes and path.stat().st_size <= largest
    ]
    if corpus and "v2" in kinds:
        corpus_models += [path for project in PROJECTS for path in corpus.glob(project)]
    kinds_of_examples = {".uml": "xmi", ".sysml": "v2", ".aml": "aml"}
    examples = [
        path
        for path in sorted(_EXAMPLES.glob("*/*"))
        if kinds_of_examples.get(path.suffix) in kinds
    ]
    return [*examples, *sorted(corpus_models)]


def make_mutant(seed: int, models: Sequence[Path]) -> Mutant:
    """Return the mutant of a seed. Small models are chosen more often than large ones."""
    random = Random(seed)
    path = _choose_model(models, random)
    if path.is_dir():
        return _mutate_project(seed, path, random)
    name, description, data = _mutate_file(path, random, models)
    name = f"m{seed}.{name}"
    return Mutant(seed, name, f"{path.name}: {description}", ((name, data),))


def make_unchanged(number: int, path: Path) -> Mutant:
    """Return an unchanged model in the form of a mutant."""
    if path.is_dir():
        texts = sorted(text for text in path.rglob("*") if text.suffix in _TEXTS)
        files = [
            (f"m{number}/{text.relative_to(path).as_posix()}", text.read_bytes()) for text in texts
        ]
        return Mutant(number, f"m{number}", path.name, (("sysmlc.toml", _LEVELS), *files))
    suffix = path.suffix if path.suffix != ".xt" else Path(path.stem).suffix
    name = f"m{number}{suffix}"
    return Mutant(number, name, path.name, ((name, path.read_bytes()),))


def _choose_model(models: Sequence[Path], random: Random) -> Path:
    """Choose a model; projects, whose files depend on one another, and recipes more often."""
    units = [path for path in models if path.is_dir() or path in _RECIPES]
    if units and random.random() < _PROJECT_SHARE:
        return random.choice(units)
    weights = [1 / (20_000 + _read_size(path)) for path in models]
    return random.choices(models, weights)[0]


@cache
def _read_size(path: Path) -> int:
    return path.stat().st_size


def _mutate_file(path: Path, random: Random, models: Sequence[Path]) -> tuple[str, str, bytes]:
    """Return the suffix, the description of the changes, and the content."""
    if path.suffix in _TEXTS:
        language = "kerml" if ".kerml" in path.name else "sysml"
        return language, *_mutate_text_file(path, random, models)
    if path.suffix == ".kpar":
        change = lambda data, dice: _mutate_text(data.decode("utf-8", "replace"), dice)  # noqa: E731
        return "kpar", *mutate_archive(_read_document(path, ""), random, change)
    return _mutate_xml(path, random)


def _mutate_xml(path: Path, random: Random) -> tuple[str, str, bytes]:
    is_example = _EXAMPLES in path.parents and path.suffix == ".uml"
    dialect = random.choice(["uml", "uml", "xml", "mdzip"]) if is_example else path.suffix[1:]
    document = _read_document(path, dialect if is_example else "")
    changes = INTERCHANGE_CHANGES if path.suffix in _INTERCHANGE else None
    changes = AML_CHANGES if path.suffix in _AML else changes
    if dialect in ("mdzip", "amlx"):
        change = lambda data, dice: mutate(data, dice, XMI_CHANGES, DAMAGES, changes)  # noqa: E731
        return dialect, *mutate_archive(document, random, change)
    if _is_well_formed(path):
        return dialect, *mutate(document, random, XMI_CHANGES, DAMAGES, changes)
    return dialect, *damage(document, random, DAMAGES)


def _mutate_text_file(path: Path, random: Random, models: Sequence[Path]) -> tuple[str, bytes]:
    donors = [model for model in models if model.suffix == path.suffix]
    return _mutate_text(_read_text(path), random, _read_text(random.choice(donors or [path])))


def _mutate_text(text: str, random: Random, donor: str = "") -> tuple[str, bytes]:
    description, mutated = mutate_text(text, random, donor)
    data = mutated.encode("utf-8", "replace")
    if not data or random.random() >= _DAMAGED_SHARE:
        return description, data
    damages, data = damage(data, random, TEXT_DAMAGES)
    return f"{description} {damages}", data


def _mutate_project(seed: int, folder: Path, random: Random) -> Mutant:
    """Mutate or remove one or two files of a project."""
    texts = sorted(path for path in folder.rglob("*") if path.suffix in _TEXTS)
    contents = {path: path.read_bytes() for path in texts}
    descriptions = []
    for path in random.sample(texts, min(len(texts), random.choice((1, 1, 2)))):
        if random.random() < 0.05:
            descriptions.append(f"{path.name}: gone")
            del contents[path]
            continue
        description, contents[path] = _mutate_text_file(path, random, texts)
        descriptions.append(f"{path.name}: {description}")
    root = f"m{seed}"
    files = [
        (f"{root}/{path.relative_to(folder).as_posix()}", content)
        for path, content in contents.items()
    ]
    return Mutant(seed, root, "; ".join(descriptions), (("sysmlc.toml", _LEVELS), *files))


@cache
def _read_text(path: Path) -> str:
    return path.read_bytes().decode("utf-8-sig", "replace")


@cache
def _is_well_formed(path: Path) -> bool:
    try:
        etree.parse(path)
    except etree.XMLSyntaxError:
        return False
    return True


@cache
def _read_document(path: Path, dialect: str) -> bytes:
    writer = {"xml": write_xml, "mdzip": write_mdzip}.get(dialect, bytes)
    return writer(path.read_bytes())
