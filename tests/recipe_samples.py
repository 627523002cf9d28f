"""Small recipe models in IR text, for tests and for the explanations of the recipe rules."""


def _quote(text: str) -> str:
    return f'"{text}"'


def flows(*pairs: str) -> str:
    """Return control flows of an activity; each pair is ``source target [guard]``."""
    return "".join(_flow(number, *pair.split(" ", 2)) for number, pair in enumerate(pairs))


def _flow(number: int, source: str, target: str, guard: str = "") -> str:
    words = f" guard={_quote(guard)}" if guard else ""
    return (
        f"    ControlFlow {source}-{target}-{number}{words}\n"
        f"      -> flow-source {source}\n      -> flow-target {target}\n"
    )


RECIPE = """\
Package p "Plant"
  Class robot "Robot" level="machine"
  Activity r "Build" level="recipe"
    Control r.i "start" subkind="initial"
    Action r.a "mill" subkind="call-behavior"
      -> calls mill
    Action r.b "drill" subkind="call-behavior"
      -> calls drill
    Control r.f "end" subkind="final"
{flows}  Activity mill "Mill" level="task"
  Activity drill "Drill" level="task"
  Dependency mill.on role="allocate"
    -> client mill
    -> supplier {supplier}
  Dependency drill.on role="allocate"
    -> client drill
    -> supplier robot
"""
"""Two tasks in a row on one machine."""

ORDER = ("r.i r.a", "r.a r.b", "r.b r.f")

TASK = """\
Package p "Plant"
  Class robot "Robot" level="machine"
  Class camera "Camera" level="machine"
  Class plate "Plate" level="material"
  Activity r "Build" level="recipe"
    Action r.a "mount" subkind="call-behavior"
      -> calls mount
      Pin r.a.in "plate" direction="in"
        -> typed-by plate
    ObjectNode r.plate "plate"
      -> typed-by plate
    ObjectFlow r.plate-a weight="{have}"
      -> flow-source r.plate
      -> flow-target r.a.in
  Activity mount "Mount" level="task"
    Property mount.ok "ok"{ok}
      -> typed-by Boolean
    Property mount.n "n" default=0
      -> typed-by Integer
{nodes}{flows}  Activity grip "Grip" level="machine service"
    Parameter grip.plate "plate" direction="in" multiplicity="{need}"
      -> typed-by plate
    Action grip.c "close" subkind="call-behavior"
      -> calls close
  Activity place "Place" level="machine service"
    Action place.o "open" subkind="call-behavior"
      -> calls open
  Activity look "Look" level="infrastructure service"
    Application look.s stereotype="InfrastructureService" namespace="urn:sysmlc:profile:1" \
tag.duration="100"
      -> subject look
    Parameter look.ok "ok" direction="out"
      -> typed-by Boolean
  Activity close "Close" level="machine function"
    Application close.f stereotype="MachineFunction" namespace="urn:sysmlc:profile:1" \
tag.duration="{close}" tag.acquire="gripper"
      -> subject close
  Activity open "Open" level="machine function"
    Application open.f stereotype="MachineFunction" namespace="urn:sysmlc:profile:1" \
tag.duration="200" tag.release="{release}"
      -> subject open
  Dependency mount.on role="allocate"
    Application mount.on.c stereotype="Capability" namespace="urn:sysmlc:profile:1" \
tag.duration="{mount}"
      -> subject mount.on
    -> client mount
    -> supplier {supplier}
  Dependency grip.on
    Application grip.on.c stereotype="Capability" namespace="urn:sysmlc:profile:1" \
tag.duration="300"
      -> subject grip.on
    Application grip.on.o stereotype="OpcUaCall" namespace="urn:sysmlc:profile:1" \
tag.object="ns=2;s=Robot" tag.method="ns=2;s=Grip"{uri}
      -> subject grip.on
    -> client grip
    -> supplier robot
  Dependency place.on
    Application place.on.c stereotype="Capability" namespace="urn:sysmlc:profile:1" \
tag.duration="200"
      -> subject place.on
    -> client place
    -> supplier {place}
  DataType Boolean "Boolean"
  DataType Integer "Integer"
"""
"""A task of services of machine functions, on a robot, with a material and an OPC UA call."""

NODES = """\
    Control s "start" subkind="initial"
    Action g "grip" subkind="call-behavior"
      -> calls grip
    Action l "look" subkind="call-behavior"
      -> calls look
      Pin l.ok "ok" direction="out"
        -> typed-by Boolean
    Control d "good?" subkind="decision"
    Action a "place" subkind="call-behavior"
      -> calls place
    Action b "drop" subkind="call-behavior"
      -> calls place
    Control m "after" subkind="merge"
    Control e "end" subkind="final"
"""

STEPS = ("s g", "g l", "l d", "d a ok", "d b else", "a m", "b m", "m e")


def task(nodes: str = NODES, steps: tuple[str, ...] = STEPS, **parts: str) -> str:
    """Return the sample with a task; *parts* replace the values of a model without faults."""
    defaults = {
        "have": "1",
        "need": "1",
        "ok": "",
        "close": "300",
        "release": "gripper",
        "mount": "600",
        "supplier": "robot",
        "uri": ' tag.namespaceUri="urn:robot"',
        "place": "robot",
    }
    return TASK.format(nodes=nodes, flows=flows(*steps), **{**defaults, **parts})


def recipe(*order: str, supplier: str = "robot") -> str:
    """Return the sample with two tasks; flows and the supplier of the first may differ."""
    return RECIPE.format(flows=flows(*(order or ORDER)), supplier=supplier)


def _with_owned_function() -> str:
    """Return the task sample; the robot owns the function ``close`` and is not marked a machine."""
    before, mark, rest = task().partition('  Activity close "Close"')
    function, open_, after = rest.partition('  Activity open "Open"')
    inner = "".join(f"  {line}\n" for line in (mark + function).splitlines())
    machines, camera = '  Class robot "Robot" level="machine"\n', '  Class camera "Camera"'
    outer = before.replace(machines, f'  Class robot "Robot"\n{inner}')
    return outer.replace(f'{camera} level="machine"\n', f"{camera}\n") + open_ + after


OWNED_FUNCTION = _with_owned_function()
"""A model in which only a machine function shows that the robot is a machine."""
