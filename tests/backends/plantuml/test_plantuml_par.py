"""Parametric diagrams, and their division of connectors with internal block diagrams."""

import re

from diagrams import draw_without_style, emit

from sysmlc.ir.text import parse_text

LAW = (
    'Class law "Law" role="constraint block"\n'
    '  Property law.f "f" role="constraint parameter"\n'
    '  Property law.m "m" role="constraint parameter"\n'
    '  Constraint law.c "" body="f = m * a"\n'
)
PARTS = (
    'Class hook "Hook" role="block"\n'
    '  Property hook.mass "mass" role="value"\n    -> typed-by mass\n'
    'DataType mass "Mass" role="value type"\n  -> references kg\n'
    '  Unit kg "kg"\n'
)


def write_model(connectors: str, properties: str = "") -> str:
    """Return a model with a block of a part, a constraint usage, connectors and properties."""
    return (
        LAW
        + PARTS
        + 'Class crane "Crane" role="block"\n'
        + '  Property crane.hook "hook" role="part" aggregation="composite"\n    -> typed-by hook\n'
        + properties
        + '  Property crane.law "e1" role="constraint property" aggregation="composite"\n'
        + "    -> typed-by law\n"
        + connectors
    )


def write_connector(id: str, *ends: str) -> str:
    """Return a binding connector; an end is its path and its role, separated by blanks."""
    lines = [f'  Connector {id} "" role="binding connector"']
    lines += ["    -> end " + " ".join(f"{id}.{n}" for n, _ in enumerate(ends))]
    for number, end in enumerate(ends):
        *path, role = end.split()
        lines += [f"    ConnectorEnd {id}.{number}", f"      -> role {role}"]
        lines += [f"      -> path {' '.join(path)}"] if path else []
    return "\n".join(lines) + "\n"


def draw_text(text: str) -> dict[str, str]:
    """Return the diagrams of a model in IR text."""
    return draw_without_style(parse_text(text))


def list_lines(text: str) -> list[str]:
    return re.findall(r"^\w+ -- \w+$", text, re.MULTILINE)


def test_a_constraint_usage_has_its_parameters_and_its_condition():
    par = draw_text(write_model(""))["Crane.par.puml"]
    assert 'rectangle "<size:10>«constraint»</size>\\ne1 : Law\\n<U+007B>f = m * a}"' in par
    assert re.findall(r'^port "<back:#FFFFFF>(\w)</back>"', par, re.MULTILINE) == ["f", "m"]


def test_a_feature_of_a_part_has_its_path_and_its_unit():
    binding = write_connector("k", "crane.hook hook.mass", "crane.law law.m")
    par = draw_text(write_model(binding))["Crane.par.puml"]
    assert 'rectangle "hook.mass : Mass\\n<U+007B>unit = kg}" as mass_1 <<value>>' in par
    assert list_lines(par) == ["mass_1 -- m_1"]


def test_bindings_of_a_parametric_diagram_are_not_in_the_internal_block_diagram():
    binding = write_connector("k", "crane.hook hook.mass", "crane.law law.m")
    assert list(draw_text(write_model(binding))) == ["Crane.par.puml", "model.bdd.puml"]


def test_a_binding_between_values_stays_in_the_internal_block_diagram():
    value = '  Property crane.w "w" role="value"\n'
    binding = write_connector("k", "crane.hook hook.mass", "crane.w")
    diagrams = draw_text(write_model(binding, value))
    assert "<U+003D>" in diagrams["Crane.ibd.puml"]
    assert list_lines(diagrams["Crane.par.puml"]) == []


def test_a_connector_of_another_owner_is_drawn_with_its_ends():
    other = 'Class other "Other" role="block"\n' + write_connector("k", "law.m", "hook.mass")
    diagrams = draw_text(write_model("") + other)
    assert list_lines(diagrams["Crane.par.puml"]) == ["mass_1 -- m_1"]
    assert "Other.par.puml" not in diagrams


def test_a_connector_that_fits_two_parts_is_drawn_with_its_owner():
    second = '  Property crane.hook2 "hook2" role="part"\n    -> typed-by hook\n'
    other = 'Class other "Other" role="block"\n' + write_connector("k", "law.m", "hook.mass")
    diagrams = draw_text(write_model("", second) + other)
    assert list_lines(diagrams["Crane.par.puml"]) == []
    assert list_lines(diagrams["Other.par.puml"]) == ["mass_1 -- m_1"]


def test_cyclic_parts_terminate_the_search_for_ends():
    loop = (
        'Class node "Node" role="block"\n  Property node.next "next" role="part"\n'
        "    -> typed-by node\n"
    )
    first = '  Property crane.n "n" role="part"\n    -> typed-by node\n'
    other = 'Class other "Other" role="block"\n' + write_connector("k", "law.m", "hook.gone")
    text = loop + write_model("", first) + other + 'Property hook.gone "gone"\n'
    assert list_lines(draw_text(text)["Crane.par.puml"]) == []


def test_a_parametric_model_has_no_diagnostics():
    binding = write_connector("k", "crane.hook hook.mass", "crane.law law.m")
    _, diagnostics = emit(parse_text(write_model(binding)))
    assert diagnostics == []


def test_a_large_diagram_is_split_with_its_bindings():
    text = LAW + 'Class crane "Crane" role="block"\n'
    for number in range(60):
        text += f'  Property u{number} "u{number}" role="constraint property"\n'
        text += "    -> typed-by law\n"
    for number in range(1, 60):
        text += write_connector(f"k{number}", f"u{number - 1} law.f", f"u{number} law.m")
    parts = [part for path, part in draw_text(text).items() if path.endswith(".par.puml")]
    assert len(parts) == 2
    assert all(f"u{number} : " in "".join(parts) for number in range(60))
    assert sum(len(list_lines(part)) for part in parts) >= 59


# -- internal block diagrams -------------------------------------------------------------------


def test_a_connector_with_three_ends_joins_the_first_with_the_others():
    text = (
        'Class a "A" role="block"\n'
        + "".join(
            f'  Property {p} "{p}" role="part" aggregation="composite"\n    -> typed-by b\n'
            for p in ("one", "two", "three")
        )
        + write_connector("k", "one", "two", "three").replace("binding connector", "")
        + 'Class b "B" role="block"\n'
    )
    files, diagnostics = emit(parse_text(text))
    ibd = next(file.text for file in files if file.path.endswith("A.ibd.puml"))
    assert list_lines(ibd) == ["one_1 -- two_1", "one_1 -- three_1"]
    assert diagnostics == []


def test_a_port_nested_in_a_conjugated_port_has_the_opposite_direction():
    nested = (
        'Class inner "Inner" role="interface block"\n'
        'Class outer "Outer" role="interface block"\n'
        '  Port deep "deep" direction="in"\n    -> typed-by inner\n'
        'Class gate "Gate" role="block"\n'
        '  Port door "door" conjugated=true\n    -> typed-by outer\n'
        'Class line "Line" role="block"\n'
        '  Property g "g" role="part" aggregation="composite"\n    -> typed-by gate\n'
        '  Property h "h" role="part" aggregation="composite"\n    -> typed-by gate\n'
        + write_connector("k", "g door deep", "h door deep").replace(
            ' role="binding connector"', ""
        )
    )
    ibd = draw_text(nested)["Line.ibd.puml"]
    assert ibd.count('portout "<back:#FFFFFF>door.deep</back>"') == 2


def test_constraint_parameters_of_magicdraw_are_ports():
    binding = write_connector("k", "crane.hook hook.mass", "crane.law law.m")
    text = write_model(binding).replace("Property law.", "Port law.")
    diagrams = draw_text(text)
    assert list_lines(diagrams["Crane.par.puml"]) == ["mass_1 -- m_1"]
    assert ".. parameters ..\n{field} f\n{field} m\n" in diagrams["model.bdd.puml"]


def test_a_usage_without_a_constraint_block_is_a_row_and_has_no_diagram():
    diagrams = draw_text(write_model("").replace("    -> typed-by law\n", ""))
    assert list(diagrams) == ["model.bdd.puml"]
    assert ".. constraints ..\n{field} e1" in diagrams["model.bdd.puml"]


def test_a_property_specific_type_has_the_name_of_its_general():
    text = (
        'Class gate "Gate" role="block"\n'
        'Class own "" role="block" property_specific=true\n  -> specializes gate\n'
        'Class line "Line" role="block"\n  Property g "g" role="value"\n    -> typed-by own\n'
    )
    assert "g : [Gate]" in draw_text(text)["model.bdd.puml"]
