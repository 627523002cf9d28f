"""Families of hostile models: each function writes a model whose size grows with its argument."""

from collections.abc import Callable

Family = Callable[[int], str]


def nested_packages(size: int) -> str:
    """Packages inside one another."""
    return "package P { " * size + "part def A;" + " }" * size


def generalisation_chain(size: int) -> str:
    """Each definition specialises the one before it and types a part."""
    lines = [
        f"part def A{i} :> A{i - 1} {{ attribute x{i}; part b{i} : A{i - 1}; }}"
        for i in range(1, size)
    ]
    return "\n".join(["package P {", "part def A0;", *lines, "}"])


def specialisation_chain(size: int) -> str:
    """Each definition specialises the one before it; nothing is inherited."""
    lines = [f"part def A{i} :> A{i - 1};" for i in range(1, size)]
    return "\n".join(["package P {", "part def A0;", *lines, "}"])


def generalisation_circle(size: int) -> str:
    """Definitions that specialise one another in a circle."""
    lines = [f"part def A{i} :> A{(i + 1) % size} {{ attribute x{i}; }}" for i in range(size)]
    return "\n".join(["package P {", *lines, "}"])


def generalisation_diamonds(size: int) -> str:
    """Two definitions at each level, both specialising both of the level above: 2**size paths."""
    lines = [
        f"part def {name}{i} :> A{i - 1}, B{i - 1} {{ attribute {name.lower()}{i}; }}"
        for i in range(1, size)
        for name in "AB"
    ]
    return "\n".join(["package P {", "part def A0;", "part def B0;", *lines, "}"])


def import_circle(size: int) -> str:
    """Packages that import one another in a circle, with a reference to the most distant one."""
    lines = [
        f"package P{i} {{ public import P{(i + 1) % size}::*; part def A{i}; "
        f"part b{i} : A{(i - 1) % size}; }}"
        for i in range(size)
    ]
    return "\n".join(lines)


def alias_chain(size: int) -> str:
    """Aliases of aliases."""
    lines = [f"alias A{i} for A{i - 1};" for i in range(1, size)]
    return "\n".join(["package P {", "part def A0;", *lines, f"part a : A{size - 1};", "}"])


def huge_enumeration(size: int) -> str:
    """An enumeration with many literals, one of which a state machine compares."""
    literals = " ".join(f"enum l{i};" for i in range(size))
    return f"""package P {{
        enum def E {{ {literals} }}
        item def Go;
        part def A {{
            attribute e : E;
            exhibit state m {{
                entry; then a;
                state a; state b;
                transition first a accept Go if e == E::l1 do assign e := E::l0 then b;
                transition first b accept Go if e == E::l0 then a;
            }}
        }}
    }}"""


def parallel_regions(size: int) -> str:
    """Parallel regions whose transitions all react to one event and write their own property."""
    properties = "\n".join(
        f"attribute x{i} : ScalarValues::Integer; assert constraint {{ 0 <= x{i} and x{i} <= 3 }}"
        for i in range(size)
    )
    regions = "\n".join(
        f"""state r{i} {{
            entry; then a; state a; state b;
            transition first a accept Go if x{i} == 0 do assign x{i} := 1 then b;
            transition first b accept Go if x{i} == 1 do assign x{i} := 0 then a;
        }}"""
        for i in range(size)
    )
    return f"""package P {{
        item def Go;
        part def A {{ {properties} exhibit state m parallel {{ {regions} }} }}
    }}"""


def guarded_transitions(size: int) -> str:
    """Transitions that leave one state on one event, with guards that exclude one another."""
    transitions = "\n".join(
        f"transition first a accept Go if x == {i % 60} and y == {i // 60} then a;"
        for i in range(size)
    )
    return f"""package P {{
        item def Go;
        part def A {{
            attribute x : ScalarValues::Integer; assert constraint {{ 0 <= x and x <= 60 }}
            attribute y : ScalarValues::Integer; assert constraint {{ 0 <= y and y <= 60 }}
            exhibit state m {{ entry; then a; state a; {transitions} }}
        }}
    }}"""


def plain_transitions(size: int) -> str:
    """Transitions between two states without trigger and guard."""
    transitions = "\n".join("transition first a then b;" for _ in range(size))
    return f"""package P {{
        part def A {{ exhibit state m {{ entry; then a; state a; state b; {transitions} }} }}
    }}"""


def choice_chain(size: int) -> str:
    """Consecutive branches on the path of one transition: 2**size paths."""
    decisions = "\n".join(
        f"decide d{i}; if x == {i} then e{i}; else m{i}; "
        f"action e{i}; then m{i}; merge m{i}; then d{i + 1};"
        for i in range(size)
    )
    return f"""package P {{
        part def A {{
            attribute x : ScalarValues::Integer; assert constraint {{ 0 <= x and x <= 60 }}
            action run {{ first start; then d0; {decisions} action d{size}; then done; }}
        }}
    }}"""


def nested_expression(size: int) -> str:
    """An expression in parentheses inside one another."""
    return (
        "package P { part def A { attribute x : ScalarValues::Integer; attribute y : "
        "ScalarValues::Integer = " + "(x + " * size + "1" + ")" * size + "; } }"
    )


def long_expression(size: int) -> str:
    """An expression with many operators, as the guard of a transition."""
    terms = " or ".join(f"x == {i % 50}" for i in range(size))
    return f"""package P {{
        item def Go;
        part def A {{
            attribute x : ScalarValues::Integer; assert constraint {{ 0 <= x and x <= 60 }}
            exhibit state m {{
                entry; then a; state a; state b;
                transition first a accept Go if {terms} then b;
            }}
        }}
    }}"""


def connector_ends(size: int) -> str:
    """One connector with many ends."""
    parts = " ".join(f"part b{i} : B;" for i in range(size))
    ends = ", ".join(f"b{i}.p" for i in range(size))
    block = "part def B { port p : Q; }"
    return f"package P {{ port def Q; {block} part def A {{ {parts} connect ({ends}); }} }}"


def ports_of_one_part(size: int) -> str:
    """Many ports of one part, each connected to one other part."""
    ports = " ".join(f"port p{i} : Q;" for i in range(size))
    connectors = " ".join(f"connect b.p{i} to c.p{i};" for i in range(size))
    return (
        f"package P {{ port def Q; part def B {{ {ports} }} "
        f"part def A {{ part b : B; part c : B; {connectors} }} }}"
    )


def doubled_parts(size: int) -> str:
    """Each block has two parts of the next one: 2**size parts in all."""
    lines = [f"part def A{i} {{ part b : A{i + 1}; part c : A{i + 1}; }}" for i in range(size)]
    return "\n".join(["package P {", *lines, f"part def A{size};", "}"])


def doubled_actions(size: int) -> str:
    """Each action performs the next one twice: 2**size steps in all."""
    lines = [
        f"action def A{i} {{ first start; then action b : A{i + 1}; then action c : A{i + 1}; "
        "then done; }"
        for i in range(size)
    ]
    return "\n".join(["package P {", *lines, f"action def A{size};", "}"])


def fork_and_join(size: int) -> str:
    """A fork into many branches that a join brings together."""
    branches = "\n".join(f"then a{i};" for i in range(size))
    actions = "\n".join(f"action a{i}; then j;" for i in range(size))
    return f"""package P {{
        part def A {{
            action run {{ first start; then f; fork f; {branches} {actions} join j; then done; }}
        }}
    }}"""


def requirements(size: int) -> str:
    """Requirements that mention one another, all satisfied by one part."""
    lines = [
        f"requirement def R{i} {{ subject a : A; require constraint {{ a.x <= {i} }} "
        f"requirement r : R{(i + 1) % size}; }} satisfy requirement s{i} : R{i} by p;"
        for i in range(size)
    ]
    return "\n".join(
        [
            "package P {",
            "part def A { attribute x : ScalarValues::Integer; }",
            "part p : A;",
            *lines,
            "}",
        ]
    )


def small_packages(size: int) -> str:
    """Packages of one line, each with three blocks and a diagram."""
    lines = []
    for i in range(size):
        following = (i + 1) % size
        block = f"part def B{i} {{ part a : P{following}::A{following}; }}"
        lines.append(f"package P{i} {{ part def A{i}; {block} part def C{i} :> A{i}; }}")
    return "\n".join(lines)


def redefinitions(size: int) -> str:
    """A chain of definitions, each of which redefines the feature of the one before it."""
    lines = [
        f"part def A{i} :> A{i - 1} {{ attribute :>> x = {i}; attribute y{i} :>> y{i - 1}; }}"
        for i in range(1, size)
    ]
    head = "part def A0 { attribute x; attribute y0; }"
    return "\n".join(["package P {", head, *lines, "}"])


_XMI = (
    '<?xml version="1.0" encoding="UTF-8"?>\n<uml:Model xmi:version="20131001"'
    ' xmlns:xmi="http://www.omg.org/spec/XMI/20131001"'
    ' xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML" xmi:id="m" name="M">\n'
)


def xmi_hrefs(size: int) -> str:
    """Properties and generalisations that refer to files that do not exist."""
    rows = [
        f'<ownedAttribute xmi:type="uml:Property" xmi:id="p{i}" name="p{i}">'
        f'<type xmi:type="uml:Class" href="gone{i}.uml#c{i}"/></ownedAttribute>'
        f'<generalization xmi:type="uml:Generalization" xmi:id="g{i}">'
        f'<general xmi:type="uml:Class" href="gone.uml#_{i}"/></generalization>'
        for i in range(size)
    ]
    body = '<packagedElement xmi:type="uml:Class" xmi:id="c" name="C">' + "\n".join(rows)
    return _XMI + body + "</packagedElement></uml:Model>\n"


def xmi_classes_of_one_name(size: int) -> str:
    """Classes of one name, each with a part of the next."""
    rows = [
        f'<packagedElement xmi:type="uml:Class" xmi:id="c{i}" name="C"><ownedAttribute '
        f'xmi:type="uml:Property" xmi:id="p{i}" name="p" type="c{(i + 1) % size}" '
        'aggregation="composite"/></packagedElement>'
        for i in range(size)
    ]
    return _XMI + "\n".join(rows) + "</uml:Model>\n"


_CAEX = (
    '<?xml version="1.0" encoding="utf-8"?>\n<CAEXFile SchemaVersion="3.0" FileName="x.aml"'
    ' xmlns="http://www.dke.de/CAEX">\n<InstanceHierarchy Name="H">\n'
)


def _uuid(number: int) -> str:
    return f"00000000-0000-4000-8000-{number:012x}"


def aml_mirrors(size: int) -> str:
    """Mirrors of one element with many attributes, and mirrors of mirrors."""
    attributes = "".join(f'<Attribute Name="a{i}"/>' for i in range(size))
    rows = [
        f'<InternalElement Name="m{i}" ID="{_uuid(i)}" RefBaseSystemUnitPath="{_uuid(i - 1)}"/>'
        for i in range(1, size)
    ]
    first = f'<InternalElement Name="m0" ID="{_uuid(0)}">{attributes}</InternalElement>'
    return _CAEX + first + "\n".join(rows) + "</InstanceHierarchy></CAEXFile>\n"


def aml_nesting(size: int) -> str:
    """Elements inside one another, each with an interface that is linked to its parent's."""
    start_tags = "".join(
        f'<InternalElement Name="e{i}" ID="{_uuid(i)}"><ExternalInterface Name="i" '
        f'ID="{_uuid(size + i)}"/>'
        for i in range(size)
    )
    return _CAEX + start_tags + "</InternalElement>" * size + "</InstanceHierarchy></CAEXFile>\n"


FAMILIES: dict[Family, tuple[str, int]] = {
    nested_packages: ("nested.sysml", 50),
    generalisation_chain: ("chain.sysml", 50),
    specialisation_chain: ("specialisations.sysml", 200),
    generalisation_circle: ("circle.sysml", 50),
    generalisation_diamonds: ("diamonds.sysml", 25),
    import_circle: ("imports.sysml", 50),
    alias_chain: ("aliases.sysml", 100),
    huge_enumeration: ("enumeration.sysml", 200),
    parallel_regions: ("regions.sysml", 8),
    guarded_transitions: ("guards.sysml", 15),
    plain_transitions: ("transitions.sysml", 50),
    choice_chain: ("choices.sysml", 8),
    nested_expression: ("nested_expression.sysml", 50),
    long_expression: ("long_expression.sysml", 50),
    connector_ends: ("ends.sysml", 50),
    ports_of_one_part: ("ports.sysml", 100),
    doubled_parts: ("doubled_parts.sysml", 8),
    doubled_actions: ("doubled_actions.sysml", 8),
    fork_and_join: ("forks.sysml", 8),
    requirements: ("requirements.sysml", 25),
    small_packages: ("packages.sysml", 200),
    redefinitions: ("redefinitions.sysml", 50),
    xmi_hrefs: ("hrefs.uml", 100),
    xmi_classes_of_one_name: ("names.uml", 100),
    aml_mirrors: ("mirrors.aml", 50),
    aml_nesting: ("nesting.aml", 50),
}
"""The families, with a file name and the smallest size that is measured."""

LINEAR_FAMILIES = {specialisation_chain}
"""The families whose cost grows at most with their size."""
