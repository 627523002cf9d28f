"""Checks of blocks with parts: whether the parts fit together, and keep what the block promises."""

from collections.abc import Iterable, Iterator

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.logic.composite import Composite
from sysmlc.logic.contract import Conjunct
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis.algebra.apart import apart, is_joined
from sysmlc.synthesis.algebra.composition import Composition, DriverError, composition
from sysmlc.synthesis.algebra.discharge import Open
from sysmlc.synthesis.algebra.relations import Failure
from sysmlc.synthesis.algebra.systems import DomainError
from sysmlc.synthesis.algebra.traces import Trace
from sysmlc.synthesis.bdd.manager import LimitError
from sysmlc.synthesis.check import new_manager, said, why_not
from sysmlc.synthesis.decide import Options, Place
from sysmlc.synthesis.games.game import OutsideGr1Error
from sysmlc.synthesis.witness import Party, Witness, lines
from sysmlc.values import dataclass


def _cell(feeds: str, takes: str = "assume G F ready", whole: str = "G F taken") -> str:
    """A cell of a feeder and a picker in SysML v2, each with what is required of it."""
    return f"""\
package Line {{
    private import ScalarValues::*;
    part def Feeder {{ out attribute ready : Boolean; }}
    part def Picker {{ in attribute ready : Boolean; out attribute taken : Boolean; }}
    part def Cell {{
        out attribute taken : Boolean;
        part feeder : Feeder;
        part picker : Picker;
        bind feeder.ready = picker.ready;
        bind picker.taken = taken;
    }}
    requirement def Feeds {{
        subject feeder : Feeder;
        require constraint {{ language "ltl" /* {feeds} */ }}
    }}
    requirement def Takes {{
        subject picker : Picker;
        assume constraint {{ language "ltl" /* {takes.removeprefix("assume ")} */ }}
        require constraint {{ language "ltl" /* G F taken */ }}
    }}
    requirement def Works {{
        subject cell : Cell;
        require constraint {{ language "ltl" /* {whole} */ }}
    }}
}}
"""


OPEN = rule(
    "SM595",
    "part-assumption-open",
    Severity.ERROR,
    "part '{part}' of '{component}' assumes '{formula}', which nothing around it promises{said}",
    why="A part keeps its contract only in an environment that keeps the part's assumptions: the "
    "other parts, and what the block itself assumes.",
    help="let another part promise it, let the block assume it, or let the part do without it; the "
    "run shows what happens",
    wrong=_cell("G F !ready"),
    right=_cell("G F ready"),
)
CIRCLE = rule(
    "SM596",
    "parts-wait-for-one-another",
    Severity.WARNING,
    "part '{part}' of '{component}' assumes '{formula}', kept by others only after it{said}",
    why="What recurs cannot be promised by two parts that each wait for the other: nobody begins.",
    help="let one of the parts begin: promise it without that assumption",
    wrong=_cell("G F ready")
    .replace(
        'require constraint { language "ltl" /* G F ready */ }',
        'assume constraint { language "ltl" /* G F taken */ }\n'
        '        require constraint { language "ltl" /* G F ready */ }',
    )
    .replace("part def Feeder { ", "part def Feeder { in attribute taken : Boolean; ")
    .replace(
        "bind picker.taken = taken;",
        "bind picker.taken = taken;\n        bind picker.taken = feeder.taken;",
    ),
    right=_cell("G F ready"),
)
BREAK = rule(
    "SM597",
    "parts-break-whole",
    Severity.ERROR,
    "the parts of '{component}' together do not keep '{formula}'{said}",
    why="What a block promises has to follow from what its parts promise together.",
    help="let a part promise more, or the block less; the run shows what happens",
    wrong=_cell("G F ready", whole="G (taken -> X !taken)"),
    right=_cell("G F ready", whole="G F taken"),
)
CONTRADICT = rule(
    "SM548",
    "parts-contradict",
    Severity.ERROR,
    "there is no run in which all parts of '{component}' keep what they promise",
    why="Everything follows of what cannot be: nothing can be said of parts that contradict one "
    "another.",
    help="change one of the promises, or what joins the parts",
    wrong=_cell("G F ready")
    .replace("G F ready */ }", "G !ready */ }", 1)
    .replace("G F taken */ }", "G (ready & F taken) */ }", 1),
    right=_cell("G F ready"),
)
NOT_COMPOSED = rule(
    "SM598",
    "parts-not-composed",
    Severity.WARNING,
    "the parts of '{component}' are not put together: {reason}",
    why="Only contracts in GR(1), or that history bits bring there, are composed, within the "
    "limits of time and memory.",
    help="give more time (--time-limit), or say it in the patterns that are known",
    wrong=_cell("F G ready"),
    right=_cell("G F ready"),
)


@dataclass(frozen=True, slots=True)
class Together:
    """What was found out about a block with parts."""

    component: str
    parts: int
    has_whole: bool
    """Whether the block itself promises something."""
    is_joined: bool
    """Whether any of the parts has to do with another, or with the block."""
    is_kept: bool | None
    """Whether the parts fit together and keep what the block promises; None when undecided."""
    witnesses: tuple[Witness, ...] = ()

    def text(self) -> str:
        """The verdict on one line."""
        return f"{self.component}: {self._verdict()}"

    def _verdict(self) -> str:
        if self.is_kept is None:
            return "its parts are not put together"
        if self.has_whole and self.is_joined:
            verb = "keep" if self.is_kept else "break"
            return f"its {self.parts} parts together {verb} its contract"
        if self.is_kept and not self.is_joined:
            return f"nothing joins its {self.parts} parts"
        return f"its {self.parts} parts {'fit' if self.is_kept else 'do not fit'} together"


def check_together(
    composites: Iterable[Composite], place: Place, sink: Sink, options: Options
) -> Iterator[Together]:
    """Compose the parts of each block; what is open and what is broken is reported."""
    for one in composites:
        found = [(group, _composed(group, place, sink, options)) for group in _questions(one)]
        made = [(group, each) for group, each in found if each is not None]
        is_broken = any(each.open or each.failures or each.conflict for _, each in made)
        kept = None if len(made) < len(found) and not is_broken else not is_broken
        witnesses = tuple(w for group, each in made for w in _witnesses(group, each))
        has_whole, joined = one.whole is not None, is_joined(one)
        yield Together(one.component, len(one.parts), has_whole, joined, kept, witnesses)


def _questions(composite: Composite) -> list[Composite]:
    """What has to be composed: a part alone fits, where the block promises nothing."""
    groups = apart(composite)
    return [one for one in groups if len(one.parts) > 1 or one.whole is not None]


def _composed(
    composite: Composite, place: Place, sink: Sink, options: Options
) -> Composition | None:
    try:
        found = composition(composite, new_manager(options)())
    except (OutsideGr1Error, DomainError, DriverError, LimitError) as problem:
        subject, reason = place(composite.origin), why_not(problem)
        sink.report(NOT_COMPOSED, subject, component=composite.component, reason=reason)
        return None
    if found.conflict:
        _report_conflict(composite, found, place, sink)
    for one in found.open:
        _report_open(composite, one, place, sink)
    for failure in found.failures:
        _report_broken(composite, failure, place, sink)
    return found


def _report_conflict(composite: Composite, found: Composition, place: Place, sink: Sink) -> None:
    names = {one: part.name for part in composite.parts for one in part.contract.guarantees}
    notes = (
        f"{names.get(one, composite.component)}: '{print_formula(one.formula)}'{said(one)}"
        for one in found.conflict
    )
    subject = place(composite.origin)
    sink.report(CONTRADICT, subject, notes=tuple(notes), component=composite.component)


def _report_open(composite: Composite, one: Open, place: Place, sink: Sink) -> None:
    sink.report(
        CIRCLE if one.is_circular else OPEN,
        place(one.conjunct.origin or one.part.origin),
        notes=() if one.trace is None else tuple(lines(one.trace, one.conjunct)),
        part=one.part.name,
        component=composite.component,
        formula=print_formula(one.conjunct.formula),
        said=said(one.conjunct),
    )


def _report_broken(composite: Composite, failure: Failure, place: Place, sink: Sink) -> None:
    sink.report(
        BREAK,
        place(failure.conjunct.origin or composite.origin),
        notes=tuple(lines(failure.trace, failure.conjunct)),
        component=composite.component,
        formula=print_formula(failure.conjunct.formula),
        said=said(failure.conjunct),
    )


def _witnesses(composite: Composite, found: Composition) -> Iterator[Witness]:
    parties = tuple(Party(one.name, one.contract) for one in composite.parts)
    for one in found.open:
        if one.trace is not None:
            yield _witness(composite, one.conjunct, one.trace, parties)
    for failure in found.failures:
        yield _witness(composite, failure.conjunct, failure.trace, parties)


def _witness(
    composite: Composite, broken: Conjunct, trace: Trace, parties: tuple[Party, ...]
) -> Witness:
    return Witness(composite.component, broken, trace, parties)
