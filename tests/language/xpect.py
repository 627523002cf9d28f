"""The test models of the pilot implementation: their files, and the results that they expect.

The models contain expectations in the language Xpect, as comments.
"""

import re
from dataclasses import dataclass
from pathlib import Path

from official_models import FOLDER

from sysmlc.diagnostics import Diagnostic, Sink
from sysmlc.language.text import parse
from sysmlc.language.tree import Document

XPECT_FOLDER = FOLDER / "pilot-xpect"
XPECT_FILES = sorted(
    path.relative_to(XPECT_FOLDER).as_posix() for path in XPECT_FOLDER.rglob("*.xt")
)

_FILE = re.compile(r'File\s*(?:\{\s*from\s*=\s*)?"([^"]+)"')
_LINKED = re.compile(r"XPECT linkedName at\s+(.+?)\s*-+>\s*(\S+)")
_SCOPE = re.compile(r"XPECT scope at\s+(\S.*?)\s*---(.*?)---", re.DOTALL)
_ERRORS = re.compile(r'XPECT errors(?: at \S+)?\s*-+>?\s*(.*?)(?=\n\s*(?:[^\s"]|$))', re.DOTALL)
_ERROR = re.compile(r'"((?:[^"\\]|\\.)*)"\s+at\s+"((?:[^"\\]|\\.)*)"')
_UNRESOLVED = re.compile(r"Couldn't resolve reference to (\w+) '(.*)'\.?")

OUTER = {
    "class": "package OuterPackage { class A { class a1; } class B { feature b : A; } }",
    "FT": "package OuterPackage { feature A { feature a1; } feature B { feature b : A; } }",
    "Rdef": """
package OuterPackage { feature A { feature a1; } feature B { feature b redefines A; } }
""",
}
_ALIASES = """\
package PackageAlias1 {{
    alias A_alias for A;
    {kind} A {{ {kind} a; alias a_alias for a; }}
    alias AA_alias for AA;
    {kind} AA {{ {kind} aa; alias aa_alias for aa; }}
}}
"""
_VISIBLE = """\
package VisibilityPackage {{
    private {kind} c_Private {{ private {kind} c_private; public {kind} c_public; }}
    public {kind} c_Public {{
        private {kind} c_private; public {kind} c_public; protected {kind} c_protected;
    }}
    public {kind} c_Public_alias {{
        public {kind} c_public; protected {kind} c_protected;
        private alias alias_private for c_public;
        protected alias alias_protected for c_public;
        public alias alias_public for c_public;
        protected alias alias_protected_is_c_protected for c_protected;
    }}
    private {kind} c_Private_alias {{
        public {kind} c_public;
        private alias alias_private for c_public;
        protected alias alias_protected for c_public;
        public alias alias_public for c_public;
    }}
    public {kind} c_clazz {{
        protected {kind} c_Protect {{ public {kind} c_publicc; protected {kind} c_protect; }}
        public {kind} c_Public {{ protected {kind} c_protect; public {kind} c_publicc; }}
    }}
}}
"""
_SECOND = (
    "package OuterPackage2 {{ public import OuterPackage::{what}; {special} {{ feature c; }} }}"
)
_SAME = "package SamePackage {{ {kind} container {{ {kind} {name}; }} }}"
_SECOND_ALIAS = """\
package PackageAlias2 {{
    public import PackageAlias1::*;
    {special} {{ alias b for a_alias; }}
}}
"""
_THIRD = (
    "package OuterPackage3 {{ public import OuterPackage2::C; {special} {{ feature f : b; }} }}"
)

HELPERS = {
    "DependencyOuterPackage.kerml": OUTER["class"],
    "DependencyOuterPackage_Feature_FT.kerml": OUTER["FT"],
    "DependencyOuterPackage_Feature_Rdef.kerml": OUTER["Rdef"],
    "DependencyPackageAlias1.kerml": _ALIASES.format(kind="class"),
    "DependencyPackageAlias1_Feature.kerml": _ALIASES.format(kind="feature"),
    "DependencyPackageAlias2.kerml": _SECOND_ALIAS.format(special="class B specializes A_alias"),
    "DependencyPackageAlias2_Feature_FT.kerml": _SECOND_ALIAS.format(special="feature B : A_alias"),
    "DependencyPackageAlias2_Feature_Rdef.kerml": _SECOND_ALIAS.format(
        special="feature B redefines A_alias"
    ),
    "DependencyVisibilityPackage.kerml": _VISIBLE.format(kind="class"),
    "DependencyVisibilityPackage_Feature.kerml": _VISIBLE.format(kind="feature"),
    "DependencyMultipleMembership.kerml": _SECOND.format(what="B", special="class C specializes B"),
    "DependencyMultipleMembership_Feature_FT.kerml": _SECOND.format(
        what="B", special="feature C : B"
    ),
    "DependencyMultipleMembership_Feature_Rdef.kerml": _SECOND.format(
        what="B", special="feature C subsets B"
    ),
    "DependencyMultipleImport.kerml": _SECOND.format(what="*", special="class C specializes B"),
    "DependencyMultipleImport_Feature_FT.kerml": _SECOND.format(what="*", special="feature C : B"),
    "DependencyMultipleImport_Feature_Rdef.kerml": _SECOND.format(
        what="*", special="feature C subsets B"
    ),
    "DependencyMembership2.kerml": _THIRD.format(special="class D specializes C"),
    "DependencyMembership2_Feature_FT.kerml": _THIRD.format(special="feature D : C"),
    "DependencyMembership2_Feature_Rdef.kerml": _THIRD.format(special="feature D subsets C"),
    "DependencySamePackageName_A.kerml": _SAME.format(kind="classifier", name="A"),
    "DependencySamePackageName_B.kerml": _SAME.format(kind="classifier", name="B"),
    "DependencySamePackageName_A_Feature.kerml": _SAME.format(kind="feature", name="A"),
    "DependencySamePackageName_B_Feature.kerml": _SAME.format(kind="feature", name="B"),
}
"""Packages that the test models import and the corpus lacks, written from the expectations."""


@dataclass(frozen=True)
class Linked:
    """The name at ``offset`` refers to ``target``, whose names are joined by dots."""

    line: int
    text: str
    offset: int
    target: str


@dataclass(frozen=True)
class Scope:
    """Names that are visible to the reference at ``offset``."""

    line: int
    text: str
    offset: int
    names: frozenset[str]


@dataclass(frozen=True)
class Unresolved:
    """The name at ``offset`` is unknown."""

    line: int
    text: str
    offset: int


@dataclass(frozen=True)
class Case:
    """One .xt file: its text, the files it needs, and its expectations."""

    path: Path
    text: str
    files: tuple[str, ...]
    no_errors: bool
    linked: tuple[Linked, ...]
    scopes: tuple[Scope, ...]
    unresolved: tuple[Unresolved, ...]

    @property
    def language(self) -> str:
        """``sysml`` or ``kerml``."""
        return self.path.name.split(".")[-2]

    @property
    def name(self) -> str:
        """The path of the file in the folder of all test models."""
        return self.path.relative_to(XPECT_FOLDER).as_posix()

    def read_needed_files(self) -> dict[str, str]:
        """Return the texts of the other files by name, without those of the standard library."""
        texts: dict[str, str] = {}
        for name in self.files:
            path = self.path.parent / name
            if name.startswith("/src/") and name[5:] in HELPERS:
                texts[name[5:]] = HELPERS[name[5:]]
            elif not name.startswith("/") and path.is_file():
                texts[name] = path.read_text(encoding="utf-8")
        return texts

    @property
    def is_complete(self) -> bool:
        """Whether every file that the model needs is in the corpus or among the helpers."""
        needed = {name for name in self.files if not name.startswith("/library")}
        return len(self.read_needed_files()) == len(needed)

    def parse(self, sink: Sink) -> list[Document]:
        """Parse the model and the files it needs; only the model's syntax errors are reported."""
        needed = [
            parse(text, name, name.rpartition(".")[2], Sink())
            for name, text in sorted(self.read_needed_files().items())
        ]
        return [parse(self.text, self.path.name, self.language, sink), *needed]

    def list_located(self, sink: Sink) -> list[tuple[int, Diagnostic]]:
        """Return the diagnostics about the model, each with its offset in characters."""
        data = self.text.encode()
        return [
            (len(data[: diagnostic.subject.place.offset].decode()), diagnostic)
            for diagnostic in sink
            if diagnostic.subject.place.file == self.path.name
        ]


def read_cases() -> list[Case]:
    """Return the complete test models; those of a query language that SysML lacks are skipped."""
    cases = [
        read_case(XPECT_FOLDER / name)
        for name in XPECT_FILES
        if not name.startswith("sysml/queryx/")
    ]
    return [case for case in cases if case.is_complete]


def read_case(path: Path) -> Case:
    """Return one test model with its expectations."""
    text = path.read_text(encoding="utf-8")
    setup, end, _ = text.partition("END_SETUP")
    plain = blank_comments(text)

    def locate(match: re.Match[str], name: str) -> tuple[int, str, int]:
        line = text.count("\n", 0, match.start()) + 1
        return line, name, _find_name(plain, name, match.end())

    linked = [Linked(*locate(match, match[1]), match[2]) for match in _LINKED.finditer(text)]
    scopes = [
        Scope(
            *locate(match, match[1]),
            frozenset(name.strip() for name in match[2].split(",") if name.strip()),
        )
        for match in _SCOPE.finditer(text)
    ]
    unresolved = [
        Unresolved(*locate(match, error[2]))
        for match in _ERRORS.finditer(text)
        for error in _ERROR.finditer(match[1])
        if _UNRESOLVED.match(error[1])
    ]
    return Case(
        path,
        text,
        tuple(dict.fromkeys(_FILE.findall(setup if end else ""))),
        "XPECT noErrors" in text,
        tuple(linked),
        tuple(scopes),
        tuple(unresolved),
    )


def blank_comments(text: str) -> str:
    """Return the text with spaces in place of its comments, so that offsets do not change."""
    return re.sub(
        r"//\*.*?\*/|/\*.*?\*/|//[^\n]*",
        lambda comment: re.sub(r"[^\n]", " ", comment[0]),
        text,
        flags=re.DOTALL,
    )


def _find_name(text: str, name: str, after: int) -> int:
    """Return the first offset of *name* behind an expectation, as Xpect finds it, or -1."""
    bounded = re.compile(rf"(?<![\w']){re.escape(name)}(?![\w'])")
    match = bounded.search(text, after)
    return match.start() if match else text.find(name, after)
