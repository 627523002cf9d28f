"""Names of members: those of the model where they are free in their namespace, else made."""

from collections import Counter

from sysmlc.backends.sysml.entry import Entry, Plan
from sysmlc.backends.sysml.library import ROOTS
from sysmlc.backends.sysml.rules import RENAMED
from sysmlc.backends.sysml.words import writable
from sysmlc.ir import Kind


def name_all(plan: Plan) -> None:
    """Give every member a name of its own in its namespace, if it needs one."""
    taken = dict.fromkeys(ROOTS)
    shipped = {one.name: one for one in plan.shipped}
    plan.globals = _name(plan, plan.tops, {*taken, *shipped}) | shipped
    stack = list(plan.tops)
    while stack:
        top = stack.pop()
        _name(plan, top.members, set(top.shape.reserved))
        stack.extend(top.members)


def _name(plan: Plan, members: list[Entry], taken: set[str]) -> dict[str, Entry]:
    """Give each member a name of its own; definitions that are second start with a capital."""
    named: dict[str, Entry] = {}
    numbers: Counter[str] = Counter()
    wanting = [one for one in members if one.shape.is_named and not one.name]
    for one in members:
        if one.name:
            one.name = _free(plan, one, writable(one.name), taken, numbers)
            taken.add(one.name)
            named[one.name] = one
    for one in wanting:
        one.name = _made(one, taken, numbers)
        taken.add(one.name)
        named[one.name] = one
    return named


def _free(plan: Plan, entry: Entry, name: str, taken: set[str], numbers: Counter[str]) -> str:
    if name not in taken:
        return name
    capital = name[:1].upper() + name[1:]
    if entry.shape.is_definition and capital not in taken:
        found = capital
    else:
        numbers[f"{name}_"] = max(numbers[f"{name}_"], 1)
        found = _numbered(f"{name}_", taken, numbers)
    if entry.element is not None:
        plan.losses.note(RENAMED, entry.element, name=name, written=found)
    return found


def _numbered(base: str, taken: set[str], numbers: Counter[str]) -> str:
    """The first name of its kind that is not taken; ``numbers`` are those given last."""
    numbers[base] += 1
    while f"{base}{numbers[base]}" in taken:
        numbers[base] += 1
    return f"{base}{numbers[base]}"


def _made(entry: Entry, taken: set[str], numbers: Counter[str]) -> str:
    """A name for what has none: of what it is typed by, else of what it is."""
    element = entry.element
    is_return = element is not None and element.attrs.get("direction") == "return"
    if is_return and "result" not in taken:
        return "result"
    words = entry.shape.plain.split()
    base = words[0] + "".join(word.capitalize() for word in words[1:])
    if element is not None and element.kind in (Kind.PARAMETER, Kind.PIN):
        base = str(element.attrs.get("direction", "in"))
        base = {"in": "input", "out": "output", "return": "result"}.get(base, base)
    if element is not None and element.subkind and element.kind in (Kind.ACTION, Kind.PSEUDOSTATE):
        first, *rest = element.subkind.split("-")
        base = first + "".join(word.capitalize() for word in rest)
    if entry.shape.is_definition:
        base = base[:1].upper() + base[1:]
    return _numbered(base, taken, numbers)
