"""Check the arguments of the functions of the API, and explain a mistake in one sentence."""

import inspect
from collections.abc import Callable
from functools import wraps
from types import NoneType, UnionType
from typing import Any, ParamSpec, TypeVar, Union, get_args, get_origin, get_type_hints

from sysmlc.support.suggestions import did_you_mean

_P = ParamSpec("_P")
_T = TypeVar("_T")


def check_arguments(function: Callable[_P, _T]) -> Callable[_P, _T]:
    """Return the function with checks of its arguments against their annotations.

    An unknown name or a wrong type raises TypeError. The types of the items of a collection are not
    checked.
    """

    @wraps(function)
    def check_and_call(*args: _P.args, **kwargs: _P.kwargs) -> _T:
        signature, name = inspect.signature(function), function.__name__
        for keyword in kwargs:
            if keyword not in signature.parameters:
                advice = did_you_mean(keyword, signature.parameters)
                raise TypeError(f"{name}() has no argument '{keyword}'; {advice}")
        hints = get_type_hints(function)
        for argument, value in signature.bind(*args, **kwargs).arguments.items():
            types = _list_types(hints[argument])
            if not isinstance(value, tuple(types)):
                expected = " or ".join(dict.fromkeys(map(_name_type, types)))
                problem = f"'{argument}' must be {expected}, not {_name_type(type(value))}"
                raise TypeError(f"{name}(): {problem}")
        return function(*args, **kwargs)

    return check_and_call


def _list_types(hint: Any) -> list[type]:  # noqa: ANN401 - any annotation
    """Return the classes of an annotation, without the types of items."""
    if get_origin(hint) in (Union, UnionType):
        return [type_ for part in get_args(hint) for type_ in _list_types(part)]
    if hint is float:
        return [float, int]
    return [get_origin(hint) or hint]


def _name_type(type_: type) -> str:
    return "None" if type_ is NoneType else type_.__name__
