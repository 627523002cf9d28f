"""What the standard library of SysML v2 already has: scalar types, quantities, units."""

from sysmlc.ir import Element, Graph, Kind
from sysmlc.ir.query.classifiers import quantity_kind_of, unit_of

SHIPPED = "sysmlc:"
"""What the sources of elements of our own libraries begin with."""
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


def _units() -> dict[str, tuple[str, str]]:
    found = {}
    for entry in _UNITS.replace("\n", " | ").split(" | "):
        if entry.split():
            symbol, value, name = entry.split()
            found[symbol] = (value, name.strip("'"))
    return found


UNITS = _units()
"""Value type of ISQ and name of the unit in SI, by symbol of the unit."""
_OWN = """
    dm µm mg ms µs kHz MHz GHz kN kPa MPa MW mV kV mA bar mbar rad/s kWh mm/s m/min °C
"""
_OWN_UNITS = frozenset(_OWN.split())
"""Units that SI does not have, or not as we need them; our library has them."""
_QUANTITIES = {
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
_BY_NAME = {
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
"""Names of the packages of the standard library, and of ours: no model may have them."""


_OURS = """
    AutomationML Facet Group Kind Named Kept Element ObjectFlow Through External Unit Units
    Requirement Partition Call fullPort blockPort shared realization generalization trace copies
    satisfies verifies derives allocates conforms exposes substitution usage abstraction
    manifestation deployment roleBinding extension internalLink processLink orderLink constrains
    precondition postcondition bodyCondition invariant choice junction forking joining
    shallowHistory deepHistory entryPoint exitPoint connectionPoint termination
"""
_REST = """
    FullPort BlockPort SharedAggregation Realization Generalization Trace Copies Satisfies
    Verifies Derives Allocates Conforms Exposes Substitution Usage Abstraction Manifestation
    Deployment RoleBinding Extension InternalLink ProcessLink OrderLink Constrains Precondition
    Postcondition BodyCondition Invariant Choice Junction Fork Join ShallowHistory DeepHistory
    EntryPoint ExitPoint ConnectionPoint Termination
"""
_SCALARS = "ScalarValue Boolean String NumericalValue Number Complex Real Rational Integer Natural"
IMPORTS = {
    "SysMLC": frozenset(_OURS.split()),
    "ScalarValues": frozenset([*_SCALARS.split(), "Positive"]),
    "RequirementDerivation": frozenset({"derivation", "original", "derive"}),
    "ModelingMetadata": frozenset({"refinement"}),
}
"""Names that are written short, by the package that is then imported."""
IMPORTED = frozenset().union(*IMPORTS.values(), _REST.split())
"""All names that such imports may bring."""


def scalar_of(element: Element) -> str | None:
    """Scalar type of the library that a primitive type outside the model is."""
    is_primitive = element.kind is Kind.DATA_TYPE and element.attrs.get("external")
    return SCALARS.get(element.name) if is_primitive else None


def unit_name(unit: Element | None) -> str | None:
    """Qualified name of a unit in SI or in our library, by its symbol or else by its name."""
    found = _known(unit)
    if found is None:
        return None
    return f"{'SysMLC::Units' if found[1] in _OWN_UNITS else 'SI'}::{found[1]}"


def _known(unit: Element | None) -> tuple[str, str] | None:
    if unit is None:
        return None
    symbol = str(unit.attrs.get("symbol", "")).replace("*", "·")
    return UNITS.get(symbol) or UNITS.get(_BY_NAME.get(unit.name.lower(), unit.name))


def quantity_of(graph: Graph, type_: Element) -> str | None:
    """Value type of ISQ for a value type: that of its unit, else of its quantity kind."""
    known = _known(unit_of(graph, type_))
    if known is not None:
        return known[0]
    kind = quantity_kind_of(graph, type_)
    return None if kind is None else quantity_of_kind(kind)


def quantity_of_kind(kind: Element) -> str | None:
    """Value type of ISQ for a quantity kind."""
    return _QUANTITIES.get(kind.name.lower())
