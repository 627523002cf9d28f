"""Types of what flows (SM244), and of what interfaces and connections connect (SM245, SM348)."""

import pytest
from small_models import list_codes, list_messages

from sysmlc.diagnostics import catalogue

FLOWS = """
    item def Water; item def Hot :> Water; item def Steel;
    port def Mixed {{ out item w : Water; out item s : Steel; out item any; }}
    part def Tank {{ port m : Mixed; out item w : Water; out item free; }}
    part def Press {{ port m : ~Mixed; in item hot : Hot; in item plate : Steel; in item free; }}
    flow def Casting {{ ref :>> payload : Steel; }}
    action def Boil {{ out steam : Hot; }}
    action def Use {{ in wet : Water; in solid : Steel; in anything; }}
    part line {{ part t : Tank; part p : Press; action b : Boil; action u : Use; {} }}
"""


@pytest.mark.parametrize(
    "flow",
    [
        "flow of Water from t.w to p.hot;",
        "flow of Hot from t.w to p.hot;",
        "flow from t.m.w to p.m.w;",
        "flow from t.free to p.plate;",
        "flow of Steel from t.free to p.free;",
        "flow from b.steam to u.wet;",
        "flow from b.steam to u.anything;",
        "flow : Casting from t.free to p.plate;",
    ],
)
def test_what_flows_may_specialise_what_is_expected_or_the_other_way_round(flow):
    assert list_messages(FLOWS.format(flow)) == []


@pytest.mark.parametrize(
    ("flow", "names", "types"),
    [
        ("flow from t.w to p.plate;", "'t.w' and 'p.plate'", "'Water' and 'Steel'"),
        (
            "flow of Water from t.free to p.plate;",
            "the payload and 'p.plate'",
            "'Water' and 'Steel'",
        ),
        ("flow of Steel from t.w to p.hot;", "the payload and 't.w'", "'Steel' and 'Water'"),
        ("flow of Steel from t.m.w to p.m.w;", "the payload and 't.m.w'", "'Steel' and 'Water'"),
        ("flow from t.m.w to p.m.s;", "'t.m.w' and 'p.m.s'", "'Water' and 'Steel'"),
        ("flow : Casting from t.w to p.free;", "the payload and 't.w'", "'Steel' and 'Water'"),
        (
            "succession flow from b.steam to u.solid;",
            "'b.steam' and 'u.solid'",
            "'Hot' and 'Steel'",
        ),
    ],
)
def test_a_flow_of_unrelated_types_is_one_warning(flow, names, types):
    message = f"{names} of the flow have unrelated types: {types}"
    assert list_messages(FLOWS.format(flow)) == [message]


CONNECTIONS = """
    port def Fluid; port def Oil :> Fluid; port def Power;
    interface def Pipe {{ end supplier : Fluid; end consumer : ~Fluid; }}
    part def Valve; part def Gate :> Valve; part def Motor;
    connection def Coupling {{ end part valve : Valve; end part motor : Motor; }}
    part def Pump {{ port fluid : Fluid; port oil : Oil; port power : Power; }}
    part def Tank {{ port fluid : ~Fluid; port power : ~Power; }}
    part line {{
        part a : Pump; part b : Tank; part v : Valve; part g : Gate; part m : Motor;
        {}
    }}
"""


@pytest.mark.parametrize(
    "connection",
    [
        "interface : Pipe connect a.fluid to b.fluid;",
        "interface : Pipe connect a.oil to b.fluid;",
        "interface : Pipe connect consumer ::> b.fluid to supplier ::> a.fluid;",
        "connection : Coupling connect g to m;",
        "connect m to v;",
    ],
)
def test_connected_features_have_the_types_of_the_ends(connection):
    assert list_messages(CONNECTIONS.format(connection)) == []


@pytest.mark.parametrize(
    ("connection", "messages"),
    [
        (
            "interface : Pipe connect a.power to b.fluid;",
            ["'power' of type 'Power' is connected as 'supplier', whose type 'Fluid' is unrelated"],
        ),
        (
            "connection : Coupling connect m to v;",
            [
                "'m' of type 'Motor' is connected as 'valve', whose type 'Valve' is unrelated",
                "'v' of type 'Valve' is connected as 'motor', whose type 'Motor' is unrelated",
            ],
        ),
        (
            "connection : Coupling connect valve ::> v to motor ::> g;",
            ["'g' of type 'Gate' is connected as 'motor', whose type 'Motor' is unrelated"],
        ),
    ],
)
def test_connected_features_of_unrelated_types_are_warnings(connection, messages):
    assert list_messages(CONNECTIONS.format(connection)) == messages


WIRING = """
    item def Command; item def Status;
    port def Bus {{ in item command : Command; out item status : Status; }}
    port def Plug;
    interface def Wiring {{ end port server : Bus; end port client : ~Bus; }}
    interface def Cable {{ end port one : Plug; end port two : ~Plug; }}
    part a {{ port bus : Bus; port plug : Plug; }}
    part b {{ port bus : ~Bus; port plug : ~Plug; }}
    {}
"""


@pytest.mark.parametrize(
    ("connection", "messages"),
    [
        ("interface : Wiring connect a.bus to b.bus;", []),
        ("interface : Wiring connect client ::> b.bus to server ::> a.bus;", []),
        ("interface : Cable connect b.plug to a.plug;", []),
        (
            "interface : Wiring connect b.bus to a.bus;",
            [
                "'bus' is connected as 'server' and 'bus' is connected as 'client': each has the "
                "directions of the other end of the definition"
            ],
        ),
        # That both ports have equal directions is a finding of pass 'flows'.
        ("interface : Wiring connect a.bus to a.bus;", []),
    ],
)
def test_ports_that_are_connected_in_the_wrong_order_are_warnings(connection, messages):
    assert list_messages(WIRING.format(connection)) == messages


@pytest.mark.parametrize("code", ["SM244", "SM245", "SM348"])
def test_the_wrong_example_breaks_the_rule_and_the_right_one_does_not(code):
    page = catalogue()[code].read_page()
    assert list_codes(page.wrong, "sysml") == {code}
    assert list_codes(page.right, "sysml") == set()
