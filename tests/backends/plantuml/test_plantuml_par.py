"""Parametric diagrams, and what internal block diagrams leave to them."""

import re

from diagrams import emitted, texts

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


def block(connectors: str, more: str = "") -> str:
    return (
        LAW
        + PARTS
        + 'Class crane "Crane" role="block"\n'
        + '  Property crane.hook "hook" role="part" aggregation="composite"\n    -> typed-by hook\n'
        + more
        + '  Property crane.law "e1" role="constraint property" aggregation="composite"\n'
        + "    -> typed-by law\n"
        + connectors
    )


def connector(id: str, *ends: str, owner: str = "  ") -> str:
    """A binding connector; an end is its path and its role, separated by blanks."""
    lines = [f'{owner}Connector {id} "" role="binding connector"']
    lines += [f"{owner}  -> end " + " ".join(f"{id}.{n}" for n, _ in enumerate(ends))]
    for number, end in enumerate(ends):
        *path, role = end.split()
        lines += [f"{owner}  ConnectorEnd {id}.{number}", f"{owner}    -> role {role}"]
        lines += [f"{owner}    -> path {' '.join(path)}"] if path else []
    return "\n".join(lines) + "\n"


def drawn(text: str) -> dict[str, str]:
    """Diagrams without their style, by file."""
    return {name: one.partition("</style>")[2] for name, one in texts(parse_text(text)).items()}


def lines(text: str) -> list[str]:
    return re.findall(r"^\w+ -- \w+$", text, re.MULTILINE)


def test_a_usage_shows_its_parameters_and_its_condition():
    par = drawn(block(""))["Crane.par.puml"]
    assert 'rectangle "<size:10>«constraint»</size>\\ne1 : Law\\n<U+007B>f = m * a}"' in par
    assert re.findall(r'^port "<back:#FFFFFF>(\w)</back>"', par, re.MULTILINE) == ["f", "m"]


def test_a_feature_of_a_part_stands_with_its_path_and_unit():
    bound = connector("k", "crane.hook hook.mass", "crane.law law.m")
    par = drawn(block(bound))["Crane.par.puml"]
    assert 'rectangle "hook.mass : Mass\\n<U+007B>unit = kg}" as mass_1 <<value>>' in par
    assert lines(par) == ["mass_1 -- m_1"]


def test_bindings_are_not_drawn_a_second_time_in_the_internal_block_diagram():
    bound = connector("k", "crane.hook hook.mass", "crane.law law.m")
    assert list(drawn(block(bound))) == ["Crane.par.puml", "model.bdd.puml"]


def test_a_binding_between_values_stays_in_the_internal_block_diagram():
    value = '  Property crane.w "w" role="value"\n'
    bound = connector("k", "crane.hook hook.mass", "crane.w")
    shown = drawn(block(bound, value))
    assert "<U+003D>" in shown["Crane.ibd.puml"]
    assert lines(shown["Crane.par.puml"]) == []


def test_a_connector_of_another_owner_stands_where_its_ends_are():
    stray = 'Class other "Other" role="block"\n' + connector("k", "law.m", "hook.mass")
    shown = drawn(block("") + stray)
    assert lines(shown["Crane.par.puml"]) == ["mass_1 -- m_1"]
    assert "Other.par.puml" not in shown


def test_a_connector_that_could_mean_two_parts_stays_with_its_owner():
    second = '  Property crane.hook2 "hook2" role="part"\n    -> typed-by hook\n'
    stray = 'Class other "Other" role="block"\n' + connector("k", "law.m", "hook.mass")
    shown = drawn(block("", second) + stray)
    assert lines(shown["Crane.par.puml"]) == []
    assert lines(shown["Other.par.puml"]) == ["mass_1 -- m_1"]


def test_circles_of_parts_end_the_search():
    loop = (
        'Class node "Node" role="block"\n  Property node.next "next" role="part"\n'
        "    -> typed-by node\n"
    )
    first = '  Property crane.n "n" role="part"\n    -> typed-by node\n'
    stray = 'Class other "Other" role="block"\n' + connector("k", "law.m", "hook.gone")
    text = loop + block("", first) + stray + 'Property hook.gone "gone"\n'
    assert lines(drawn(text)["Crane.par.puml"]) == []


def test_nothing_of_a_parametric_model_is_reported_as_not_drawn():
    bound = connector("k", "crane.hook hook.mass", "crane.law law.m")
    _, sink = emitted(parse_text(block(bound)))
    assert [found.message for found in sink] == []


def test_more_usages_than_fit_are_split_and_keep_their_bindings():
    text = LAW + 'Class crane "Crane" role="block"\n'
    for number in range(60):
        text += f'  Property u{number} "u{number}" role="constraint property"\n'
        text += "    -> typed-by law\n"
    for number in range(1, 60):
        text += connector(f"k{number}", f"u{number - 1} law.f", f"u{number} law.m")
    shown = [one for name, one in drawn(text).items() if name.endswith(".par.puml")]
    assert len(shown) == 2
    assert all(f"u{number} : " in "".join(shown) for number in range(60))
    assert sum(len(re.findall(r"^\w+ -- \w+$", one, re.MULTILINE)) for one in shown) >= 59


# -- internal block diagrams -------------------------------------------------------------------


def test_a_connector_with_three_ends_joins_the_first_with_the_others():
    text = (
        'Class a "A" role="block"\n'
        + "".join(
            f'  Property {p} "{p}" role="part" aggregation="composite"\n    -> typed-by b\n'
            for p in ("one", "two", "three")
        )
        + connector("k", "one", "two", "three").replace("binding connector", "")
        + 'Class b "B" role="block"\n'
    )
    files, sink = emitted(parse_text(text))
    ibd = next(one.text for one in files if one.path.endswith("A.ibd.puml"))
    assert lines(ibd) == ["one_1 -- two_1", "one_1 -- three_1"]
    assert list(sink) == []


def test_a_port_nested_in_a_conjugated_port_points_the_other_way():
    nested = (
        'Class inner "Inner" role="interface block"\n'
        'Class outer "Outer" role="interface block"\n'
        '  Port deep "deep" direction="in"\n    -> typed-by inner\n'
        'Class gate "Gate" role="block"\n'
        '  Port door "door" conjugated=true\n    -> typed-by outer\n'
        'Class line "Line" role="block"\n'
        '  Property g "g" role="part" aggregation="composite"\n    -> typed-by gate\n'
        '  Property h "h" role="part" aggregation="composite"\n    -> typed-by gate\n'
        + connector("k", "g door deep", "h door deep").replace(' role="binding connector"', "")
    )
    ibd = drawn(nested)["Line.ibd.puml"]
    assert ibd.count('portout "<back:#FFFFFF>door.deep</back>"') == 2


def test_constraint_parameters_of_magicdraw_are_ports():
    bound = connector("k", "crane.hook hook.mass", "crane.law law.m")
    text = block(bound).replace("Property law.", "Port law.")
    shown = drawn(text)
    assert lines(shown["Crane.par.puml"]) == ["mass_1 -- m_1"]
    assert ".. parameters ..\n{field} f\n{field} m\n" in shown["model.bdd.puml"]


def test_a_usage_without_constraint_block_is_a_row_and_no_diagram():
    shown = drawn(block("").replace("    -> typed-by law\n", ""))
    assert list(shown) == ["model.bdd.puml"]
    assert ".. constraints ..\n{field} e1" in shown["model.bdd.puml"]


def test_a_type_of_one_property_shows_what_it_specialises():
    text = (
        'Class gate "Gate" role="block"\n'
        'Class own "" role="block" property_specific=true\n  -> specializes gate\n'
        'Class line "Line" role="block"\n  Property g "g" role="value"\n    -> typed-by own\n'
    )
    assert "g : [Gate]" in drawn(text)["model.bdd.puml"]
