"""A floor in the text form of the graph, for the explanations of rules."""

_LIBRARY = """\
Package l "Floors"
  Class placed "Placed"
    Property row "row"
    Property column "column"
  Class obstacle "Obstacle"
    -> specializes placed
  Class robot "Robot"
    -> specializes placed
  Class target "Target"
    -> specializes placed
  Class mission "Mission"
  Class floor "Floor"
    Property columns "columns" default=3
    Property rows "rows" default=2
  Association before "Before"
    -> end b1 b2
    Property b1 "earlier"
      -> typed-by target
    Property b2 "later"
      -> typed-by target
  Association carry "Carry"
    -> specializes before
"""
_HALL = """\
Package p "Plant"
  Class hall "Hall" role="block"
    -> specializes floor
    Property h.m "mission" aggregation="composite" role="part"
      -> typed-by m
{parts}
  Class m "Work" role="block"
    -> specializes mission
{targets}
{classes}"""


def placed(name: str, kind: str, row: object, column: object) -> tuple[str, str]:
    """A part and its class, in the cell of the floor."""
    part = f'    Property p.{name} "{name}" aggregation="composite" role="part"\n'
    part += f"      -> typed-by {name}\n"
    values = zip(("row", "column"), (row, column), strict=True)
    given = "".join(
        f'    Property {name}.{feature} "{feature}" default={value}\n      -> redefines {feature}\n'
        for feature, value in values
        if value is not None
    )
    return part, f'  Class {name} "{name}" role="block"\n    -> specializes {kind}\n{given}'


def ordered(earlier: str, later: str, kind: str = "before") -> str:
    """A connector between two targets, of the mission."""
    id = f"{kind}-{earlier}-{later}"
    return f"    Connector {id}\n      -> typed-by {kind}\n      -> end {id}-1 {id}-2\n" + "".join(
        f"      ConnectorEnd {id}-{at}\n        -> role p.{target}\n"
        for at, target in enumerate((earlier, later), 1)
    )


def hall(
    *robots: tuple[str, str], targets: tuple[tuple[str, str], ...] = (), orders: str = ""
) -> str:
    """A floor of two rows and three columns with robots, obstacles and a mission."""
    parts = "".join(part for part, _ in robots).rstrip("\n")
    wanted = "".join(part for part, _ in targets) + orders
    classes = "".join(one for _, one in (*robots, *targets))
    text = _HALL.replace("{parts}\n", f"{parts}\n" if parts else "")
    return _LIBRARY + text.replace("{targets}\n", wanted).replace("{classes}", classes)


def another(name: str) -> str:
    """A second floor behind ``hall``, with the robot ``r1`` and the mission of the first."""
    return f"""\
  Class hall2 "{name}" role="block"
    -> specializes floor
    Property h2.m "mission" aggregation="composite" role="part"
      -> typed-by m
    Property h2.r1 "r1" aggregation="composite" role="part"
      -> typed-by r1
"""
