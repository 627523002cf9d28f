"""``sysmlc synth --deadline``: the smallest bound that a contract can promise."""

from sysmlc.synthesis import rules


def test_the_bound_is_found(here):
    here.write("lamp.gr1.json", rules.NO_DEADLINE.read_page().right)
    made = here.sysmlc("synth", "lamp.gr1.json", "--deadline", "late")
    assert [made.exit_code, made.stdout] == [
        0,
        "lamp: late <= 1 can be guaranteed, no smaller bound\n",
    ]


def test_that_there_is_none_is_an_error_and_exit_code_1(here):
    here.write("lamp.gr1.json", rules.NO_DEADLINE.read_page().wrong)
    made = here.sysmlc("synth", "lamp.gr1.json", "--deadline", "late")
    assert made.exit_code == 1
    assert made.stdout == "lamp: late: no bound below the end of the range can be guaranteed\n"
    expected = "error[SM576 no-deadline]: 'lamp' can guarantee no bound for late: even 2 is"
    assert expected in made.stderr


def test_an_unknown_timer_is_an_error_and_exit_code_2(here):
    here.write("lamp.gr1.json", rules.NO_TIMER.read_page().wrong)
    made = here.sysmlc("synth", "lamp.gr1.json", "--deadline", "due")
    assert [made.exit_code, made.stdout] == [2, "lamp: due: not decided\n"]
    assert "error[SM575 deadline-of-no-number]" in made.stderr
    assert "help: name one of its numeric variables: late" in made.stderr


def test_nothing_is_written_with_a_deadline(here):
    here.write("lamp.gr1.json", rules.NO_DEADLINE.read_page().right)
    made = here.sysmlc("synth", "lamp.gr1.json", "--deadline", "late", "-o", "out")
    assert made.exit_code == 2
    assert "--deadline decides only" in made.stderr
