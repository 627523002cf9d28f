"""The draft of a random text of SysML v2: names, definitions, packages and references to them.

Names of definitions and packages are unique in a text, and differ from the names of features. So a
reference means the same element wherever it stands. Names of features are used again in other
definitions, as in real models.
"""

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from random import Random
from typing import TypeVar

T = TypeVar("T")
_FEATURES = """
    mass level speed width state1 slot motor gripper feed belt door sensor lamp flag count limit
    input1 output1 data 'max load' 'in' 'part' 'übergang' 'it\\'s' 'a-b' x1 x2 y1 y2 z1 z2 unit1
    power ready hand arm base cover box tray tank valve pump rail 'the end' 'kg' _tmp N_1
"""
FEATURE_NAMES = re.findall(r"'(?:[^'\\]|\\.)*'|\S+", _FEATURES)
"""Names of features, with quotes where these are necessary."""
_WORDS = """
    Robot Cell Line Station Order Signal Plan Unit Batch Frame Axis Tool Plate Label Task Mode Zone
    Sensor Drive Crate Worker Lift Scale Oven Mixer Press
"""
TYPE_WORDS = _WORDS.split()
SCALARS = ("Integer", "Real", "Boolean", "String", "Natural")


@dataclass(eq=False)
class Feature:
    """A feature: its type is the name of a scalar or of a quantity, or a definition."""

    name: str
    kind: str
    type: "str | Definition"
    is_many: bool = False
    direction: str = ""
    is_fixed: bool = False
    """Whether the feature has a bound value, which no redefinition may override."""
    is_conjugated: bool = False


@dataclass(eq=False)
class Definition:
    """A definition, or a usage of a package, with the features that it owns and inherits."""

    name: str
    kind: str
    package: "Package"
    type: "str | Definition | None" = None
    """The type of a usage, or the result of a calculation."""
    features: list[Feature] = field(default_factory=list)
    is_private: bool = False
    is_abstract: bool = False
    short_name: str = ""

    def list_features(self, *kinds: str) -> list[Feature]:
        """Return the features of these kinds."""
        return [feature for feature in self.features if feature.kind in kinds]


@dataclass(eq=False)
class Package:
    """A package: its qualified name, its members as text, and the names that it imports."""

    path: tuple[str, ...]
    members: list[str] = field(default_factory=list)
    aliases: dict[Definition, list[str]] = field(default_factory=dict)
    """Names that imports and aliases give to definitions of other packages."""
    libraries: set[str] = field(default_factory=set)
    """Packages of the library that are imported."""

    def contains(self, package: "Package") -> bool:
        """Whether *package* is this package or nested in it."""
        return package.path[: len(self.path)] == self.path


class Draft:
    """The state of drawing one text: random choices, and the definitions drawn so far."""

    def __init__(self, random: Random) -> None:
        self.random = random
        self.definitions: list[Definition] = []
        self.package = Package(())
        self._count = 0

    def choose(self, values: Sequence[T]) -> T:
        """Return one of the values."""
        return self.random.choice(values)

    def is_drawn(self, probability: float) -> bool:
        """Return true with this probability."""
        return self.random.random() < probability

    def join_drawn(self, probability: float, text: str) -> str:
        """Return *text* with this probability, else nothing."""
        return text if self.is_drawn(probability) else ""

    def draw_name(self) -> str:
        """Return a new name of a definition, a package or a feature of a package."""
        self._count += 1
        word = f"{self.choose(TYPE_WORDS)}{self._count}"
        return self.choose(
            [word, word, word, word.lower(), f"'{word} {self._count}'", f"'Ö{word}'"]
        )

    def draw_feature_name(self, taken: Iterable[str]) -> str:
        """Return a name that is not among those *taken*."""
        return self.choose(sorted(set(FEATURE_NAMES) - set(taken)))

    def make_definition(self, kind: str, features: Sequence[Feature] = ()) -> Definition:
        """Return a new definition in the current package, not yet known to ``find``."""
        short = f"'1.{self._count + 1}'" if self.is_drawn(0.1) else ""
        return Definition(
            self.draw_name(),
            kind,
            self.package,
            features=list(features),
            is_private=self.is_drawn(0.05),
            short_name=short,
        )

    def add(self, definition: Definition, text: str) -> Definition:
        """Add the text of a definition to the current package."""
        visibility = "private " if definition.is_private else self.join_drawn(0.1, "public ")
        self.package.members.append(visibility + text)
        self.definitions.append(definition)
        return definition

    def add_member(self, text: str) -> None:
        """Add a member without a name to the current package."""
        self.package.members.append(text)

    def find(
        self, kind: str, is_fitting: Callable[[Definition], bool] = lambda definition: True
    ) -> Definition | None:
        """Return a definition of this kind that can be referred to, if there is one."""
        candidates = [
            definition
            for definition in self.definitions
            if definition.kind == kind
            and (not definition.is_private or definition.package.contains(self.package))
            and is_fitting(definition)
        ]
        return self.choose(candidates) if candidates else None

    def refer(self, definition: Definition) -> str:
        """Return a name of the definition that resolves to it in the current package."""
        path = definition.package.path
        names = [definition.name]
        if definition.short_name:
            names.append(definition.short_name)
        name = self.choose(names)
        full = "::".join((*path, name))
        if definition.is_private:
            # The qualified name of a private member resolves nowhere (KerML 1.0, 8.2.3.5.4).
            return name
        if definition.package.contains(self.package):
            return self.choose([name, name, name, full, f"$::{full}"])
        references = [full, f"$::{full}", *3 * self.package.aliases.get(definition, [])]
        if self.package.contains(definition.package) and len(path) > 0:
            references.append("::".join((*path[len(self.package.path) :], name)))
        return self.choose(references)

    def refer_library(self, package: str, name: str) -> str:
        """Return a reference to an element of the library."""
        if package in self.package.libraries:
            return self.choose([name, name, f"{package}::{name}"])
        return f"{package}::{name}"

    def identify(self, definition: Definition) -> str:
        """Return the identification: name and short name."""
        if definition.short_name:
            return f"<{definition.short_name}> {definition.name}"
        return definition.name

    def make_block(self, head: str, members: Iterable[str]) -> str:
        """Return a declaration with a body, or with a semicolon if the body is empty."""
        lines = [member for member in members if member]
        if not lines:
            return f"{head};" if self.is_drawn(0.9) else f"{head} {{ }}"
        body = "\n".join(lines).replace("\n", "\n    ")
        return f"{head} {{\n    {body}\n}}"
