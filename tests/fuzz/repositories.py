"""Hostile repositories: a mutated model with configuration, overlay, scenarios, templates, links.

A repository is determined by its seed, as a mutant is. ``run_command`` runs its command and
compares the whole file tree before and after: nothing but the output folder may change.
"""

import hashlib
import json
import os
import shutil
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from random import Random

from fuzz.byte_damages import TEXT_DAMAGES
from fuzz.fork_server import MEGABYTE, CommandResult, ForkServer, Limits
from fuzz.hunt import write_files
from fuzz.mutants import make_mutant

ROOT = Path(__file__).parents[2]
FIRST_SEED = 10_000_000
LIMITS = Limits(seconds=11, elapsed=150, memory=1200 * MEGABYTE)
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
_VALUES = (
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
    """Files and links below the project, and the command to run in it."""

    seed: int
    files: Mapping[str, bytes]
    links: Mapping[str, str]
    args: tuple[str, ...]
    description: str

    @property
    def names_output(self) -> bool:
        """Whether the command names the output folder, so that nothing else may change."""
        return "-o" in self.args or self.args[0] != "build"


def make_repository(seed: int, models: Sequence[Path]) -> Repository:
    """Return the hostile repository of a seed; its model is one of *models*."""
    random = Random(seed)
    make = random.choice((_make_overlay, _make_scenario, _make_templates, _make_model, _make_model))
    base = make(seed, random, models)
    files, description = dict(base.files), base.description
    if random.random() < (0.1 if make is _make_templates else 0.5):
        files["sysmlc.toml"] = _make_configuration(random)
        description += "; configuration"
    if random.random() < 0.1 and "sysmlc.toml" not in files:
        table = b"[tool.sysmlc]\n" + _make_configuration(random)
        files["pyproject.toml"] = table
    links = {}
    if random.random() < 0.4:
        # The output folder may be a link if the command line names it, but not if a file does.
        names = ("link", "out/contracts", "out/manifest.json", "t", "m.sysml")
        name = random.choice(names if base.names_output else ("out", *names))
        if name not in files:
            links[name] = random.choice(("../sentinel", "../sentinel/secret.sysml", "link", ".git"))
    if random.random() < 0.3 and not any(name.startswith("out") for name in links):
        files["out/manifest.json"] = _make_manifest(random)
        files["out/notes.txt"] = b"mine"
    return replace(base, files=files, links=links, description=description)


def _make_model(seed: int, random: Random, models: Sequence[Path]) -> Repository:
    mutant = make_mutant(seed, models)
    backends = "+graph,+ir,+reqtable,+sysml,+uml,+aml"
    args = random.choice(
        (
            ("build", mutant.name, "-o", OUTPUT, "--emit", backends),
            ("build", mutant.name),
            ("build", "."),
            ("check", ".", "--format", random.choice(("text", "json", "sarif", "github"))),
            ("contracts", "check", mutant.name, "--question-limit", "0.2"),
            ("show", mutant.name),
            ("coverage", mutant.name, "--format", "json"),
        )
    )
    return Repository(seed, dict(mutant.files), {}, args, f"model: {mutant.description}")


def _make_overlay(seed: int, random: Random, _models: Sequence[Path]) -> Repository:
    base = ROOT / "examples" / random.choice(_OVERLAYS)
    description, overlay = _mutate_yaml(base.with_suffix(".overlay.yaml").read_text(), random)
    name = base.name
    files = {
        f"{name}.aml": base.with_suffix(".aml").read_bytes(),
        f"{name}.overlay.yaml": overlay,
        **{path.name: path.read_bytes() for path in base.parent.glob("*.uml")},
    }
    command = random.choice((("build", f"{name}.aml", "-o", OUTPUT), ("check", f"{name}.aml")))
    return Repository(seed, files, {}, command, f"overlay: {description}")


def _make_scenario(seed: int, random: Random, _models: Sequence[Path]) -> Repository:
    description, scenario = _mutate_yaml(random.choice(_SCENARIOS).read_text(), random)
    files = {
        "m.uml": (ROOT / "examples" / _SCENARIO_MODEL).read_bytes(),
        "s.yaml": scenario,
    }
    args = ("simulate", "m.uml", "--scenario", "s.yaml", "--junit", "out/report.xml", "-o", OUTPUT)
    return Repository(seed, files, {}, args, f"scenario: {description}")


def _make_templates(seed: int, random: Random, _models: Sequence[Path]) -> Repository:
    files = {"m.uml": (ROOT / "examples/baygate/gate.uml").read_bytes()}
    descriptions = []
    for path in random.sample(_TEMPLATES, 2):
        text = path.read_text()
        index = random.randrange(len(text))
        expression = random.choice(_EXPRESSIONS)
        data = f"{text[:index]}{expression}{text[index:]}".encode()
        if random.random() < 0.2:
            data = random.choice(TEXT_DAMAGES)(data, random)
        files[f"t/{path.relative_to(ROOT / 'templates').as_posix()}"] = data
        files[f"t/{path.name}"] = data
        descriptions.append(f"{path.name} {expression[:40]}")
    files["sysmlc.toml"] = b'templates = "t"\n'
    args = ("build", "m.uml", "-o", OUTPUT, "--emit", "+reqtable", "--time-limit", "8")
    return Repository(seed, files, {}, args, f"templates: {'; '.join(descriptions)}")


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


def _mutate_yaml(text: str, random: Random) -> tuple[str, bytes]:
    """Replace values and lines of a YAML document by hostile ones."""
    lines = text.splitlines()
    descriptions = []
    for _ in range(random.randint(1, 4)):
        index = random.randrange(len(lines))
        head, colon, _ = lines[index].partition(":")
        value = random.choice(_VALUES)
        line, indent = lines[index], " " * random.randint(1, 9)
        replacements = (
            [f"{head}{colon} {value}"],
            [value],
            [],
            [line, line],
            [f"{line} {random.choice(lines).strip()}"],
            [indent + line.strip()],
        )
        new = random.choice(replacements)
        descriptions.append(f"{index + 1}: {new[0].strip()[:30] if new else 'gone'}")
        lines[index : index + 1] = new
        lines = lines or [""]
    data = "\n".join(lines).encode("utf-8", "replace")
    if random.random() < 0.15:
        data = random.choice(TEXT_DAMAGES)(data, random)
    return ", ".join(descriptions), data


# -- running -----------------------------------------------------------------------------------


def run_command(
    repository: Repository, server: ForkServer, folder: Path
) -> tuple[CommandResult, list[str]]:
    """Run the command of a repository in *folder*; return its result and the problems."""
    shutil.rmtree(folder, ignore_errors=True)
    project = folder / PROJECT
    write_files(SENTINELS.items(), folder)
    write_files(((".git/HEAD", b"ref: x"), (".git/hooks/x", b"#!")), project)
    write_files(repository.files.items(), project)
    for name, target in repository.links.items():
        link = project / name
        link.parent.mkdir(parents=True, exist_ok=True)
        if not link.exists() and not link.is_symlink():
            link.symlink_to(target)
    before = take_snapshot(folder)
    result = server.run(project, *repository.args, limits=LIMITS)
    return result, [*_find_faults(result), *_find_changes(before, folder, repository)]


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


def _find_faults(result: CommandResult) -> Iterator[str]:
    if result.is_crash:
        yield result.summary
    elif result.seconds > SECONDS:
        yield f"{result.seconds:.1f} s of processor time"
    elif result.code and not result.err + result.out:
        yield f"exit {result.code} without output"


def _find_changes(before: Mapping[str, str], folder: Path, repository: Repository) -> Iterator[str]:
    """Yield the changes outside the output folder.

    If the configuration may choose the folder, new files may be anywhere in the project. Files
    that a manifest in the output folder lists with their digest belong to sysmlc.
    """
    after = take_snapshot(folder)
    output = f"{PROJECT}/{OUTPUT}"
    writable = output if repository.names_output else PROJECT
    for path in sorted(before.keys() | after.keys()):
        old, new = before.get(path), after.get(path)
        if old is None and not f"{path}/".startswith(f"{writable}/"):
            yield f"{path} was written outside {writable}"
        elif old is not None and old != new and not path.startswith(f"{output}/"):
            yield f"{path} changed"
