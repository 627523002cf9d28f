"""Small state machines in IR text, for the explanations of rules."""

_OWNER = """\
Package p "Plant"
  Class c "Gate"
    -> classifier-behavior m
    Property ready "ready"
      -> typed-by bool
    Property level "level" default=0
      -> typed-by int
    Property fixed "fixed" default=3 readonly=true
      -> typed-by int
    Property size "size" default=0
      -> typed-by int
    Constraint k body="0 <= level <= 9"
    Constraint k2 body="0 <= fixed <= 9"
    StateMachine m "Behaviour"
{body}  Signal start "start"
  Signal stop "stop"
  DataType bool "Boolean"
  DataType int "Integer"
"""


def machine(*parts: str) -> str:
    """Return a machine of one region: an initial pseudostate, the states A and B, and the parts."""
    return machine_of(region("r", 'State a "A"\n', 'State b "B"\n', arrow("i", "a"), *parts))


def machine_of(*regions: str) -> str:
    """Return a machine of these regions."""
    return _OWNER.replace("{body}", _indent("".join(regions), 6))


def region(id: str, *parts: str) -> str:
    """Return a region with an initial pseudostate: ``i`` in region ``r``, else ``<id>i``."""
    initial = "i" if id == "r" else f"{id}i"
    inside = f'Pseudostate {initial} subkind="initial"\n' + "".join(parts)
    return f"Region {id}\n{_indent(inside, 2)}"


def state(id: str, *regions: str) -> str:
    """Return a state with regions."""
    return f'State {id} "{id.upper()}"\n' + _indent("".join(regions), 2)


def arrow(
    source: str, target: str, on: str = "", guard: str = "", effect: str = "", after: str = ""
) -> str:
    """Return a transition that a signal (*on*), a time (*after*) or the completion triggers."""
    id = f"{source}-{target}{f'-{on}' if on else ''}{f'-{len(guard)}' if guard else ''}"
    lines = [f"Transition {id}" + (f' guard="{guard}"' if guard else "")]
    lines += [f"  -> flow-source {source}", f"  -> flow-target {target}"]
    if effect:
        lines += [f"  -> effect {id}-e", f'  Activity {id}-e subkind="opaque" body="{effect}"']
    if on:
        lines += [f"  -> trigger {id}-t", f'  Trigger {id}-t subkind="signal"']
        lines += [f"    -> typed-by {on}"]
    if after:
        lines += [f"  -> trigger {id}-w", f'  Trigger {id}-w subkind="time" when="{after}"']
    return "".join(f"{line}\n" for line in lines)


def choice(id: str = "x", kind: str = "choice") -> str:
    """Return a pseudostate, a choice unless *kind* is given."""
    return f'Pseudostate {id} "{id}" subkind="{kind}"\n'


def _indent(text: str, by: int) -> str:
    return "".join(f"{' ' * by}{line}\n" for line in text.splitlines())
