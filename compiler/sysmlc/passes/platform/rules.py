"""Rules about recipes and the plant that runs them."""

from sysmlc.diagnostics import Severity, rule

NOBODY_OFFERS = rule(
    "SM623",
    "service-nobody-offers",
    Severity.WARNING,
    "no element of the plant offers the service '{service}'",
    help="add the operation to the block of its machine, in the overlay of the plant",
)
NOT_IN_PLANT = rule(
    "SM624",
    "machine-not-in-plant",
    Severity.WARNING,
    "machine '{machine}' is bound to no element of the plant",
    help="name the element: by amlId of «Machine», an allocation, or the overlay",
)
SEVERAL_ELEMENTS = rule(
    "SM625",
    "machine-is-several-elements",
    Severity.ERROR,
    "machine '{machine}' is bound to {number} elements of the plant: {elements}",
    help="bind it to one of them, or model a machine for each",
)
NO_PLANT_ELEMENT = rule(
    "SM626",
    "allocated-to-no-plant-element",
    Severity.WARNING,
    "'{source}' is allocated to '{target}', which is no element of the plant",
    help="allocate it to the element of the instance hierarchy",
)
PARAMETERS_DIFFER = rule(
    "SM627",
    "parameters-of-service-differ",
    Severity.WARNING,
    "operation '{operation}' of '{element}' does not offer the service '{service}': {difference}",
    help="make the parameters equal, or allocate the service to the operation that is meant",
)
UNKNOWN_ID = rule(
    "SM628",
    "plant-id-unknown",
    Severity.ERROR,
    "machine '{machine}' has the amlId '{id}', which no element of the plant has",
    help="take the ID of an InternalElement of the plant",
)
SHARED = rule(
    "SM629",
    "machines-share-element",
    Severity.WARNING,
    "the machines {machines} are one element of the plant: '{element}'",
    help="merge these machines, or allocate them to different elements",
)
OPERATION_ASTRAY = rule(
    "SM630",
    "operation-of-another-element",
    Severity.WARNING,
    "service '{service}' is allocated to operation '{operation}', which {elements} does not have",
    help="allocate the service to an operation of its machine, or add that machine to the service",
)
