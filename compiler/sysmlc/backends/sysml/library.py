"""What the standard library of SysML v2 provides: scalar types, quantities, units, member names.

Every usage inherits the features of its base in the library (SysML 2.0, 9.2). They hide members of
the same name further out: inside a part, which has a shape of its own, a block called ``shape``
must be named with its package.
"""

from functools import cache

from sysmlc.ir import Element, Graph, Kind
from sysmlc.ir.query.classifiers import quantity_kind_of, unit_of
from sysmlc.support import resources

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
_UNITS = """
    m LengthValue m | km LengthValue km | dm LengthValue dm | cm LengthValue cm
    mm LengthValue mm | µm LengthValue 'µm' | nm LengthValue nm
    m² AreaValue m² | m³ VolumeValue m³ | L VolumeValue L | l VolumeValue L
    kg MassValue kg | g MassValue g | t MassValue tonne | mg MassValue mg
    s DurationValue s | ms DurationValue ms | µs DurationValue 'µs' | min DurationValue min
    h DurationValue h | d DurationValue d
    m/s SpeedValue m/s | km/h SpeedValue km/h | m·s^-1 SpeedValue m/s
    m/s² AccelerationValue m/s² | m·s^-2 AccelerationValue m/s²
    rad AngularMeasureValue rad | ° AngularMeasureValue ° | deg AngularMeasureValue °
    mm/s SpeedValue mm/s | m/min SpeedValue m/min
    rad/s AngularVelocityValue rad/s | Hz FrequencyValue Hz | kHz FrequencyValue kHz
    MHz FrequencyValue MHz | GHz FrequencyValue GHz
    N ForceValue N | kN ForceValue kN | N·m TorqueValue N⋅m | Nm TorqueValue N⋅m
    Pa PressureValue Pa | kPa PressureValue kPa | MPa PressureValue MPa | bar PressureValue bar
    mbar PressureValue mbar | kWh EnergyValue kWh | °C CelsiusTemperatureValue °C
    J EnergyValue J | kJ EnergyValue kJ | W PowerValue W | kW PowerValue kW | MW PowerValue MW
    V ElectricPotentialValue V | mV ElectricPotentialValue mV | kV ElectricPotentialValue kV
    A ElectricCurrentValue A | mA ElectricCurrentValue mA | Ω ResistanceValue Ω
    K ThermodynamicTemperatureValue K | mol AmountOfSubstanceValue mol
    cd LuminousIntensityValue cd | C ElectricChargeValue C | F CapacitanceValue F
    T MagneticFluxDensityValue T | lx IlluminanceValue lx | bit StorageCapacityValue bit
"""


def _read_units() -> dict[str, tuple[str, str]]:
    units = {}
    for row in _UNITS.replace("\n", " | ").split(" | "):
        if row.split():
            symbol, value_type, name = row.split()
            units[symbol] = (value_type, name.strip("'"))
    return units


UNITS = _read_units()
"""Value type of ISQ and name of the unit, by the symbol of the unit."""
_SYSMLC_UNIT_NAMES = """
    dm µm mg ms µs kHz MHz GHz kN kPa MPa MW mV kV mA bar mbar rad/s kWh mm/s m/min °C
"""
_SYSMLC_UNITS = frozenset(_SYSMLC_UNIT_NAMES.split())
"""Units of ``SysMLC::Units``: SI lacks them, or defines them in a way that models cannot use."""
_VALUE_TYPES_BY_QUANTITY = {
    "length": "LengthValue",
    "area": "AreaValue",
    "volume": "VolumeValue",
    "mass": "MassValue",
    "time": "DurationValue",
    "duration": "DurationValue",
    "speed": "SpeedValue",
    "velocity": "SpeedValue",
    "acceleration": "AccelerationValue",
    "angle": "AngularMeasureValue",
    "angular velocity": "AngularVelocityValue",
    "frequency": "FrequencyValue",
    "force": "ForceValue",
    "torque": "TorqueValue",
    "pressure": "PressureValue",
    "energy": "EnergyValue",
    "power": "PowerValue",
    "electric potential": "ElectricPotentialValue",
    "electric current": "ElectricCurrentValue",
    "resistance": "ResistanceValue",
    "thermodynamic temperature": "ThermodynamicTemperatureValue",
}
_SYMBOLS_BY_UNIT_NAME = {
    "metre": "m",
    "meter": "m",
    "millimetre": "mm",
    "millimeter": "mm",
    "centimetre": "cm",
    "kilometre": "km",
    "kilogram": "kg",
    "gram": "g",
    "second": "s",
    "millisecond": "ms",
    "minute": "min",
    "hour": "h",
    "metre per second": "m/s",
    "newton": "N",
    "newton metre": "N·m",
    "pascal": "Pa",
    "bar": "bar",
    "joule": "J",
    "watt": "W",
    "kilowatt": "kW",
    "volt": "V",
    "ampere": "A",
    "kelvin": "K",
    "hertz": "Hz",
    "radian": "rad",
    "degree": "°",
    "ohm": "Ω",
}
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
    row = _find_unit(unit)
    if row is None:
        return None
    return f"{'SysMLC::Units' if row[1] in _SYSMLC_UNITS else 'SI'}::{row[1]}"


def _find_unit(unit: Element | None) -> tuple[str, str] | None:
    """Return value type and name of a unit."""
    if unit is None:
        return None
    symbol = str(unit.attrs.get("symbol", "")).replace("*", "·")
    return UNITS.get(symbol) or UNITS.get(_SYMBOLS_BY_UNIT_NAME.get(unit.name.lower(), unit.name))


def find_quantity(graph: Graph, type_: Element) -> str | None:
    """Return the value type of ISQ for a value type, by its unit, else by its quantity kind.

    A unit that no library defines has none: numbers of ISQ would be in other units.
    """
    unit = unit_of(graph, type_)
    if unit is not None:
        row = _find_unit(unit)
        return None if row is None else row[0]
    quantity_kind = quantity_kind_of(graph, type_)
    return None if quantity_kind is None else find_quantity_of_kind(quantity_kind)


def find_quantity_of_kind(quantity_kind: Element) -> str | None:
    """Return the value type of ISQ for a quantity kind."""
    return _VALUE_TYPES_BY_QUANTITY.get(quantity_kind.name.lower())


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
