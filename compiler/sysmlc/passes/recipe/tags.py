"""Tagged values of the recipe profile that do not have the type that the profile gives them."""

from collections.abc import Callable, Iterator

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Element, Kind
from sysmlc.passes.recipe.context import Context, Tags
from sysmlc.passes.recipe.profile import NAMESPACE
from sysmlc.recipe import samples

UNREADABLE_TAG = rule(
    "SM622",
    "recipe-tag-unreadable",
    Severity.WARNING,
    "'{tag}' of «{stereotype}» on '{element}' is '{value}', but must be {expected}; it is left out",
    "Durations are whole milliseconds; the profile sysmlc gives the type of each tagged value.",
    "correct the tagged value",
    samples.task(close="soon"),
    samples.task(),
)

_Reading = tuple[str, Callable[[Tags, str], object]]
_WHOLE: _Reading = ("a whole number, 0 or more", Tags.integer)
_AMOUNT: _Reading = ("a number, 0 or more", Tags.amount)
_ENDPOINT: _Reading = ("an address opc.tcp://...", Tags.endpoint)
_TIMES = ("duration", "minDuration", "maxDuration", "timeout")
_EXPECTED: dict[str, _Reading] = {
    **dict.fromkeys((*_TIMES, "priority", "buffer", "maxIterations"), _WHOLE),
    **dict.fromkeys(("minPower", "maxPower", "quantity"), _AMOUNT),
    "endpoint": _ENDPOINT,
    "kind": ("call, read, write or subscribe", Tags.call_kind),
    "use": ("consumed, produced or carried", Tags.material_use),
}


def check_tags(context: Context, sink: Sink) -> None:
    """Report tagged values that are left out because they cannot be read."""
    for application, stereotype in _ours(context):
        tags = Tags(application.attrs)
        for name, (expected, reading) in _EXPECTED.items():
            value = tags.text(name)
            is_resource = stereotype == "MachineFunction" and name == "use"
            if value and not is_resource and reading(tags, name) is None:
                owner = context.graph.owner(application) or application
                sink.report(
                    UNREADABLE_TAG,
                    context.graph.subject(owner),
                    tag=name,
                    stereotype=stereotype,
                    element=context.name(owner),
                    value=value,
                    expected=expected,
                )


def _ours(context: Context) -> Iterator[tuple[Element, str]]:
    for one in context.graph.of_kind(Kind.APPLICATION):
        if one.attrs.get("namespace") == NAMESPACE:
            yield one, str(one.attrs.get("stereotype", ""))
