"""What a text says, apart from where it says it."""

import pytest

from sysmlc.language.text.words import digest, said, spans

TEXT = "part a { attribute b = c + 'd e'; }\n"


@pytest.mark.parametrize(
    "same",
    [
        "  part a { attribute b = c + 'd e'; }\n",
        "// a note\npart a { attribute b = c + 'd e'; }\n\n",
        "part\ta //* note */ {  attribute b =  c + 'd e'; }\r\n",
    ],
)
def test_blanks_and_notes_say_nothing(same):
    assert digest(same) == digest(TEXT)


@pytest.mark.parametrize(
    "other",
    [
        "part a { attribute b = c + 'd  e'; }\n",
        "part a { attribute b = c +'d e'; }\n",
        "part a {\n attribute b = c + 'd e'; }\n",
        "part a { attribute b = c - 'd e'; }\n",
        "part a { attribute b = c + 'd e'; }",
        "part a { /* c */ attribute b = c + 'd e'; }\n",
        "part a { attrib ute b = c + 'd e'; }\n",
    ],
)
def test_tokens_what_parts_them_and_the_ends_of_lines_do(other):
    assert digest(other) != digest(TEXT)


@pytest.mark.parametrize("damaged", ["part a { § }", "part 'a", "/* never closed", "part\0a"])
def test_what_is_not_made_of_tokens_has_no_digest(damaged):
    assert digest(damaged) == ""


def test_tokens_have_their_places_and_the_end_has_one():
    assert spans("a // b\n .c ") == [(0, 1), (8, 9), (9, 10), (11, 11)]


def test_part_of_a_text_is_said_in_one_line_without_notes():
    text = "x = a  +\n  // why\n b.c('d  e' , 2) ;"
    assert said(text, 4, len(text) - 2) == "a + b.c('d  e' , 2)"
