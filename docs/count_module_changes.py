"""Count how often a reader changes the module who follows a value through the compiler.

Run ``python docs/count_module_changes.py`` for the numbers and ``... guard`` for each change of one
walk. A number in a small model is the value: 4711 in a guard, in a requirement, or as the duration
of a machine function. The script compiles the model and watches the calls: a function is on the way
if an argument is the value or directly contains it, as a text, a token, or a node of a syntax tree
does. A change of module is a call of such a function from another module; calls of the same
function from the same module count once.
"""

import sys
from collections.abc import Callable
from types import FrameType

import sysmlc

NUMBER = 4711

MACHINE = """
package Plant {{
    item def Go;
    part def Tank {{
        attribute level : ScalarValues::Integer;
        assert constraint {{ 4700 <= level and level <= 4715 }}
        exhibit state life {{
            entry; then shut;
            state shut;
            transition first shut accept Go {guard} then open;
            state open;
        }}
    }}
    {requirement}
}}
"""
REQUIREMENT = """
    requirement def StaysShut {
        subject tank : Tank;
        require constraint { language "ltl" /* G (level < 4711 -> state=shut) */ }
    }
"""
RECIPE = """
package Plant {
    private import RecipeLevels::*;
    part def Robot :> Machine;
    action def Close :> MachineFunction { attribute :>> duration = 4711; }
    action def Grip :> MachineService { first start then close; action close : Close; then done; }
    action def Build :> Task { first start then grip; action grip : Grip; then done; }
    action def Make :> Recipe { first start then build; action build : Build; then done; }
    dependency from Grip to Robot { @Capability; }
}
"""


def compile_text(text: str, *emit: str) -> sysmlc.Compilation:
    """Compile a text in SysML v2 in memory, with the outputs of these back ends."""
    return sysmlc.compile_texts({"plant.sysml": text}, emit=emit)


GUARDED = MACHINE.format(guard="if level < 4711", requirement="")
REQUIRED = MACHINE.format(guard="", requirement=REQUIREMENT)
WALKS: dict[str, Callable[[], object]] = {
    "guard": lambda: compile_text(GUARDED),
    "requirement": lambda: sysmlc.check_contracts(compile_text(REQUIRED)),
    "recipe": lambda: compile_text(RECIPE, "recipe"),
}


def has_number(value: object, depth: int = 1) -> bool:
    """Whether *value* is the number or a text with it, or an item or field is, down to *depth*."""
    if isinstance(value, str | bytes):
        return str(NUMBER) in (value if isinstance(value, str) else value.decode(errors="replace"))
    if isinstance(value, int | float):
        return value == NUMBER
    if depth == 0 or isinstance(value, type):
        return False
    if isinstance(value, dict):
        value = value.values()
    elif not isinstance(value, list | tuple | set | frozenset):
        fields = getattr(type(value), "__match_args__", ())
        value = [getattr(value, field, None) for field in fields]
    return any(has_number(item, depth - 1) for item in value)


def list_changes(walk: Callable[[], object]) -> list[tuple[str, str]]:
    """Return the changes of module: the calling module, and the called function with its module."""
    changes: dict[tuple[str, str], None] = {}

    def observe(frame: FrameType, event: str, _: object) -> None:
        module, code = frame.f_globals.get("__name__", ""), frame.f_code
        if event != "call" or not module.startswith("sysmlc.") or code.co_name == "<module>":
            return
        caller = frame.f_back
        while caller and not caller.f_globals.get("__name__", "").startswith("sysmlc."):
            caller = caller.f_back
        change = caller.f_globals["__name__"] if caller else "", f"{module}.{code.co_qualname}"
        if change[0] == module or change in changes:
            return
        parameters = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
        if any(has_number(frame.f_locals.get(parameter)) for parameter in parameters):
            changes[change] = None

    sys.setprofile(observe)
    try:
        walk()
    finally:
        sys.setprofile(None)
    return list(changes)


def main(names: list[str]) -> None:
    """Print the number of changes of each walk, or the changes of the walks with these names."""
    for name in names or WALKS:
        changes = list_changes(WALKS[name])
        print(f"{name}: {len(changes)} changes of module")
        if names:
            print(*(f"  {source} -> {target}" for source, target in changes), sep="\n")


if __name__ == "__main__":
    main(sys.argv[1:])
