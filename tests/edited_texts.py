"""Texts of SysML v2 and random edits of them, sensible ones and others."""

import re
from collections.abc import Mapping
from random import Random

Texts = dict[str, str]

UNIT: Texts = {
    "a.sysml": """package Alpha {
    private import ScalarValues::*;
    part def Gate { attribute width : Real; port inn : Plug; action def Go; action go : Go; }
    part def Wide :> Gate { attribute :>> width = 3; part lock : Lock; }
    port def Plug { in item x; }
    part def Lock;
    enum def Color { enum red; enum green; }
}
""",
    "b.sysml": """package Beta {
    private import Alpha::*;
    private import ScalarValues::Real;
    part gate : Wide { attribute :>> width = 4; }
    part def Room { part door : Gate; part other : Gate; connect door.inn to other.inn; }
    action def Turn { action def Gate; action g : Gate; }
    action def Open { in gate : Gate; first start; then action a :> gate.go; then done; }
}
""",
    "c.sysml": """package Gamma {
    public import Beta::*;
    part def Hall :> Room { part :>> door : Wide; attribute c : Alpha::Color = Alpha::Color::red; }
    part hall : Hall { perform action open : Open { in gate = door; } }
    constraint def Narrow { in g : Alpha::Gate; g.width < 3 }
    assert constraint { hall.door.width > 2 }
}
""",
    "d.sysml": """package Delta {
    private import Gamma::*;
    part big : Hall { part extra : Gate; alias Tor for door; }
    requirement def Safe { subject h : Hall; }
    satisfy requirement safe : Safe by big;
}
""",
}
_WORD = re.compile(r"(?<![\w'])[A-Za-z_]\w*")
_ROOT = re.compile(r"(?<=^package )\w+", re.MULTILINE)
_WORDS = """
    package import private public part def attribute action in out item port connect to first then
    start done alias for metadata enum state constraint assert requirement subject satisfy by
    perform ref doc
"""
_KEYWORDS = frozenset(_WORDS.split())
_MEMBERS = (
    "part # : ~;",
    "attribute ~;",
    "item # :> ~;",
    "part def ~;",
    "part def ~ :> ~ { part ~; }",
    "action # : ~;",
    "part :>> ~;",
    "ref ~;",
    "action def ~ { in x : ~; }",
    "connect ~ to ~;",
    "alias ~ for ~;",
    "@~;",
    "metadata def #;",
    "dependency from ~ to ~;",
    "comment /* # */",
)
_IMPORTS = (
    "private import %::*;",
    "public import %::*;",
    "private import %::~;",
    "private import %::**;",
    "filter @~;",
    "package # { public import %::*; part def ~; }",
    "part # { public import %::*; }",
)


def edited(texts: Mapping[str, str], random: Random) -> Texts:
    """The texts with one of them edited at random."""
    name = random.choice(sorted(texts))
    change = random.choice((_word, _word, _member, _member, _line, _import, _root, _note, _fault))
    return {**texts, name: change(texts[name], texts, random)}


def _words(texts: Mapping[str, str]) -> list[str]:
    found = [word for name in sorted(texts) for word in _WORD.findall(texts[name])]
    return [word for word in found if word not in _KEYWORDS] or ["A"]


def _put(text: str, what: str, at: int) -> str:
    return f"{text[:at]} {what} {text[at:]}"


def _filled(what: str, texts: Mapping[str, str], random: Random) -> str:
    roots = [one for name in sorted(texts) for one in _ROOT.findall(texts[name])]
    what = re.sub("~", lambda _: random.choice(_words(texts)), what)
    what = what.replace("%", random.choice(roots or ["Q"]))
    return what.replace("#", f"x{random.randrange(1000)}")


def _word(text: str, texts: Mapping[str, str], random: Random) -> str:
    """Another name in one place."""
    places = [one for one in _WORD.finditer(text) if one[0] not in _KEYWORDS]
    if not places:
        return text
    one = random.choice(places)
    other = random.choice((random.choice(_words(texts)), f"{one[0]}x"))
    return text[: one.start()] + other + text[one.end() :]


def _member(text: str, texts: Mapping[str, str], random: Random) -> str:
    """One more element somewhere."""
    places = [at for at, sign in enumerate(text, 1) if sign in "{};"]
    return _put(text, _filled(random.choice(_MEMBERS), texts, random), random.choice(places or [0]))


def _line(text: str, texts: Mapping[str, str], random: Random) -> str:
    """One line less, or one of another text more."""
    lines = text.split("\n")
    known = [at for at, line in enumerate(lines) if line.strip().endswith((";", "; }"))]
    if known and random.random() < 0.5:
        del lines[random.choice(known)]
    elif known:
        other = texts[random.choice(sorted(texts))].split("\n")
        lines.insert(random.choice(known), random.choice(other[1:-2] or [""]))
    return "\n".join(lines)


def _import(text: str, texts: Mapping[str, str], random: Random) -> str:
    """One more import, mostly of the package."""
    places = [at for at, sign in enumerate(text, 1) if sign in "{;"] or [0]
    at = places[0] if random.random() < 0.7 else random.choice(places)
    return _put(text, _filled(random.choice(_IMPORTS), texts, random), at)


def _root(text: str, texts: Mapping[str, str], random: Random) -> str:
    """Another name for the package, which may be that of another one."""
    return _ROOT.sub(lambda one: random.choice((f"{one[0]}x", _filled("%", texts, random))), text)


def _note(text: str, _texts: Mapping[str, str], random: Random) -> str:
    """A note that moves all that follows."""
    return _put(text, "\n// a note\n", random.choice([0, *_ends(text)]))


def _fault(text: str, _texts: Mapping[str, str], random: Random) -> str:
    """Now and then something that is no text of SysML."""
    at = random.randrange(len(text))
    return text[:at] + random.choice("};{:") + text[at:] if random.random() < 0.3 else text


def _ends(text: str) -> list[int]:
    return [at for at, sign in enumerate(text, 1) if sign == ";"]
