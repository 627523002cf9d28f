"""Three-level recipe model as values (thesis 3.5; JSON form: metamodels/sysmlc-recipe.schema.json).

Ids are qualified names of the model; levels refer to one another by id and are never nested.
Times are integers in milliseconds.
"""

from typing import Literal as OneOf

from msgspec import Struct

from sysmlc.ir.expressions import Expression

Number = int | float
Scalar = bool | int | float | str


class Range(Struct, frozen=True):
    """Smallest and largest value; ``max`` None is unbounded."""

    min: Number
    max: Number | None


class EnumType(Struct, frozen=True):
    """An enumeration with its literals in order, and their values if every literal has one."""

    name: str
    literals: tuple[str, ...]
    values: tuple[Scalar, ...] = ()


class ReferenceType(Struct, frozen=True):
    """A reference to a machine, a material or another element."""

    to: OneOf["machine", "material", "element"]
    name: str


class ListType(Struct, frozen=True):
    """A list of values of one type."""

    of: "ValueType"


ValueType = OneOf["boolean", "integer", "real", "string"] | EnumType | ReferenceType | ListType


class Parameter(Struct, frozen=True):
    """An input, output, constant or variable; ``type`` None when the model gives none."""

    name: str
    type: ValueType | None = None
    unit: str = ""
    value: Scalar | tuple[Scalar, ...] | None = None


class OpcUa(Struct, frozen=True):
    """The nodes of a service or function on an OPC UA server, with ids as the model writes them."""

    kind: str
    object: str
    method: str = ""
    endpoint: str = ""
    namespace_uri: str = ""
    done_when: Expression | None = None
    timeout: int | None = None
    """In milliseconds."""
    element: str = ""


class MachineVariable(Struct, frozen=True):
    """A value that a machine provides or accepts, with a dotted path for nested values.

    ``node`` is its OPC UA node as written; a variable with ``elements`` is the list of these.
    """

    name: str
    type: ValueType | None = None
    value: Scalar | None = None
    node: str = ""
    elements: tuple[str, ...] = ()
    unit: str = ""


class Machine(Struct, frozen=True):
    """A machine that tasks and services can be allocated to."""

    id: str
    machine_class: str = ""
    aml_id: str = ""
    endpoint: str = ""
    plant_element: str = ""
    variables: tuple[MachineVariable, ...] = ()
    element: str = ""


class Material(Struct, frozen=True):
    """A kind of material: stock, position, and the capacity of the buffer between tasks."""

    id: str
    available: Number | None = None
    unit: str = ""
    position: str = ""
    buffer: int | None = None
    no_wait: bool = False
    properties: tuple[tuple[str, Scalar], ...] = ()
    element: str = ""
    property_units: tuple[tuple[str, str], ...] = ()


class MaterialUse(Struct, frozen=True):
    """The quantity of a material that a task uses; ``use`` is consumed, produced or carried."""

    material: str
    quantity: Number
    use: str


class Mode(Struct, frozen=True):
    """A set of machines that together can perform a task or service, and what this costs."""

    machines: tuple[str, ...]
    duration: int | None = None
    """In milliseconds."""
    power: Range | None = None
    tools: tuple[str, ...] = ()
    available: bool | None = None


class Condition(Struct, frozen=True):
    """A branch on which a sub-task depends: its decision and guard; ``is_else`` without a guard."""

    decision: str
    guard: Expression | None = None
    text: str = ""
    is_else: bool = False


class SubTask(Struct, frozen=True):
    """A service node of a task, as the scheduler sees it (thesis 6.5.1: ``st_ij`` and PA).

    ``runs`` is how often an execution of the task performs it; ``when`` has the branches that lead
    to it, of which one is enough.
    """

    node: str
    alternatives: tuple[Mode, ...]
    after: tuple[str, ...] = ()
    runs: Range | None = None
    when: tuple[Condition, ...] = ()


class SameMachine(Struct, frozen=True):
    """Service nodes that must run on one machine, with the functions and resources as reasons."""

    nodes: tuple[str, ...]
    because: tuple[str, ...]


class EndTime(Struct, frozen=True):
    """The time of executions that end at one of several final nodes.

    ``is_early`` states that they break off a loop.
    """

    node: str
    duration: Range
    """In milliseconds."""
    is_early: bool = False


class TimeLimit(Struct, frozen=True):
    """A time that a requirement allows, in milliseconds; ``element`` is the requirement."""

    requirement: str
    least: Number | None = None
    most: Number | None = None
    element: str = ""


class Derived(Struct, frozen=True):
    """Data of a task that is computed from the rest of the model.

    ``duration`` is that of executions that do not end early. ``because`` is the reason for a
    duration without a maximum.
    """

    sub_tasks: tuple[SubTask, ...] = ()
    same_machine: tuple[SameMachine, ...] = ()
    duration: Range | None = None
    expected: Number | None = None
    """In milliseconds, as ``duration``."""
    because: str = ""
    ends: tuple[EndTime, ...] = ()


class Task(Struct, frozen=True):
    """A step of a recipe: one use of a task definition."""

    id: str
    name: str = ""
    max_duration: int | None = None
    """In milliseconds."""
    materials: tuple[MaterialUse, ...] = ()
    equipment: tuple[Mode, ...] = ()
    implementation: str = ""
    pre: Expression | None = None
    post: Expression | None = None
    bind: tuple[tuple[str, Expression], ...] = ()
    assign: tuple[tuple[str, str], ...] = ()
    interruptible: bool = False
    no_wait: bool = False
    derived: Derived | None = None
    element: str = ""
    limits: tuple[TimeLimit, ...] = ()


class Performance(Struct, frozen=True):
    """A block that performs a recipe, with the features of the block that take part in it.

    ``arguments`` has the feature for each parameter of the recipe, and ``steps`` the feature for
    each node of its graphs. A feature is a dotted path that begins at the block.
    """

    block: str
    arguments: tuple[tuple[str, str], ...] = ()
    steps: tuple[tuple[str, str], ...] = ()
    element: str = ""


class Recipe(Struct, frozen=True):
    """Tasks and the order between them; variables carry values from task to task."""

    id: str
    tasks: tuple[Task, ...]
    precedence: tuple[tuple[str, str], ...] = ()
    inputs: tuple[Parameter, ...] = ()
    outputs: tuple[Parameter, ...] = ()
    variables: tuple[Parameter, ...] = ()
    version: str = ""
    product: str = ""
    priority: int | None = None
    no_wait: bool = False
    element: str = ""
    performances: tuple[Performance, ...] = ()
    limits: tuple[TimeLimit, ...] = ()
    derived: Derived | None = None


class Provider(Struct, frozen=True):
    """A machine that offers a service, with the duration of the service on this machine."""

    machine: str
    duration: int | None = None
    """In milliseconds."""
    power: Range | None = None
    tools: tuple[str, ...] = ()
    opcua: OpcUa | None = None
    available: bool | None = None


class Service(Struct, frozen=True):
    """A service of a machine or of the infrastructure, such as a database (thesis 3.5.2)."""

    id: str
    kind: OneOf["machine", "infrastructure"]
    inputs: tuple[Parameter, ...] = ()
    outputs: tuple[Parameter, ...] = ()
    constants: tuple[Parameter, ...] = ()
    materials: tuple[MaterialUse, ...] = ()
    providers: tuple[Provider, ...] = ()
    duration: int | None = None
    """In milliseconds."""
    implementation: str = ""
    pre: Expression | None = None
    post: Expression | None = None
    interruptible: bool = False
    opcua: OpcUa | None = None
    element: str = ""


class Resource(Struct, frozen=True):
    """The use of an exclusive resource by a function; ``mode`` is acquire, hold, release or use."""

    id: str
    mode: str


class Function(Struct, frozen=True):
    """A machine function, at the level of the programmable controller (thesis 3.5.3)."""

    id: str
    inputs: tuple[Parameter, ...] = ()
    outputs: tuple[Parameter, ...] = ()
    duration: Range | None = None
    """In milliseconds."""
    resources: tuple[Resource, ...] = ()
    interruptible: bool = False
    opcua: OpcUa | None = None
    element: str = ""


class Node(Struct, frozen=True):
    """A node of a service or function graph; the fields in use depend on ``kind``.

    Kinds: initial final flowFinal decision merge fork join service function call action assign
    wait delay loop forEach. A for-each node takes the elements of ``expression`` one after the
    other as ``variable``.
    """

    id: str
    kind: str
    ref: str = ""
    bind: tuple[tuple[str, Expression], ...] = ()
    assign: tuple[tuple[str, str], ...] = ()
    variable: str = ""
    expression: Expression | None = None
    text: str = ""
    max_iterations: int | None = None
    element: str = ""
    min_iterations: int = 0


class FlowEdge(Struct, frozen=True):
    """An edge of a graph. ``role`` is body or exit for the edges from a loop or for-each node.

    ``probability`` is that of the edge among the edges of its decision.
    """

    source: str
    target: str
    guard: Expression | None = None
    text: str = ""
    is_else: bool = False
    item: str = ""
    role: str = ""
    element: str = ""
    probability: float | None = None


class FlowGraph(Struct, frozen=True):
    """Order of services in a task, or of machine functions in a service."""

    id: str
    inputs: tuple[Parameter, ...] = ()
    outputs: tuple[Parameter, ...] = ()
    variables: tuple[Parameter, ...] = ()
    nodes: tuple[Node, ...] = ()
    edges: tuple[FlowEdge, ...] = ()
    element: str = ""

    @property
    def parameters(self) -> dict[str, Parameter]:
        """The inputs, outputs and variables, which expressions of the graph may name, by name."""
        parameters = (*self.inputs, *self.outputs, *self.variables)
        return {parameter.name: parameter for parameter in parameters}


class Model(Struct, frozen=True):
    """One recipe with everything that it refers to; each tuple is sorted by id."""

    recipe: Recipe
    machines: tuple[Machine, ...] = ()
    materials: tuple[Material, ...] = ()
    services: tuple[Service, ...] = ()
    functions: tuple[Function, ...] = ()
    service_graphs: tuple[FlowGraph, ...] = ()
    function_graphs: tuple[FlowGraph, ...] = ()
    sources: tuple[str, ...] = ()
    """Ids of further elements of the model from which values come, such as dependencies."""

    @property
    def graphs(self) -> tuple[FlowGraph, ...]:
        """The graphs of services, then those of functions."""
        return (*self.service_graphs, *self.function_graphs)
