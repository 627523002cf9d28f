"""What can be wrong between recipes and the plant that shall run them."""

from sysmlc.diagnostics import Severity, rule

_MODEL = """\
Package plant "Plant" subkind="instance-hierarchy"
  Instance r1 "Robot1"
    -> instance-of robot
  Instance r2 "Robot2"
    -> instance-of robot
Package lib "Lib" subkind="system-unit-class-lib"
  Class robot "Robot"
    Operation mill "Mill"
      Parameter mill.d "depth"
  Class other "Press"
    Operation stamp "Stamp"
Package p "Recipes"
  Class arm "Arm" level="machine"
    Application arm.m stereotype="Machine" namespace="urn:sysmlc:profile:1" tag.amlId="{id}"
      -> subject arm
  Activity build "Build" level="recipe"
    Action build.a "work" subkind="call-behavior"
      -> calls work
  Activity work "Work" level="task"
    Action work.a "mill" subkind="call-behavior"
      -> calls service
  Activity service "{service}" level="machine service"
    Parameter service.d "{parameter}"
  Dependency offer role="allocate"
    -> client service
    -> supplier arm
  Dependency runs role="allocate"
    -> client work
    -> supplier arm
"""


def _model(id: str = "r1", service: str = "Mill", parameter: str = "depth", more: str = "") -> str:
    return _MODEL.format(id=id, service=service, parameter=parameter) + more


def _allocation(source: str, target: str) -> str:
    return f'  Dependency more role="allocate"\n    -> client {source}\n    -> supplier {target}\n'


_SECOND = """\
  Class second "Second" level="machine"
    Application second.m stereotype="Machine" namespace="urn:sysmlc:profile:1" tag.amlId="{id}"
      -> subject second
  Dependency offer2 role="allocate"
    -> client service
    -> supplier second
"""

NOBODY_OFFERS = rule(
    "SM623",
    "service-nobody-offers",
    Severity.WARNING,
    "no element of the plant offers the service '{service}'",
    why="A plant element offers a service when its block, a class that it specialises or a role "
    "class that it realises has an operation of that name. Without one nothing can run it.",
    help="add the operation to the block of its machine, in the overlay of the plant",
    wrong=_model(service="Drill"),
    right=_model(),
)
NOT_IN_PLANT = rule(
    "SM624",
    "machine-not-in-plant",
    Severity.WARNING,
    "machine '{machine}' is bound to no element of the plant",
    why="A recipe is run by elements of the plant. An equal name is a suggestion, never a "
    "decision.",
    help="say which one: amlId of «Machine», an allocation, or the overlay",
    wrong=_model(id=""),
    right=_model(),
)
SEVERAL_ELEMENTS = rule(
    "SM625",
    "machine-is-several-elements",
    Severity.ERROR,
    "machine '{machine}' is bound to {number} elements of the plant: {elements}",
    why="A scheduler gives a machine one task at a time; which of the elements does it would be "
    "open. A class of the plant means all elements of that class.",
    help="leave one, or make a machine of each",
    wrong=_model(more=_allocation("arm", "r2")),
    right=_model(more=_allocation("arm", "r1")),
)
NO_PLANT_ELEMENT = rule(
    "SM626",
    "allocated-to-no-plant-element",
    Severity.WARNING,
    "'{source}' is allocated to '{target}', which is no element of the plant",
    why="Machines and services are allocated to InternalElements, to a class that one of them "
    "has, or a service to an operation.",
    help="allocate it to the element of the instance hierarchy",
    wrong=_model(id="", more=_allocation("arm", "other")),
    right=_model(id="", more=_allocation("arm", "r2")),
)
PARAMETERS_DIFFER = rule(
    "SM627",
    "parameters-of-service-differ",
    Severity.WARNING,
    "operation '{operation}' of '{element}' does not offer the service '{service}': {difference}",
    why="The service is called with its own parameters; they must be those of the operation, by "
    "name, direction and type.",
    help="make the parameters equal, or allocate the service to the operation that is meant",
    wrong=_model(parameter="height"),
    right=_model(),
)
UNKNOWN_ID = rule(
    "SM628",
    "plant-id-unknown",
    Severity.ERROR,
    "machine '{machine}' has the amlId '{id}', which no element of the plant has",
    why="The plant may have been exported anew with other ids, or the machine may be gone.",
    help="take the ID of an InternalElement of the plant",
    wrong=_model(id="r7"),
    right=_model(),
)
SHARED = rule(
    "SM629",
    "machines-share-element",
    Severity.WARNING,
    "the machines {machines} are one element of the plant: '{element}'",
    why="A scheduler takes them for different machines and books the element twice.",
    help="make one machine of them, or allocate them to different elements",
    wrong=_model(more=_SECOND.format(id="r1")),
    right=_model(more=_SECOND.format(id="r2")),
)
OPERATION_ASTRAY = rule(
    "SM630",
    "operation-of-another-element",
    Severity.WARNING,
    "service '{service}' is allocated to operation '{operation}', which {elements} does not have",
    why="The service runs on the machines that offer it; the operation belongs to none of them.",
    help="allocate the service to an operation of its machine, or add that machine to the service",
    wrong=_model(more=_allocation("service", "stamp")),
    right=_model(more=_allocation("service", "mill")),
)
