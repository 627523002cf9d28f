"""Spoilt models of every kind that sysmlc reads: XMI, AutomationML, SysML v2 and KerML.

A mutant is the number that seeds it: among the same models the same number makes it again.
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
from fuzz.changes import CHANGES
from fuzz.damages import DAMAGES, TEXT_DAMAGES, mutate_archive
from fuzz.exchange_changes import EXCHANGE_CHANGES
from fuzz.text_changes import mutate_text

_EXAMPLES = Path(__file__).parents[2] / "examples"
_AML = (".aml", ".amlx")
_TEXTS = (".sysml", ".kerml", ".xt")
_EXCHANGED = (".sysmlx", ".kermlx")
SUFFIXES = {
    "xmi": (".uml", ".xml", ".mdxml", ".mdzip", ".xmi"),
    "aml": _AML,
    "v2": (*_TEXTS, *_EXCHANGED, ".kpar"),
}
"""What the files of each kind of models are named."""
PROJECTS = ("ice-lab", "showcase/*")
"""Folders of text that are one model."""
_RECIPES = sorted(_EXAMPLES.glob("*/*.sysml"))
_WHOLE = 0.1
"""Share of projects and recipes among the mutants of SysML v2."""
_BYTES = 0.12
"""Share of texts that are damaged as bytes too."""
_LEVELS = b"""[recipe.levels]
recipe = "RecipePrimitives::Recipe"
task = "RecipePrimitives::Task"
machine-service = "RecipePrimitives::MachineService"
machine = "ISA95EquipmentHierarchy::ProductionEquipment"
opc-ua-call = "OpcUaBinding::OpcUaMethod"
"""


@dataclass(frozen=True, slots=True)
class Mutant:
    """A spoilt model: what is compiled, what was done to which model, its files."""

    seed: int
    name: str
    done: str
    files: tuple[tuple[str, bytes], ...]


def models(corpus: Path | None, largest: int, kinds: Sequence[str] = ("xmi", "aml")) -> list[Path]:
    """The examples, and the models of the corpus up to a size in bytes; a project is a folder."""
    wanted = {suffix for kind in kinds for suffix in SUFFIXES[kind]}
    inside = corpus.rglob("*") if corpus else ()
    real = [p for p in inside if p.suffix in wanted and p.stat().st_size <= largest]
    if corpus and "v2" in kinds:
        real += [path for project in PROJECTS for path in corpus.glob(project)]
    own = {".uml": "xmi", ".sysml": "v2", ".aml": "aml"}
    examples = [p for p in sorted(_EXAMPLES.glob("*/*")) if own.get(p.suffix) in kinds]
    return [*examples, *sorted(real)]


def mutant(seed: int, among: Sequence[Path]) -> Mutant:
    """The mutant of a number. Small models are chosen more often than large ones."""
    random = Random(seed)
    path = _chosen(among, random)
    if path.is_dir():
        return _of_project(seed, path, random)
    name, done, data = _of_file(path, random, among)
    name = f"m{seed}.{name}"
    return Mutant(seed, name, f"{path.name}: {done}", ((name, data),))


def unspoilt(number: int, path: Path) -> Mutant:
    """A model as it is, in the place of a mutant."""
    if path.is_dir():
        known = sorted(one for one in path.rglob("*") if one.suffix in _TEXTS)
        found = [(f"m{number}/{p.relative_to(path).as_posix()}", p.read_bytes()) for p in known]
        return Mutant(number, f"m{number}", path.name, (("sysmlc.toml", _LEVELS), *found))
    suffix = path.suffix if path.suffix != ".xt" else Path(path.stem).suffix
    name = f"m{number}{suffix}"
    return Mutant(number, name, path.name, ((name, path.read_bytes()),))


def _chosen(among: Sequence[Path], random: Random) -> Path:
    """One of the models. Projects, of which files say more together, and recipes are not rare."""
    whole = [path for path in among if path.is_dir() or path in _RECIPES]
    if whole and random.random() < _WHOLE:
        return random.choice(whole)
    weights = [1 / (20_000 + _size(path)) for path in among]
    return random.choices(among, weights)[0]


@cache
def _size(path: Path) -> int:
    return path.stat().st_size


def _of_file(path: Path, random: Random, among: Sequence[Path]) -> tuple[str, str, bytes]:
    """Suffix, what was done, content."""
    if path.suffix in _TEXTS:
        language = "kerml" if ".kerml" in path.name else "sysml"
        return language, *_spoilt_text(path, random, among)
    if path.suffix == ".kpar":
        spoil = lambda data, dice: _spoilt(data.decode("utf-8", "replace"), dice)  # noqa: E731
        return "kpar", *mutate_archive(_document(path, ""), random, spoil)
    return _of_xml(path, random)


def _of_xml(path: Path, random: Random) -> tuple[str, str, bytes]:
    is_example = _EXAMPLES in path.parents and path.suffix == ".uml"
    dialect = random.choice(["uml", "uml", "xml", "mdzip"]) if is_example else path.suffix[1:]
    whole = _document(path, dialect if is_example else "")
    changes = EXCHANGE_CHANGES if path.suffix in _EXCHANGED else None
    changes = AML_CHANGES if path.suffix in _AML else changes
    if dialect in ("mdzip", "amlx"):
        spoil = lambda data, dice: mutate(data, dice, CHANGES, DAMAGES, changes)  # noqa: E731
        return dialect, *mutate_archive(whole, random, spoil)
    if _is_well_formed(path):
        return dialect, *mutate(whole, random, CHANGES, DAMAGES, changes)
    return dialect, *damage(whole, random, DAMAGES)


def _spoilt_text(path: Path, random: Random, among: Sequence[Path]) -> tuple[str, bytes]:
    donors = [one for one in among if one.suffix == path.suffix]
    return _spoilt(_text(path), random, _text(random.choice(donors or [path])))


def _spoilt(text: str, random: Random, donor: str = "") -> tuple[str, bytes]:
    done, spoilt = mutate_text(text, random, donor)
    data = spoilt.encode("utf-8", "replace")
    if not data or random.random() >= _BYTES:
        return done, data
    more, data = damage(data, random, TEXT_DAMAGES)
    return f"{done} {more}", data


def _of_project(seed: int, folder: Path, random: Random) -> Mutant:
    """One or two files of a project are spoilt, or one is gone."""
    known = sorted(path for path in folder.rglob("*") if path.suffix in _TEXTS)
    contents = {path: path.read_bytes() for path in known}
    done = []
    for path in random.sample(known, min(len(known), random.choice((1, 1, 2)))):
        if random.random() < 0.05:
            done.append(f"{path.name}: gone")
            del contents[path]
            continue
        what, contents[path] = _spoilt_text(path, random, known)
        done.append(f"{path.name}: {what}")
    root = f"m{seed}"
    files = [(f"{root}/{p.relative_to(folder).as_posix()}", d) for p, d in contents.items()]
    return Mutant(seed, root, "; ".join(done), (("sysmlc.toml", _LEVELS), *files))


@cache
def _text(path: Path) -> str:
    return path.read_bytes().decode("utf-8-sig", "replace")


@cache
def _is_well_formed(path: Path) -> bool:
    try:
        etree.parse(path)
    except etree.XMLSyntaxError:
        return False
    return True


@cache
def _document(path: Path, dialect: str) -> bytes:
    writer = {"xml": write_xml, "mdzip": write_mdzip}.get(dialect, bytes)
    return writer(path.read_bytes())
