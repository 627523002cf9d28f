"""Counters of Spectra: reset goes before counting; what happens at the ends is said by a word."""

from collections.abc import Callable, Mapping

from sysmlc.logic import formula as f
from sysmlc.logic.contract import IntegerDomain
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var


def counter_rules(
    name: str, domain: IntegerDomain, parts: Mapping[str, Formula], ends: Mapping[str, str]
) -> list[Formula]:
    """The rules of a counter with conditions ``reset``, ``inc``, ``dec``.

    ``ends`` says for ``overflow`` and ``underflow``: ``keep`` the value, go on at the other end
    (``modulo``), or ``false``: it must not come to that.
    """
    now, then = Var(name), Var(name, primed=True)
    low, high = Const(domain.low), Const(domain.high)
    reset, inc, dec = (parts[one] for one in ("reset", "inc", "dec"))
    counting = f.negate(reset)
    up = f.both(counting, inc, f.negate(dec))
    down = f.both(counting, dec, f.negate(inc))
    return [
        f.implies(reset, f.eq(then, low)),
        f.implies(f.both(counting, f.iff(inc, dec)), f.eq(then, now)),
        f.implies(f.both(up, f.negate(f.eq(now, high))), _moved(name, Op.ADD)),
        f.implies(f.both(up, f.eq(now, high)), _BEYOND[ends["overflow"]](then, high, low)),
        f.implies(f.both(down, f.negate(f.eq(now, low))), _moved(name, Op.SUB)),
        f.implies(f.both(down, f.eq(now, low)), _BEYOND[ends["underflow"]](then, low, high)),
    ]


def _moved(name: str, op: Op) -> Formula:
    return f.eq(Var(name, primed=True), Apply(op, (Var(name), Const(1))))


_BEYOND: dict[str, Callable[[Formula, Formula, Formula], Formula]] = {
    "keep": lambda then, end, other: f.eq(then, end),
    "modulo": lambda then, end, other: f.eq(then, other),
    "false": lambda then, end, other: f.FALSE,
}
