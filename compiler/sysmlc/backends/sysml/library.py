"""What the standard library of SysML v2 provides: scalar types, quantities, units, member names.

Every usage inherits the features of its base in the library (SysML 2.0, 9.2). They hide members of
the same name further out: inside a part, which has a shape of its own, a block called ``shape``
must be named with its package.
"""

from functools import cache

from sysmlc.ir import Element, Graph, Kind
from sysmlc.ir.query.classifiers import quantity_kind_of, unit_of
from sysmlc.support import resources, units

SHIPPED = "sysmlc:"
"""Prefix of the sources of elements that come from the libraries of sysmlc."""
SCALARS = {
    "Boolean": "ScalarValues::Boolean",
    "Integer": "ScalarValues::Integer",
    "Real": "ScalarValues::Real",
    "String": "ScalarValues::String",
    "UnlimitedNatural": "ScalarValues::Natural",
    "Number": "ScalarValues::Number",
    "Complex": "ScalarValues::Complex",
}
_SI_UNIT_NAMES = """
    m km cm mm nm m² m³ L kg g t s min h d m/s km/h m/s² rad ° Hz N N·m Pa J kJ W kW V A Ω K
    mol cd lx bit
"""
_SYSMLC_UNIT_NAMES = """
    dm µm mg ms µs kHz MHz GHz kN kPa MPa MW mV kV mA bar mbar rad/s kWh mm/s m/min °C
"""
_NAMED_UNITS = """
    m km cm mm kg g s ms min h m/s N N·m Pa bar J W kW V A K Hz rad ° Ω
"""
"""Units that are found by their names; other names without a symbol are units of the model."""
_SYSMLC_UNITS = frozenset(_SYSMLC_UNIT_NAMES.split())
"""Units of ``SysMLC::Units``: SI lacks them, or defines them in a way that models cannot use."""
_VALUE_TYPES = """
    Length Area Volume Mass Duration Speed Acceleration AngularMeasure AngularVelocity Frequency
    Force Torque Pressure Energy Power ElectricPotential ElectricCurrent Resistance
    ThermodynamicTemperature AmountOfSubstance LuminousIntensity Illuminance StorageCapacity
"""
_QUANTITIES_IN_ISQ = {
    "time": "duration",
    "velocity": "speed",
    "angle": "angular measure",
    "electric resistance": "resistance",
}
"""Names of quantities in ISQ that differ."""


def find_value_type(quantity: str) -> str | None:
    """Return the value type of ISQ for the name of a quantity."""
    name = _QUANTITIES_IN_ISQ.get(quantity.lower(), quantity).title().replace(" ", "")
    return f"{name}Value" if name in _VALUE_TYPES.split() else None


_NAMES_IN_SI = {"t": "tonne", "N·m": "N⋅m"}
"""Names of units in SI that differ from their symbols."""
UNITS = {
    unit.symbol: (value_type, _NAMES_IN_SI.get(unit.symbol, unit.symbol))
    for unit in units.UNITS
    if unit.symbol in _SYSMLC_UNITS.union(_SI_UNIT_NAMES.split())
    and (value_type := find_value_type(unit.quantity))
} | {
    "°C": ("CelsiusTemperatureValue", "°C"),
    # Files of CAEX have C and F as units of temperature, so that `units` omits these.
    "C": ("ElectricChargeValue", "C"),
    "F": ("CapacitanceValue", "F"),
    "T": ("MagneticFluxDensityValue", "T"),
}
"""Value type of ISQ and name of the unit, by the symbol of the unit."""
_ROOTS = """
    ActionPerformances Actions Allocations AnalysisCases AnalysisTooling Attributes Base
    BooleanFunctions Calculations Cases CausationConnections CauseAndEffect Clocks
    Collections CollectionFunctions ComplexFunctions Connections Constraints
    ControlFunctions ControlPerformances DataFunctions DerivationConnections
    FeatureReferencingPerformances Flows ImageMetadata ISQ ISQBase Interfaces Items KerML
    Links Metadata Metaobjects ModelingMetadata NumericalFunctions Objects Observation
    OccurrenceFunctions Occurrences ParametersOfInterestMetadata Parts Performances Ports
    Quantities QuantityCalculations RationalFunctions RealFunctions RequirementDerivation
    Requirements RiskMetadata SI SIPrefixes SampledFunctions ScalarFunctions ScalarValues
    SequenceFunctions ShapeItems SpatialFrames SpatialItems StandardViewDefinitions
    StatePerformances States StringFunctions SysML SysMLC Time TradeStudies
    TransitionPerformances Transfers Triggers TrigFunctions USCustomaryUnits UseCases
    VectorFunctions VectorValues VerificationCases Views MeasurementReferences
    MeasurementRefCalculations TensorCalculations VectorCalculations NaturalFunctions
    IntegerFunctions BaseFunctions Geometry
"""
ROOTS = frozenset(_ROOTS.split())
"""Names of the packages of the standard library and of ``SysMLC``: no root may have them."""
_SYSMLC_NAMES = """
    AutomationML Facet Group Kind Named Kept Element ObjectFlow Through External Unit Units
    Requirement Partition Repeated Call inWords fullPort blockPort shared realization generalization
    trace copies satisfies verifies derives allocates conforms exposes substitution usage
    abstraction manifestation deployment roleBinding extension internalLink processLink orderLink
    constrains precondition postcondition bodyCondition invariant choice junction forking joining
    shallowHistory deepHistory entryPoint exitPoint connectionPoint termination
"""
_SYSMLC_LONG_NAMES = """
    InWords FullPort BlockPort SharedAggregation Realization Generalization Trace Copies Satisfies
    Verifies Derives Allocates Conforms Exposes Substitution Usage Abstraction Manifestation
    Deployment RoleBinding Extension InternalLink ProcessLink OrderLink Constrains Precondition
    Postcondition BodyCondition Invariant Choice Junction Fork Join ShallowHistory DeepHistory
    EntryPoint ExitPoint ConnectionPoint Termination
"""
_SCALARS = "ScalarValue Boolean String NumericalValue Number Complex Real Rational Integer Natural"
IMPORTS = {
    "SysMLC": frozenset(_SYSMLC_NAMES.split()),
    "ScalarValues": frozenset([*_SCALARS.split(), "Positive"]),
    "RequirementDerivation": frozenset({"derivation", "original", "derive"}),
    "ModelingMetadata": frozenset({"refinement"}),
}
"""Names that are written without their package, which is imported instead."""
IMPORTED = frozenset().union(*IMPORTS.values(), _SYSMLC_LONG_NAMES.split())
"""All names that such an import makes visible, also those that no text uses."""

MEMBER_NAMES_FILE = "library-members.txt"
"""Names by base, in ``metamodels``; ``tests/backends/sysml/library_names.py`` writes it."""
BASES = {
    "accept": "Actions::AcceptAction",
    "action": "Actions::Action",
    "allocation": "Allocations::Allocation",
    "assign": "Actions::AssignmentAction",
    "attribute": "Base::Anything",
    "connection": "Connections::Connection",
    "constraint": "Constraints::ConstraintCheck",
    "enum": "Base::Anything",
    "flow": "Flows::Message",
    "interface": "Interfaces::Interface",
    "item": "Items::Item",
    "metadata": "Metadata::MetadataItem",
    "occurrence": "Occurrences::Occurrence",
    "part": "Parts::Part",
    "port": "Ports::Port",
    "ref": "Base::Anything",
    "requirement": "Requirements::RequirementCheck",
    "send": "Actions::SendAction",
    "state": "States::StateAction",
    "transition": "States::StateTransitionAction",
    "trigger": "TransitionPerformances::TransitionPerformance",
    "use case": "UseCases::UseCase",
    "verification": "VerificationCases::VerificationCase",
    "view": "Views::View",
    "viewpoint": "Views::ViewpointCheck",
}
"""Bases of usages by keyword."""
_SPECIAL_BASES = {
    "action": (BASES["accept"], BASES["assign"], BASES["send"]),
    "transition": (BASES["trigger"],),
}
"""More bases: the keyword of an action does not tell whether it sends, accepts or assigns."""
_CONTROL_NODES = ("decide", "merge", "fork", "join")
"""Keywords of control nodes, whose base is that of actions."""
_PRIVATELY_IMPORTED_NAMES = frozenset(("add", "addAt", "remove", "removeAt"))
"""Functions that OccurrenceFunctions imports privately.

The OpenMBEE toolkit finds them in actions all the same, before members of the model.
"""


# -- types and units -----------------------------------------------------------------------------


def find_scalar_type(element: Element) -> str | None:
    """Return the library's scalar type for a primitive type outside of the model, or None."""
    is_primitive = element.kind is Kind.DATA_TYPE and element.attrs.get("external")
    return SCALARS.get(element.name) if is_primitive else None


def find_unit_name(unit: Element | None) -> str | None:
    """Return the qualified name of a unit in SI or ``SysMLC``, found by its symbol or its name."""
    return name_unit("" if unit is None else _find_symbol(unit))


def name_unit(symbol: str) -> str | None:
    """Return the qualified name of the unit with a symbol in SI or ``SysMLC``."""
    row = UNITS.get(symbol)
    package = "SysMLC::Units" if symbol in _SYSMLC_UNITS else "SI"
    return None if row is None else f"{package}::{row[1]}"


def _find_symbol(unit: Element) -> str:
    """Return the symbol of a unit, found by its symbol or its name, or the empty string."""
    symbol = str(unit.attrs.get("symbol", ""))
    known_unit = units.find_unit(symbol)
    for text in (symbol if known_unit is None else known_unit.symbol, unit.name):
        if text in UNITS:
            return text
    named_unit = units.find_unit(unit.name.lower())
    symbol = "" if named_unit is None else named_unit.symbol
    return symbol if symbol in _NAMED_UNITS.split() else ""


def find_quantity(graph: Graph, type_: Element) -> str | None:
    """Return the value type of ISQ for a value type, by its unit, else by its quantity kind.

    A unit that no library defines has none: numbers of ISQ would be in other units.
    """
    unit = unit_of(graph, type_)
    if unit is not None:
        row = UNITS.get(_find_symbol(unit))
        return None if row is None else row[0]
    quantity_kind = quantity_kind_of(graph, type_)
    return None if quantity_kind is None else find_value_type(quantity_kind.name)


# -- names that members inherit ------------------------------------------------------------------


@cache
def list_inherited_names(keyword: str) -> frozenset[str]:
    """Return the names that hide those of the model in a definition or usage with this keyword.

    It inherits them from the library.
    """
    usage_keyword = keyword.removesuffix(" def")
    base = BASES.get("action" if usage_keyword in _CONTROL_NODES else usage_keyword)
    names = _read_member_names().get(base or "", frozenset())
    if base and keyword == usage_keyword:
        # A usage is a feature, and inherits from Base::things, which have an owner of this name.
        names |= {"that"}
    special_bases = _SPECIAL_BASES.get(usage_keyword, ())
    names = names.union(*(_read_member_names()[base] for base in special_bases))
    return names | _PRIVATELY_IMPORTED_NAMES if usage_keyword == "action" else names


@cache
def _read_member_names() -> dict[str, frozenset[str]]:
    """Return the names by base: a line names a base, and indented lines after it its members."""
    names_by_base: dict[str, list[str]] = {}
    for line in resources.read_text("metamodels", MEMBER_NAMES_FILE).splitlines():
        if not line.startswith(" "):
            names = names_by_base[line] = []
        else:
            names += line.split()
    return {base: frozenset(names) for base, names in names_by_base.items()}
