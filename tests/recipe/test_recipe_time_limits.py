"""Times that requirements state are decided by the derived times of tasks and recipes."""

import pytest

import recipe_samples as samples
from sysmlc.analyses.recipe import Recipe
from sysmlc.diagnostics import Sink
from sysmlc.ir import parse_text
from sysmlc.recipe.model import Model, TimeLimit
from sysmlc.recipe.recipe_times import decide_limit


def check_limit(text: str) -> tuple[list[TimeLimit], str, list[str]]:
    """Return the limits that a requirement states for the sample, the verdict, and the messages.

    Mounting takes 600 ms: grip 300, look 100 and place 200.
    """
    ir_text = samples.task().replace(
        "    Property mount.ok", "    -> satisfies q\n    Property mount.ok"
    )
    ir_text += f'  Class q "Q" role="requirement" text="{text}"\n'
    graph, sink = parse_text(ir_text), Sink()
    Recipe().run(graph, sink)
    (model,) = graph.derived(Model)
    (task,) = model.recipe.tasks
    codes = ("SM641", "SM642")
    messages = [diagnostic.message for diagnostic in sink if diagnostic.rule.code in codes]
    verdict = decide_limit(task.limits[0], task.derived) if task.limits else ""
    return list(task.limits), verdict, messages


@pytest.mark.parametrize(
    ("text", "least", "most", "verdict"),
    [
        ("Mounting takes at most 0.6 seconds.", None, 600, "holds"),
        ("A plate is mounted within 1 min.", None, 60_000, "holds"),
        ("Mounting takes no more than 599 ms.", None, 599, "broken"),
        ("Mounting takes at least 1 s.", 1000, None, "broken"),
        ("Mounting takes at least 100 ms and at most 2 s.", 100, 2000, "holds"),
    ],
)
def test_a_time_in_the_text_of_a_requirement_is_decided(text, least, most, verdict):
    ((limit,), decided, messages) = check_limit(text)
    assert (limit.least, limit.most, decided) == (least, most, verdict)
    assert bool(messages) == (verdict == "broken")


@pytest.mark.parametrize(
    "text",
    [
        "A plate is tried at most three times.",
        "The gripper closes within 1 ms after the plate has arrived.",
        "The robot moves at most 5 m.",
        "The belt needs at most 5 s/m.",
        "Mounting is safe.",
    ],
)
def test_other_statements_are_no_limits_of_the_whole_time(text):
    assert check_limit(text) == ([], "", [])


def test_the_message_has_both_times():
    _, _, (message,) = check_limit("Mounting takes at most 500 ms.")
    assert message == (
        "requirement 'Plant::Q' allows at most 500 ms, but 'Plant::Build::mount' takes 600 ms"
    )
