"""Hostile repositories: a spoilt model with configuration, overlay, scenarios, templates and links.

A repository is the number that seeds it, as a mutant is. ``run`` compiles it and compares the
whole file tree before and after: nothing but the output folder may change.
"""

import hashlib
import json
import os
import shutil
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from random import Random

from fuzz.damages import TEXT_DAMAGES
from fuzz.guard import MEGABYTE, Bounds, Ended, Guard
from fuzz.hunt import write
from fuzz.mutants import Mutant, mutant

ROOT = Path(__file__).parents[2]
FIRST_SEED = 10_000_000
BOUNDS = Bounds(seconds=11, waiting=150, memory=1200 * MEGABYTE)
SECONDS = 10
PROJECT = "project"
OUTPUT = "out"
SENTINELS = {
    "sentinel/manifest.json": b'{"format": "sysmlc-manifest/1", "files": []}',
    "sentinel/secret.sysml": b"package Secret;",
    "sentinel/keep/deep/file.txt": b"keep",
    "sysmlc.toml": b'output = "sentinel"\nstrict = true\n',
}
"""Files beside the project, which sysmlc must neither change nor use."""

_OVERLAYS = ("baygate/baygate", "four-tasks/cell")
_SCENARIOS = sorted((ROOT / "examples/baygate-behaviour/scenarios").glob("*.yaml"))
_SCENARIO_MODEL = "baygate-behaviour/baygate-behaviour.uml"
_TEMPLATES = sorted((ROOT / "templates").rglob("*.j2"))

_PATHS = (
    "../sentinel",
    "../../x",
    "/tmp/../etc",
    "~/x",
    ".",
    "..",
    "",
    ".git",
    ".git/hooks",
    "out",
    "out/../..",
    "link",
    "link/x",
    "a\\..\\..\\b",
    "C:/x",
    "con",
    "x\u202ey",
    "a" * 300,
    "a/" * 2000,
    "x\0y",
)
_CONFIGURATION = (
    "output = {path}",
    "output = {path}",
    "templates = {path}",
    'templates = "t"',
    'emit = ["graph", "+ir", "reqtable"]',
    'emit = ["contracts", "plantuml", "reqtable"]',
    'diagrams = "both"',
    "strict = true",
    "strict-input = true",
    "time-limit = 5",
    "memory-limit = 2",
    'rules = {{ "untyped-port" = "off", SM410 = "error" }}',
    '[[suppress]]\nrule = "assumed-range"\nelement = {path}\nreason = "x"',
    '[[model]]\nname = {path}\nfiles = ["*.uml"]',
    '[[model]]\nname = "m"\nfiles = [{path}]\noutput = {path}',
    '[[model]]\nname = "m"\nfiles = ["**/*"]\nemit = ["ir"]',
    '[recipe.levels]\n{path} = "task"\ntask = ["A::B"]',
)
_WRONG_CONFIGURATION = (
    "time-limit = {number}",
    "memory-limit = {number}",
    "emit = [{path}]",
    "[passes.contracts]\n{path} = {number}",
    "{path} = {number}",
    "a = {nested}",
)
_NUMBERS = ("0", "-1", "1e400", "nan", "9" * 400, "0x7f", "1970-01-01", "true", '"1"', "[]")
_ATOMS = (
    "null",
    "~",
    "[]",
    "{}",
    "-1",
    "1e400",
    ".inf",
    "9" * 400,
    "'",
    '"\\ud800"',
    '"\\u202e\\e[31m"',
    "!!python/object/apply:os.system ['touch /tmp/pwned']",
    "&a [*a, *a]",
    "*unknown",
    "<<: *a",
    "? [a]",
    "2024-13-40",
    "y",
    "0o777",
    "../../sentinel/secret.sysml",
    "[" * 400,
    "x: " * 200,
    "{a: " * 200,
)
_EXPRESSIONS = (
    "{{ cycler.__init__.__globals__.os.popen('touch ../sentinel/pwned').read() }}",
    "{{ ''.__class__.__mro__[1].__subclasses__() }}",
    "{{ page.__class__.__init__.__globals__ }}",
    "{% for i in range(10**9) %}x{% endfor %}",
    "{{ 'x' * 10**10 }}",
    "{{ 9**9**9 }}",
    "{% include '../../sentinel/secret.sysml' %}",
    "{% include '/etc/passwd' %}",
    "{% import 'contract.md.j2' as c %}{{ c }}",
    "{% extends 'contract.md.j2' %}",
    "{% macro m() %}{{ m() }}{% endmacro %}{{ m() }}",
    "{{ page.nothing.at_all }}",
    "{{ '%s'.format(page) }}{{ page | map(attribute='__class__') | list }}",
    "{% set x = namespace(a=1) %}{% set x.a = page %}",
    "{% raw %}",
    "{{",
    "{" * 5000,
    "{{ " + "(" * 500 + "1" + ")" * 500 + " }}",
)


@dataclass(frozen=True, slots=True)
class Repository:
    """Files and links below the project, and the command that is run in it."""

    seed: int
    files: Mapping[str, bytes]
    links: Mapping[str, str]
    args: tuple[str, ...]
    done: str

    @property
    def names_output(self) -> bool:
        """Whether the command names the output folder, so that nothing else may change."""
        return "-o" in self.args or self.args[0] != "build"


def repository(seed: int, among: Sequence[Path]) -> Repository:
    """Return the hostile repository of a number; *among* are the models that it may hold."""
    random = Random(seed)
    kind = random.choice((_of_overlay, _of_scenario, _of_templates, _of_model, _of_model))
    found = kind(seed, random, among)
    files, done = dict(found.files), found.done
    if random.random() < (0.1 if kind is _of_templates else 0.5):
        files["sysmlc.toml"] = _make_configuration(random)
        done += "; configuration"
    if random.random() < 0.1 and "sysmlc.toml" not in files:
        table = b"[tool.sysmlc]\n" + _make_configuration(random)
        files["pyproject.toml"] = table
    links = {}
    if random.random() < 0.4:
        # A folder that the command line names may be a link; one that a file names may not.
        names = ("link", "out/contracts", "out/manifest.json", "t", "m.sysml")
        name = random.choice(names if found.names_output else ("out", *names))
        if name not in files:
            links[name] = random.choice(("../sentinel", "../sentinel/secret.sysml", "link", ".git"))
    if random.random() < 0.3 and not any(name.startswith("out") for name in links):
        files["out/manifest.json"] = _make_manifest(random)
        files["out/notes.txt"] = b"mine"
    return replace(found, files=files, links=links, done=done)


def _of_model(seed: int, random: Random, among: Sequence[Path]) -> Repository:
    spoilt = mutant(seed, among)
    emitted = "+graph,+ir,+reqtable,+sysml,+uml,+aml"
    args = random.choice(
        (
            ("build", spoilt.name, "-o", OUTPUT, "--emit", emitted),
            ("build", spoilt.name),
            ("build", "."),
            ("check", ".", "--format", random.choice(("text", "json", "sarif", "github"))),
            ("contracts", "check", spoilt.name, "--question-limit", "0.2"),
            ("show", spoilt.name),
            ("coverage", spoilt.name, "--format", "json"),
        )
    )
    return Repository(seed, dict(spoilt.files), {}, args, f"model: {spoilt.done}")


def _of_overlay(seed: int, random: Random, _among: Sequence[Path]) -> Repository:
    base = ROOT / "examples" / random.choice(_OVERLAYS)
    done, overlay = _spoil_text(base.with_suffix(".overlay.yaml").read_text(), random)
    name = base.name
    files = {
        f"{name}.aml": base.with_suffix(".aml").read_bytes(),
        f"{name}.overlay.yaml": overlay,
        **{path.name: path.read_bytes() for path in base.parent.glob("*.uml")},
    }
    command = random.choice((("build", f"{name}.aml", "-o", OUTPUT), ("check", f"{name}.aml")))
    return Repository(seed, files, {}, command, f"overlay: {done}")


def _of_scenario(seed: int, random: Random, _among: Sequence[Path]) -> Repository:
    done, scenario = _spoil_text(random.choice(_SCENARIOS).read_text(), random)
    files = {
        "m.uml": (ROOT / "examples" / _SCENARIO_MODEL).read_bytes(),
        "s.yaml": scenario,
    }
    args = ("simulate", "m.uml", "--scenario", "s.yaml", "--junit", "out/report.xml", "-o", OUTPUT)
    return Repository(seed, files, {}, args, f"scenario: {done}")


def _of_templates(seed: int, random: Random, _among: Sequence[Path]) -> Repository:
    files = {"m.uml": (ROOT / "examples/baygate/gate.uml").read_bytes()}
    done = []
    for path in random.sample(_TEMPLATES, 2):
        text = path.read_text()
        at = random.randrange(len(text))
        expression = random.choice(_EXPRESSIONS)
        data = f"{text[:at]}{expression}{text[at:]}".encode()
        if random.random() < 0.2:
            data = random.choice(TEXT_DAMAGES)(data, random)
        files[f"t/{path.relative_to(ROOT / 'templates').as_posix()}"] = data
        files[f"t/{path.name}"] = data
        done.append(f"{path.name} {expression[:40]}")
    files["sysmlc.toml"] = b'templates = "t"\n'
    args = ("build", "m.uml", "-o", OUTPUT, "--emit", "+reqtable", "--time-limit", "8")
    return Repository(seed, files, {}, args, f"templates: {'; '.join(done)}")


def _make_configuration(random: Random) -> bytes:
    pool = _WRONG_CONFIGURATION if random.random() < 0.15 else _CONFIGURATION
    lines = [
        line.format(
            path=json.dumps(random.choice(_PATHS)),
            number=random.choice(_NUMBERS),
            nested=random.choice(("[" * 100_000, "{a=" * 5_000, ".a" * 9_000, '"""')),
        )
        for line in random.sample(pool, random.randint(1, 2))
    ]
    lines.sort(key=lambda line: line.startswith("["))
    data = "\n".join(lines).encode("utf-8", "replace")
    return random.choice(TEXT_DAMAGES)(data, random) if random.random() < 0.05 else data


def _make_manifest(random: Random) -> bytes:
    path = random.choice(("notes.txt", "../m.uml", "../../sentinel/keep/deep/file.txt", *_PATHS))
    digest = hashlib.sha256(b"mine").hexdigest()
    entry = f'{{"path": "{path}", "backend": "ir", "sha256": "{digest}"}}'
    extra = random.choice(("", "[" * 50_000, "\xff", '"pending": true,'))
    text = f'{{"format": "sysmlc-manifest/1", {extra} "inputs": [], "files": [{entry}]}}'
    return text.encode("latin-1", "replace")


def _spoil_text(text: str, random: Random) -> tuple[str, bytes]:
    """Replace values and lines of a YAML document by hostile ones."""
    lines = text.splitlines()
    done = []
    for _ in range(random.randint(1, 4)):
        at = random.randrange(len(lines))
        head, colon, _ = lines[at].partition(":")
        atom = random.choice(_ATOMS)
        line, indent = lines[at], " " * random.randint(1, 9)
        replacements = (
            [f"{head}{colon} {atom}"],
            [atom],
            [],
            [line, line],
            [f"{line} {random.choice(lines).strip()}"],
            [indent + line.strip()],
        )
        new = random.choice(replacements)
        done.append(f"{at + 1}: {new[0].strip()[:30] if new else 'gone'}")
        lines[at : at + 1] = new
        lines = lines or [""]
    data = "\n".join(lines).encode("utf-8", "replace")
    if random.random() < 0.15:
        data = random.choice(TEXT_DAMAGES)(data, random)
    return ", ".join(done), data


# -- running -----------------------------------------------------------------------------------


def run(hostile: Repository, guard: Guard, folder: Path) -> tuple[Ended, list[str]]:
    """Compile a repository in *folder*. Return how the command ended and what is wrong with it."""
    shutil.rmtree(folder, ignore_errors=True)
    project = folder / PROJECT
    write(Mutant(0, "", "", tuple(SENTINELS.items())), folder)
    write(Mutant(0, "", "", ((".git/HEAD", b"ref: x"), (".git/hooks/x", b"#!"))), project)
    write(Mutant(0, "", "", tuple(hostile.files.items())), project)
    for name, target in hostile.links.items():
        link = project / name
        link.parent.mkdir(parents=True, exist_ok=True)
        if not link.exists() and not link.is_symlink():
            link.symlink_to(target)
    before = take_snapshot(folder)
    ended = guard.run(project, *hostile.args, bounds=BOUNDS)
    return ended, [*_find_faults(ended), *_find_changes(before, folder, hostile)]


def take_snapshot(folder: Path) -> dict[str, str]:
    """Return the state of each file, folder and link below *folder*, links not followed."""
    states = {}
    for parent, folders, files in os.walk(folder):
        for name in (*folders, *files):
            path = Path(parent, name)
            if path.is_symlink():
                state = f"link to {path.readlink()}"
            elif path.is_dir():
                state = "folder"
            else:
                state = hashlib.sha256(path.read_bytes()).hexdigest()
            states[path.relative_to(folder).as_posix()] = state
    return states


def _find_faults(ended: Ended) -> Iterator[str]:
    if ended.is_fault:
        yield ended.told
    elif ended.seconds > SECONDS:
        yield f"{ended.seconds:.1f} s of processor time"
    elif ended.code and not ended.err + ended.out:
        yield f"exit {ended.code} without a word"


def _find_changes(before: Mapping[str, str], folder: Path, hostile: Repository) -> Iterator[str]:
    """Yield what changed outside the output folder.

    Where the configuration may choose the folder, new files may be anywhere in the project. What a
    manifest in the output folder lists, with its digest, belongs to sysmlc.
    """
    after = take_snapshot(folder)
    output = f"{PROJECT}/{OUTPUT}"
    inside = output if hostile.names_output else PROJECT
    for path in sorted(before.keys() | after.keys()):
        old, new = before.get(path), after.get(path)
        if old is None and not f"{path}/".startswith(f"{inside}/"):
            yield f"{path} was written outside {inside}"
        elif old is not None and old != new and not path.startswith(f"{output}/"):
            yield f"{path} changed"
