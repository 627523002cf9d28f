"""Outcomes for texts in which only literals are others than in an earlier run."""

from collections.abc import Iterator, Mapping

from sysmlc.cache import Cache
from sysmlc.driver import moving
from sysmlc.driver.compilation import Opened, Request
from sysmlc.driver.outcome import Outcome, digest_of
from sysmlc.driver.recall import recall
from sysmlc.driver.recording import Recorded
from sysmlc.driver.restating import LostError, restated
from sysmlc.driver.shapes import Kept
from sysmlc.frontends.base import Valued
from sysmlc.ir import AttrValue
from sysmlc.ir.reads import Value
from sysmlc.sources import Source
from sysmlc.values import replace


def restored(
    cache: Cache, known: Kept, opened: Opened, request: Request
) -> tuple[Outcome, Recorded] | None:
    """The outcome of an earlier run with what other literals change in it; None if it is lost.

    With it comes what a compilation would have recorded.
    """
    before = recall(cache, known.key, opened.root)
    if before is None:
        return None
    try:
        return _restored(known, before, opened, request)
    except Exception:
        return None


def _restored(
    known: Kept, before: Outcome, opened: Opened, request: Request
) -> tuple[Outcome, Recorded]:
    changed: dict[Value, AttrValue] = {}
    moves: dict[str, moving.Move] = {}
    sources: list[Source] = []
    for frontend, old, new in _edited(known, opened):
        moves[new.name] = moving.Move(frontend, old, new)
        sources.append(new)
        changed |= _values(frontend, old, new, known.recorded)
    texts, recorded = restated(known.recorded, changed, request, before.inputs)
    after = moving.moved(_with(before, texts), moves, sources, known.digests)
    return after, _moved(recorded, moves)


def _moved(recorded: Recorded, moves: Mapping[str, moving.Move]) -> Recorded:
    """Literals where they are now; elements stay where findings of that time have them."""
    return replace(
        recorded,
        literals=tuple(
            replace(one, form=_form(one.form, moves[one.file])) if one.file in moves else one
            for one in recorded.literals
        ),
        asked=tuple(
            (file, moves[file].character(at)) if file in moves else (file, at)
            for file, at in recorded.asked
        ),
    )


def _form(form: AttrValue, move: moving.Move) -> AttrValue:
    if isinstance(form, tuple):
        return tuple(_form(one, move) for one in form)
    return move.character(form) if isinstance(form, int) else form


def _edited(known: Kept, opened: Opened) -> Iterator[tuple[Valued, Source, Source]]:
    """Texts that are others now, as they were and as they are."""
    for one in opened.reading.recognised:
        name, frontend = one.source.name, one.frontend
        if one.source.sha256 != known.digests.get(name):
            if not isinstance(frontend, Valued) or name not in known.texts:
                raise LostError
            yield frontend, Source(name, known.texts[name]), one.source


def _values(
    frontend: Valued, old: Source, new: Source, recorded: Recorded
) -> Mapping[Value, AttrValue]:
    literals = [one for one in recorded.literals if one.file == new.name]
    asked = {place for file, place in recorded.asked if file == new.name}
    found = frontend.values(old, new, literals, asked)
    if found is None:
        raise LostError
    return found


def _with(before: Outcome, texts: Mapping[str, str]) -> Outcome:
    """The outcome with other texts of files that are not withheld."""
    said = {path: text for path, text in texts.items() if path in before.texts}
    files = tuple(
        replace(one, sha256=digest_of(said[one.path])) if one.path in said else one
        for one in before.files
    )
    return replace(before, files=files, texts=moving.Texts(before.texts, said))


def _shapes(opened: Opened) -> Iterator[tuple[str, str]]:
    """What each text says but for literals, by the name of its file."""
    for one in opened.reading.recognised:
        said = one.frontend.shape(one.source) if isinstance(one.frontend, Valued) else ""
        if said:
            yield one.source.name, said
