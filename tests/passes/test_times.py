"""Times mean the same in every notation: units, numbers without a unit, steps, relative times."""

from fractions import Fraction
from types import SimpleNamespace

import pytest

from machine_samples import arrow, machine
from sysmlc.analyses.contracts import Contracts
from sysmlc.analyses.recipe.expressions import read_delay
from sysmlc.analyses.recipe.profile import Tags
from sysmlc.analyses.recipe.tasks import read_limits
from sysmlc.backends import sysml, uml
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.driver.registry import ConfigError, load_analysis
from sysmlc.frontends import sysml as sysml_reader
from sysmlc.frontends import xmi
from sysmlc.ir import Graph, expressions, parse_text
from sysmlc.logic.contract import BooleanDomain, Contract, IntegerDomain
from sysmlc.logic.formal_texts import is_formal, read_formal
from sysmlc.passes import pipeline
from sysmlc.sources import Source
from sysmlc.support import resources
from sysmlc.support.units import list_time_words, read_duration, read_time

WORDS = {
    "1/1000": "us µs μs microsec microsecs microsecond microseconds",
    "1": "ms msec millisec millisecs millisecond milliseconds",
    "1000": "s sec secs second seconds",
    "60000": "min mins minute minutes",
    "3600000": "h hr hrs hour hours",
    "86400000": "d day days",
    "steps": "tick ticks step steps",
}
"""Words for units of time, by the number of milliseconds; steps have none."""
EACH_WORD = [(word, key) for key, words in WORDS.items() for word in words.split()]

CLASSIFICATION = pipeline.build_pipeline(("resolve", "kept", "inherit", "classify"))


def read_contract(graph, tick_seconds):
    """Return the contract of the only state machine, and the messages about it."""
    sink = Sink()
    CLASSIFICATION.run(graph, Sink())
    Contracts(tick_seconds=tick_seconds).run(graph, sink)
    (contract,) = graph.derived(Contract)
    return contract, [item.message for item in sink if item.rule.code == "SM417"]


def count_steps(graph, tick_seconds):
    """Return the steps after which the time of a state is over, or the name of an input."""
    contract, _ = read_contract(graph, tick_seconds)
    for variable in contract.variables:
        match variable.domain:
            case IntegerDomain(_, high) if variable.name.startswith("ticks_"):
                return high
            case BooleanDomain() if variable.name.startswith("time_"):
                return variable.name
    raise AssertionError(contract.variables)


def draw(when, *, is_relative=False):
    """Return the IR text of a machine whose state B waits for a time."""
    text = machine(arrow("a", "b", "start"), arrow("b", "a", after=when))
    return text.replace(f'when="{when}"', f'when="{when}" relative=true') if is_relative else text


# -- units -----------------------------------------------------------------------------------------


def test_the_table_has_every_word():
    words = [word for word, _ in EACH_WORD]
    assert sorted(words) == sorted(list_time_words())


@pytest.mark.parametrize(("word", "milliseconds"), EACH_WORD)
def test_a_word_is_the_same_unit_in_every_notation(word, milliseconds):
    is_step = milliseconds == "steps"
    # 500,000 units are a whole number of milliseconds, and of steps of 500 us.
    expected = None if is_step else int(500_000 * Fraction(milliseconds))
    for spelling in (word, word.upper().replace("Μ", "μ"), word.title().replace("Μ", "μ")):
        text = f"500000 {spelling}"
        duration = read_duration(text)
        assert duration.milliseconds == expected
        steps = duration.count_steps(0.0005)
        assert steps == (500_000 if is_step else expected * 2)
        delay = read_delay(read_time(f"after {text}"))
        is_opaque = not isinstance(delay, expressions.Literal)
        assert is_opaque == is_step
        if not is_step:
            assert delay.value == expected
        assert Tags({"tag.duration": text}).integer("duration") == expected
        assert read_prose(f"Mounting takes at most {text}.") == expected
    assert count_steps(parse_text(draw(f"after (500000{word})")), 0.0005) == steps
    sentence = "Whenever p, the Gate shall within {} satisfy q."
    assert is_formal("English", sentence.format(f"3 {word}"))
    tick_seconds = 1.0 if is_step else float(Fraction(milliseconds) / 1000)
    domains = {"p": BooleanDomain(), "q": BooleanDomain()}
    assert read_formal(sentence.format(f"3 {word}"), "FRET", domains, (), tick_seconds) == (
        read_formal(sentence.format("3 ticks"), "FRET", domains, (), tick_seconds)
    )


def read_prose(text):
    """Return the most milliseconds that the text of a requirement allows."""
    requirement = f'Class r "R" role="requirement" text="{text}"'
    graph = parse_text(f'Activity t "T"\n  -> satisfies r\n{requirement}\n')
    limits = read_limits(
        SimpleNamespace(graph=graph, name=lambda element: element.name), [graph["t"]]
    )
    return limits[0].most if limits else None


@pytest.mark.parametrize("word", ["m", "M", "kg", "weeks"])
def test_other_words_are_no_units_of_time(word):
    assert read_duration(f"3 {word}") is None
    assert isinstance(count_steps(parse_text(draw(f"after 3 {word}")), 1.0), str)
    assert not isinstance(read_delay(read_time(f"after 3 {word}")), expressions.Literal)
    assert Tags({"tag.duration": f"3 {word}"}).integer("duration") is None
    assert read_prose(f"Mounting takes at most 3 {word}.") is None
    assert not is_formal("", f"Whenever p, the Gate shall within 3 {word} satisfy q.")


@pytest.mark.parametrize("symbol", ["H", "S", "MS"])
def test_a_quantity_has_the_exact_unit_and_a_word_any_letter_case(symbol):
    assert Tags({"tag.duration": f"3 {symbol}"}).integer("duration") is not None
    assert Tags({"tag.duration": "3"}, {"duration": symbol}).integer("duration") is None
    text = f"""package Plant {{ part def Gate {{ exhibit state run {{ entry; then a; state a;
        transition first a accept after 3 [SI::{symbol}] then b; state b; }} }} }}"""
    graph = Graph()
    sysml_reader.FRONTEND.read([Source("m.sysml", text.encode())], graph, Sink(), Coverage())
    assert isinstance(count_steps(graph, 1.0), str)


# -- numbers without a unit, relative and absolute times -------------------------------------------


@pytest.mark.parametrize(
    ("text", "is_relative", "shown", "milliseconds"),
    [
        ("5", True, "after 5 s", 5000),
        ("5", False, "at 5", None),
        ("after 5", False, "after 5 s", 5000),
        ("After(5s)", False, "after 5 s", 5000),
        ("at 5", False, "at 5", None),
        ("0.5", True, "after 0.5 s", 500),
        (" 5 [min] ", True, "after 5 min", 300_000),
        ("1e3 ms", True, "after 1e3 ms", 1000),
        ("-5 s", True, "after -5 s", None),
        ("5 [", True, "after 5 [", None),
        ("1,5 s", True, "after 1,5 s", None),
        ("afternoon", False, "at afternoon", None),
        ("after (a) + (b)", False, "after (a) + (b)", None),
    ],
)
def test_a_number_is_in_seconds_and_after_makes_a_time_relative(
    text, is_relative, shown, milliseconds
):
    time = read_time(text, is_relative=is_relative)
    assert str(time) == shown
    assert (time.duration.milliseconds if time.duration else None) == milliseconds


def test_a_recipe_does_not_wait_for_an_absolute_time():
    assert read_delay(read_time("after 5")) == expressions.Literal(5000)
    assert expressions.print_expression(read_delay(read_time("after pause"))) == "pause"
    for text in ("at 5", "5", "after 5 us", "after 5 ticks"):
        assert not isinstance(read_delay(read_time(text)), expressions.Literal)


# -- steps -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("when", "tick_seconds", "steps", "message"),
    [
        ("after 5", 0.5, 10, ""),
        ("after 5 ticks", 0.5, 5, ""),
        ("after 0.3 s", 0.1, 3, ""),
        ("after 0", 1.0, 1, ""),
        ("after 5", 2.0, 3, "is not a whole number of steps of 2 s; the contract counts 3 steps"),
        (
            "after 0.1 s",
            1.0,
            1,
            "is not a whole number of steps of 1 s; the contract counts 1 step",
        ),
        (
            "5 s",
            1.0,
            "time_5_s",
            "is absolute; the contract treats the event as the input 'time_5_s'",
        ),
        (
            "after 3 m",
            1.0,
            "time_3_m",
            "is in 'm', which is not a known unit of time; the contract treats the event as the "
            "input 'time_3_m'",
        ),
    ],
)
def test_a_time_that_is_not_a_whole_number_of_steps_is_reported(when, tick_seconds, steps, message):
    graph = parse_text(draw(when))
    contract, messages = read_contract(graph, tick_seconds)
    assert count_steps(parse_text(draw(when)), tick_seconds) == steps
    text = when.removeprefix("after ")
    assert messages == ([f"time '{text}' {message}"] if message else [])
    assert contract.guarantees


@pytest.mark.parametrize("length", [0, -1, float("nan"), float("inf")])
def test_a_step_has_a_length(length):
    with pytest.raises(ConfigError, match=r"passes\.contracts: tick_seconds: .* is no length"):
        load_analysis("contracts", {"contracts": {"tick_seconds": float(length)}})


def test_a_unit_of_the_model_is_converted():
    text = """package Plant {
        attribute <cyc> cycle : ISQ::DurationUnit {
            attribute :>> unitConversion : MeasurementReferences::ConversionByConvention {
                :>> referenceUnit = SI::s; :>> conversionFactor = 2.5; } }
        part def Gate { exhibit state run { entry; then a; state a;
            transition first a accept after 3 [cyc] then b; state b; } } }"""
    graph = Graph()
    sysml_reader.FRONTEND.read([Source("m.sysml", text.encode())], graph, Sink(), Coverage())
    assert count_steps(graph, 0.5) == 15


# -- round trips -----------------------------------------------------------------------------------


def save_as_sysml(graph):
    """Return the graph of the SysML v2 text of a graph, and this text."""
    text, _ = sysml.print_document(graph, Sink())
    library = resources.read_text("metamodels", "SysMLC.sysml")
    files = [Source("m.sysml", text.encode()), Source("SysMLC.sysml", library.encode())]
    copy = Graph()
    sysml_reader.FRONTEND.read(files, copy, Sink(), Coverage())
    CLASSIFICATION.run(copy, Sink())
    return copy, text


def save_as_uml(graph):
    """Return the graph of the UML file of a graph."""
    copy = Graph()
    source = Source("m.uml", uml.write_document(graph, Sink()).encode())
    xmi.FRONTEND.read([source], copy, Sink(), Coverage())
    CLASSIFICATION.run(copy, Sink())
    return copy


ROUND_TRIPS = {
    "5": "5 [SI::s]",
    "5 s": "5 [SI::s]",
    "5s": "5 [SI::s]",
    "after 5": "5 [SI::s]",
    "5 min": "5 [SI::min]",
    "3 m": "'3 m'",
    "1 h": "1 [SI::h]",
    "100 ms": "100 [SysMLC::Units::ms]",
    "5 ticks": "'5 ticks'",
}
"""Texts of relative times in UML and in SysML v2."""


def draw_all():
    """Return the IR text of a machine with a state for each time, relative and absolute."""
    names = [f"s{number}" for number in range(2 * len(ROUND_TRIPS))]
    parts = [f'State {name} "{name}"\n' for name in names]
    whens = [(when, relative) for when in ROUND_TRIPS for relative in ("", " relative=true")]
    for name, (when, relative) in zip(names, whens, strict=True):
        text = arrow(name, "a", after=when)
        parts.append(text.replace(f'when="{when}"', f'when="{when}"{relative}'))
    return machine(*parts)


def list_times(graph, tick_seconds):
    """Return the variables with their domains, and the number of messages."""
    contract, messages = read_contract(graph, tick_seconds)
    variables = [(variable.name, str(variable.domain)) for variable in contract.variables]
    return sorted(variables), len(messages)


def test_a_time_means_the_same_in_uml_and_sysml_v2():
    graph = parse_text(draw_all())
    CLASSIFICATION.run(graph, Sink())
    as_uml = save_as_uml(graph)
    as_sysml, text = save_as_sysml(graph)
    quote = "'"
    for accept in ROUND_TRIPS.values():
        # A number can follow the name of an attribute that stands for a text.
        assert f"accept after {accept.removesuffix(quote)}" in text
    copies = [as_uml, as_sysml, save_as_uml(as_sysml), save_as_sysml(as_uml)[0]]
    for tick_seconds in (0.5, 1.0, 2.0):
        times = list_times(parse_text(draw_all()), tick_seconds)
        assert len(times[0]) > len(ROUND_TRIPS)
        assert [list_times(copy, tick_seconds) for copy in copies] == [times] * 4
