"""Meaning of names inside a classifier: its features as variables with finite domains.

Features are computed when they are looked up: a behaviour can name hundreds through the types of
its parameters, and uses a few.
"""

from collections import defaultdict
from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import cached_property

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Element, Graph, Kind, query
from sysmlc.ir.expressions import (
    Assignment,
    Binary,
    Expression,
    ParsedText,
    Statement,
    name_of,
    walk_tree,
)
from sysmlc.ir.expressions import Literal as LiteralExpression
from sysmlc.logic.cells import Fact
from sysmlc.logic.contract import EnumerationDomain, IntegerDomain
from sysmlc.logic.domains import describe
from sysmlc.logic.expressions.features import (
    Feature,
    default_text,
    is_string,
    make_feature,
    read_constant,
    restrict_string,
)
from sysmlc.logic.expressions.linear import Number, print_term
from sysmlc.logic.expressions.named_elements import (
    Enumerations,
    enumerations_of,
    find_direction,
    find_named_values,
    find_object_values,
    find_part_values,
    find_port_values,
)
from sysmlc.logic.expressions.ranges import MIRROR, Access, evaluate_integer
from sysmlc.logic.expressions.symbols import Symbol
from sysmlc.logic.expressions.thresholds import thresholds_of
from sysmlc.logic.formula import const, var
from sysmlc.logic.identifiers import Names, make_unique

ASSUMED_RANGE = rule(
    "SM410",
    "assumed-range",
    Severity.INFO,
    "property '{name}' has no range; {range} is assumed",
    help="constrain it ({name} >= {low} and {name} <= {high}) or give it a value type with a range",
)

DEFAULT_OUTSIDE = rule(
    "SM433",
    "default-out-of-range",
    Severity.ERROR,
    "default value '{default}' of property '{name}' is not in {domain}",
    help="correct the default value or the range",
)


BOUND_NUMBER = rule(
    "SM435",
    "bound-number-compared",
    Severity.WARNING,
    "'{name}' is {value} for ever, so that no comparison with it changes; the contract treats "
    "'{name}' as an input that starts with this value",
    help="write ':=' if that is its initial value, or 'constant' if it never changes",
)


class Context(Struct, frozen=True):
    """What the names of expressions mean inside one classifier."""

    name: str
    features: Mapping[str, Feature]
    enumerations: Enumerations
    namespace: str = ""
    """Qualified name of the classifier, inside which names of packages are looked up."""

    @property
    def facts(self) -> tuple[Fact, ...]:
        """The sums of variables that constraints keep in an interval."""
        return self.features.facts if isinstance(self.features, _FeatureTable) else ()

    @property
    def variables(self) -> Mapping[str, str]:
        """The variable of each feature by name; the domains of the features are not computed."""
        return self.features.variables if isinstance(self.features, _FeatureTable) else {}


def context_of(
    graph: Graph,
    classifier: Element | None,
    assumed_range: tuple[int, int] = (0, 15),
    behaviour: Element | None = None,
) -> Context:
    """Return the context of a classifier; it is empty without one.

    An Integer without a range gets *assumed_range*. The names of *behaviour*, a behaviour of the
    classifier, hide those of the classifier.
    """
    enumerations = enumerations_of(graph)
    if classifier is None:
        return Context("", {}, enumerations)
    elements = _find_elements(graph, classifier, behaviour)
    features = _FeatureTable(graph, classifier, behaviour, elements, assumed_range, enumerations)
    return Context(classifier.name, features, enumerations, graph.qualified_name(classifier))


def variables_of(
    graph: Graph, classifier: Element | None, behaviour: Element | None = None
) -> dict[str, str]:
    """Return the variable of each name in the context of a classifier; compute no features."""
    if classifier is None:
        return {}
    return _name_variables(_find_elements(graph, classifier, behaviour))


def find_symbol(context: Context, name: str, element: str = "") -> Symbol | None:
    """Return the symbol of a feature of the context, or that of ``find_literal``.

    A feature stands for its variable, or for its value if it is a constant. A constant of a package
    hides a feature that has its name, also if the value of the constant is not known.
    """
    is_constant = element in context.enumerations.constants_by_id
    feature = None if is_constant else context.features.get(name)
    if feature is None:
        return find_literal(context, name, element)
    if feature.is_constant and feature.default is not None:
        return Symbol(const(feature.default), feature.domain, quantity=feature.number)
    is_several = feature.has_several_values
    return Symbol(
        var(feature.variable),
        feature.domain,
        has_several_values=is_several,
        quantity=feature.number,
        term=feature.term,
    )


def find_literal(context: Context, name: str, element: str = "") -> Symbol | None:
    """Return the symbol of an enumeration literal, or of a constant, with the id *element*.

    Without such an element, ``Mode::auto`` is a literal, and ``Limits::MAX`` is a constant of a
    package that is visible from the classifier, as ``MAX`` in the packages around it.
    """
    enumerations = context.enumerations
    if element in enumerations.constants_by_id:
        return enumerations.constants_by_id[element]
    literal = enumerations.literals_by_id.get(element) or enumerations.literals.get(name)
    return literal or _find_constant(context, name)


def _find_constant(context: Context, name: str) -> Symbol | None:
    """Return the symbol of the package's attribute that a name means in the nearest namespace."""
    constants, path = context.enumerations.constants, context.namespace.split("::")
    names = ("::".join((*path[:length], name)) for length in range(len(path), -1, -1))
    return next((constants[key] for key in names if key in constants), None)


def describe_missing_range(id: str) -> str:
    """Return the cause of the findings about an element without a range."""
    return f"no range {id}"


def report_range(graph: Graph, feature: Feature, sink: Sink) -> None:
    """Report the assumed range of a feature that is used, and a default value outside its range."""
    domain = feature.domain
    if feature.invalid_default and domain is not None:
        subject, name = graph.subject(feature.element), feature.element.name
        values = describe(domain)
        if isinstance(domain, EnumerationDomain) and domain.type_name:
            values = f"'{domain.type_name}' ({values})"
        sink.report(
            DEFAULT_OUTSIDE, subject, default=feature.invalid_default, name=name, domain=values
        )
    if feature.is_bound:
        name, value = feature.element.name, feature.element.attrs["default"]
        sink.report(BOUND_NUMBER, graph.subject(feature.element), name=name, value=value)
    if feature.is_assumed and isinstance(domain, IntegerDomain):
        report_assumed_range(graph, feature.element, domain, sink)


def report_assumed_range(
    graph: Graph,
    element: Element,
    domain: IntegerDomain,
    sink: Sink,
    user: Element | None = None,
    *,
    note: str = "",
) -> None:
    """Report that a feature without a range has the range *domain*.

    The finding is at the feature, or at its *user* with a *note* about the consequence there.
    """
    sink.report(
        ASSUMED_RANGE,
        graph.subject(user or element),
        notes=(note,) if note else (),
        cause=describe_missing_range(element.id),
        name=element.name,
        range=describe(domain),
        low=domain.low,
        high=domain.high,
    )


def _find_elements(
    graph: Graph, classifier: Element, behaviour: Element | None
) -> dict[str, Element]:
    elements = _find_enclosing_values(graph, classifier)
    elements |= find_port_values(graph, classifier) | find_named_values(graph, classifier)
    elements |= find_object_values(graph, classifier)
    if behaviour is not None and behaviour is not classifier:
        elements |= find_named_values(graph, behaviour) | find_object_values(graph, behaviour)
    return _find_values_in_parts(graph, classifier, behaviour or classifier) | elements


def _find_values_in_parts(
    graph: Graph, classifier: Element, behaviour: Element
) -> dict[str, Element]:
    """Return the values in parts of the object around a behaviour that the behaviour names."""
    if behaviour.kind not in _BEHAVIOURS:
        return {}
    owner: Element | None = classifier
    if behaviour is classifier:
        around = (a for a in graph.ancestors(behaviour) if a.kind in (Kind.CLASS, Kind.COMPONENT))
        owner = next(around, None)
    if owner is None or not any(part.role == "part" for part in query.features(graph, owner)):
        return {}
    names = (name_of(node) for _, node in _iter_nodes(graph, behaviour))
    return find_part_values(graph, owner, dict.fromkeys(name for name in names if name))


def _find_enclosing_values(graph: Graph, classifier: Element) -> dict[str, Element]:
    """Return the features of the block around a part that has no definition of its own.

    The members of such a part are written inside the block, so that its names are visible there.
    """
    owner = graph.owner(classifier)
    if owner is None or not classifier.attrs.get("property_specific"):
        return {}
    if owner.kind not in (Kind.CLASS, Kind.COMPONENT):
        return {}
    return _find_enclosing_values(graph, owner) | find_named_values(graph, owner)


def _name_variables(elements: Mapping[str, Element]) -> dict[str, str]:
    """Return a unique variable for each name, in document order."""
    names = sorted(elements, key=lambda name: (elements[name].ordinal, name))
    return dict(zip(names, make_unique(names, "value", "event", "none"), strict=True))


# -- features ------------------------------------------------------------------------------------

_OTHER_TEXT = "other"


class _FeatureTable(Mapping[str, Feature]):
    """The features that a classifier and one of its behaviours can name, computed on lookup."""

    def __init__(
        self,
        graph: Graph,
        classifier: Element,
        behaviour: Element | None,
        elements: Mapping[str, Element],
        assumed_range: tuple[int, int],
        enumerations: Enumerations,
    ) -> None:
        self.variables = _name_variables(elements)
        self._enumerations = enumerations
        self._graph = graph
        self._thresholds = thresholds_of(graph)
        self._features: dict[str, Feature] = {}
        self._classifier = classifier
        self.facts: tuple[Fact, ...] = ()
        if self._thresholds.has_sums or self._thresholds.limits.has_facts:
            self._add_terms(elements)
        self._behaviour = behaviour or classifier
        self._elements = elements
        self._assumed_range = assumed_range
        self._declared: dict[str, Feature] = {}

    def _add_terms(self, elements: Mapping[str, Element]) -> None:
        """Add a feature for each sum of features that the model compares, such as ``a - b``."""
        variables: dict[str, list[str]] = defaultdict(list)
        members_by_path: dict[str, dict[str, list[str]]] = defaultdict(lambda: defaultdict(list))
        names = {variable: name for name, variable in self.variables.items()}
        for name, variable in self.variables.items():
            number = self._thresholds.number_of(elements[name])
            if number is not None and number.key:
                variables[number.key].append(variable)
                members_by_path[name.rpartition(".")[0]][number.key].append(variable)
        unique = Names("value", "event", "none", *names)
        for term, domain in self._thresholds.list_terms(variables):
            text = print_term(term)
            if text in self._features:
                continue  # A difference of parts, also read in the other direction
            spelled = text.replace(" - ", " minus ").replace(" + ", " plus ").replace("*", " ")
            variable = self.variables[text] = unique.new(spelled)
            members = {key: elements[names[key]] for key, _ in term}
            numbers = {key: self._thresholds.number_of(member) for key, member in members.items()}
            is_output = any(m.attrs.get("direction") == "out" for m in members.values())
            self._features[text] = Feature(
                members[term[0][0]],
                variable,
                domain,
                direction="out" if is_output else "in",
                wording=text,
                term=term,
                constants=tuple(key for key, n in numbers.items() if n is not None and n.is_frozen),
                restriction=self._find_restriction(*numbers.values()),
            )
        family = [self._classifier, *query.generals(self._graph, self._classifier)]
        blocks = {block.id for block in family}
        self.facts = tuple(
            fact
            for path, members in members_by_path.items()
            for fact in self._thresholds.list_facts(members, () if path else blocks)
        )

    def __getitem__(self, name: str) -> Feature:
        if name not in self._features:
            self._features[name] = self._infer_values(name, self._find_declared(name))
        return self._features[name]

    def __contains__(self, name: object) -> bool:
        return name in self.variables

    def __iter__(self) -> Iterator[str]:
        return iter(self.variables)

    def __len__(self) -> int:
        return len(self.variables)

    def _find_declared(self, name: str) -> Feature:
        """Return the feature with the domain that the model declares."""
        if name not in self._declared:
            self._declared[name] = self._make_feature(name, self._assumed_range)
        return self._declared[name]

    def _make_feature(self, name: str, assumed_range: tuple[int, int]) -> Feature:
        graph, element, variable = self._graph, self._elements[name], self.variables[name]
        access = Access(self._classifier, name) if "." in name else None
        feature = make_feature(graph, element, variable, assumed_range, self._constants, access)
        feature = feature if access is None else replace(feature, wording=name)
        if "direction" not in element.attrs:
            return feature
        direction = find_direction(graph, self._classifier, name, element)
        return replace(feature, direction=direction)

    def _infer_values(self, name: str, feature: Feature) -> Feature:
        """Return the feature with undeclared values inferred from those that the behaviour uses."""
        number = self._thresholds.number_of(feature.element)
        if number is not None:
            feature = self._restrict_number(feature, number)
        if feature.is_assumed:
            return self._widen_range(name, feature)
        if self._behaviour.kind not in _BEHAVIOURS:
            return feature
        if is_string(self._graph, feature) and self._mentioned_values.texts:
            return restrict_string(feature, self._text_domain)
        return feature

    def _restrict_number(self, feature: Feature, number: Number) -> Feature:
        """Return a numeric feature with the regions that the model tells apart as its values."""
        own_number = replace(number, key="" if number.is_constant else feature.variable)
        feature = replace(feature, number=own_number)
        domain = self._thresholds.domain_of(number)
        if feature.is_assumed and self._thresholds.is_only_compared(number):
            feature = replace(feature, domain=None, is_assumed=False)
        if feature.domain is not None or domain is None or domain.regions is None:
            return feature
        quantity = self._thresholds.read_initial(feature.element)
        index = None if quantity is None else domain.regions.find(quantity.number)
        default = None if index is None else domain.literals[index]
        is_inside = quantity is None or index is not None
        is_assigned = self._thresholds.is_assigned(number)
        is_bound = quantity is not None and feature.element.attrs.get("default_kind") == "bound"
        # Without an assignment, nothing but the environment can change a quantity.
        is_own = is_assigned or (domain.regions.is_integral and not is_bound)
        return replace(
            feature,
            domain=domain,
            default=default,
            direction=feature.direction or ("" if is_own else "in"),
            invalid_default="" if is_inside else str(feature.element.attrs.get("default", "")),
            is_bound=is_bound and not is_assigned,
            term=((feature.variable, Fraction(1)),),
            constants=(feature.variable,) if number.is_frozen else (),
            restriction=self._find_restriction(number),
        )

    def _find_restriction(self, *numbers: Number | None) -> str:
        """Return a constraint on one of the numbers that their regions do not show."""
        unread = self._thresholds.limits.unread
        texts = (unread.get(number.key, "") for number in numbers if number is not None)
        return next(filter(None, texts), "")

    def _widen_range(self, name: str, feature: Feature) -> Feature:
        """Extend an assumed range to numbers on both sides of the thresholds of the feature.

        All behaviours of the classifier count, so that the range is the same in each of them.
        """
        generals = query.generals(self._graph, self._classifier)
        mentioned = (
            _find_mentioned_values(self._graph, element, self._enumerations)
            for element in (self._classifier, *generals)
        )
        values = (*mentioned, self._mentioned_values)
        numbers = [number for item in values for number in item.numbers.get(name, ())]
        if not numbers:
            return feature
        low, high = self._assumed_range
        return self._make_feature(name, (min((low, *numbers)), max((high, *numbers))))

    @cached_property
    def _constants(self) -> dict[str, int]:
        """The Integers that never change, by name; those of packages by id."""
        values = ((element.name, read_constant(element)) for element in self._elements.values())
        names = {name: value for name, value in values if value is not None}
        return {**self._enumerations.integers, **names}

    @cached_property
    def _mentioned_values(self) -> "_MentionedValues":
        return _find_mentioned_values(self._graph, self._behaviour, self._enumerations)

    @cached_property
    def _text_domain(self) -> EnumerationDomain:
        """The texts that the behaviour mentions, the default texts, and one literal for all others.

        All Strings share this domain, so that two of them can be compared.
        """
        strings = [
            feature for feature in map(self._find_declared, self) if is_string(self._graph, feature)
        ]
        defaults = [default_text(feature.element) for feature in strings]
        known_texts = [
            *self._mentioned_values.texts,
            *(text for text in defaults if text is not None),
        ]
        texts = tuple(dict.fromkeys(known_texts))
        names = [text.strip() or "empty" for text in texts]
        return EnumerationDomain(make_unique([*names, _OTHER_TEXT], "text"), texts)


# -- values that a behaviour mentions ------------------------------------------------------------

_BEHAVIOURS = frozenset([Kind.ACTIVITY, Kind.STATE_MACHINE])
_TEXT_ATTRIBUTES = ("guard", "body", "condition", "value")
_COMPARISONS = frozenset({"==", "!=", "<", "<=", ">", ">="})
_NEXT = {"<": -1, ">=": -1, ">": 1, "<=": 1}
"""Where the other side of a threshold begins: ``n < 5`` and ``n >= 5`` differ at 4 and 5."""
_GREATEST = 255
"""Numbers further from zero widen no range: the size of a domain is its number of values."""


class _MentionedValues(Struct, frozen=True):
    """The texts in a behaviour, in their order, and the numbers that matter for each name."""

    texts: tuple[str, ...]
    numbers: Mapping[str, tuple[int, ...]]


def _find_mentioned_values(
    graph: Graph, behaviour: Element, enumerations: Enumerations
) -> _MentionedValues:
    """Return the values with which a behaviour compares names, or which it assigns to them.

    A threshold counts with the number next to it, so that a comparison may be true and false. A
    constraint is no threshold: it is always true.
    """
    texts: dict[str, None] = {}
    numbers: dict[str, dict[int, None]] = {}
    for element, node in _iter_nodes(graph, behaviour):
        if isinstance(node, LiteralExpression) and isinstance(node.value, str):
            texts[node.value] = None
        for name, op, value in _iter_comparisons(node):
            # A computed threshold widens no range.
            is_plain = not isinstance(value, Binary)
            number = evaluate_integer(value, enumerations.numbers) if is_plain else None
            if number is not None and abs(number) <= _GREATEST:
                step = 0 if element.kind is Kind.CONSTRAINT else _NEXT.get(op, 0)
                numbers.setdefault(name, {}).update({number: None, number + step: None})
    return _MentionedValues(tuple(texts), {name: tuple(values) for name, values in numbers.items()})


def _iter_nodes(
    graph: Graph, behaviour: Element
) -> Iterator[tuple[Element, Expression | Statement]]:
    """Yield the elements of a behaviour with the nodes of their expressions and effects."""
    for element in graph.subtree(behaviour):
        for key in _TEXT_ATTRIBUTES:
            value = element.attrs.get(key)
            if isinstance(value, ParsedText):
                yield from ((element, node) for node in walk_tree(value.tree))


def _iter_comparisons(node: Expression | Statement) -> Iterator[tuple[str, str, Expression]]:
    """Yield the names that a node compares or assigns, with the operators and the values."""
    match node:
        case Assignment(target, value):
            pairs = [(target, ":=", value)]
        case Binary(op, left, right) if op in _COMPARISONS:
            # ``level`` belongs to both comparisons of ``0 <= level <= 7``.
            if isinstance(left, Binary) and left.op in _COMPARISONS:
                left = left.right
            pairs = [(left, op, right), (right, MIRROR.get(op, op), left)]
        case _:
            return
    for feature, op, value in pairs:
        name = name_of(feature)
        if name:
            yield name, op, value
