"""A terminate action in a state has no counterpart in UML and is reported."""

import pytest
from reading_v2 import Reading

RUN = "package P { part def Cell { exhibit state Run { entry; then dead; state dead { %s } } } }"


def list_messages(reading):
    return [diagnostic.message for diagnostic in reading.sink if diagnostic.rule.code == "SM481"]


@pytest.mark.parametrize("held", ["entry terminate;", "do terminate;", "exit terminate;"])
def test_a_terminate_action_of_a_state_is_reported(held):
    (message,) = list_messages(Reading(RUN % held))
    assert message.startswith("a terminate action of a state or a transition is read as an action")


def test_one_that_ends_an_action_of_the_state_is_the_end_of_that_action():
    reading = Reading(RUN % "entry action lock { action a; then terminate; }")
    assert list_messages(reading) == []
