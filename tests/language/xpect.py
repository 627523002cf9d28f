"""The pilot's Xpect models: which files belong together, and what each expects of its names."""

import re
from dataclasses import dataclass
from pathlib import Path

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
"""Packages that models of the tests import and the corpus has not: what the expectations need."""


@dataclass(frozen=True)
class Linked:
    """A name at ``offset`` must lead to ``target`` (names with dots)."""

    line: int
    text: str
    offset: int
    target: str


@dataclass(frozen=True)
class Scope:
    """Names that are in the scope of the reference at ``offset``."""

    line: int
    text: str
    offset: int
    names: frozenset[str]


@dataclass(frozen=True)
class Unresolved:
    """A name at ``offset`` that leads nowhere."""

    line: int
    text: str
    offset: int


@dataclass(frozen=True)
class Case:
    """One .xt file: its text, the files beside it, its expectations."""

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

    def beside(self) -> dict[str, str]:
        """Texts of the other files by name; those of the standard library are not among them."""
        texts: dict[str, str] = {}
        for name in self.files:
            near = self.path.parent / name
            if name.startswith("/src/") and name[5:] in HELPERS:
                texts[name[5:]] = HELPERS[name[5:]]
            elif not name.startswith("/") and near.is_file():
                texts[name] = near.read_text(encoding="utf-8")
        return texts

    @property
    def is_complete(self) -> bool:
        """Whether every file that it needs is there."""
        own = [name for name in self.files if not name.startswith("/library")]
        return len(self.beside()) == len(set(own))


def read(path: Path) -> Case:
    """One test model with its expectations."""
    text = path.read_text(encoding="utf-8")
    setup, end, _ = text.partition("END_SETUP")
    plain = model_text(text)

    def place(match: re.Match[str], name: str) -> tuple[int, str, int]:
        line = text.count("\n", 0, match.start()) + 1
        return line, name, _next(plain, name, match.end())

    linked = [Linked(*place(m, m[1]), m[2]) for m in _LINKED.finditer(text)]
    scopes = [
        Scope(*place(m, m[1]), frozenset(n.strip() for n in m[2].split(",") if n.strip()))
        for m in _SCOPE.finditer(text)
    ]
    unresolved = [
        Unresolved(*place(m, e[2]))
        for m in _ERRORS.finditer(text)
        for e in _ERROR.finditer(m[1])
        if _UNRESOLVED.match(e[1])
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


def model_text(text: str) -> str:
    """The text with its comments blanked: what is left is the model, at the same places."""
    return re.sub(
        r"//\*.*?\*/|/\*.*?\*/|//[^\n]*",
        lambda m: re.sub(r"[^\n]", " ", m[0]),
        text,
        flags=re.DOTALL,
    )


def _next(text: str, name: str, after: int) -> int:
    """Where ``name`` stands first after an expectation, as Xpect looks for it; -1 if nowhere."""
    bounded = re.compile(rf"(?<![\w']){re.escape(name)}(?![\w'])")
    match = bounded.search(text, after)
    return match.start() if match else text.find(name, after)
