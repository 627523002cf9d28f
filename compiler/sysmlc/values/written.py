"""Functions that set the fields of a value: one for each number of fields that values have.

They are written out, for to compile them takes a process 0.01 s. Setters return None, so that
``or`` calls one after the other.
"""

from collections.abc import Callable
from typing import Any

Setter = Callable[[Any, Any], object]
"""Sets a field of a value, and returns None."""
Init = Callable[..., object]

# fmt: off
WRITTEN: tuple[Callable[..., Init], ...] = (
    lambda: lambda self: None,
    lambda a: lambda self, _a: a(self, _a),
    lambda a, b: lambda self, _a, _b: a(self, _a) or b(self, _b),
    lambda a, b, c: lambda self, _a, _b, _c: a(self, _a) or b(self, _b) or c(self, _c),
    lambda a, b, c, d: (
        lambda self, _a, _b, _c, _d: (
            a(self, _a) or b(self, _b) or c(self, _c) or d(self, _d)
        )
    ),
    lambda a, b, c, d, e: (
        lambda self, _a, _b, _c, _d, _e: (
            a(self, _a) or b(self, _b) or c(self, _c) or d(self, _d) or e(self, _e)
        )
    ),
    lambda a, b, c, d, e, f: (
        lambda self, _a, _b, _c, _d, _e, _f: (
            a(self, _a) or b(self, _b) or c(self, _c) or d(self, _d) or e(self, _e)
            or f(self, _f)
        )
    ),
    lambda a, b, c, d, e, f, g: (
        lambda self, _a, _b, _c, _d, _e, _f, _g: (
            a(self, _a) or b(self, _b) or c(self, _c) or d(self, _d) or e(self, _e)
            or f(self, _f) or g(self, _g)
        )
    ),
    lambda a, b, c, d, e, f, g, h: (
        lambda self, _a, _b, _c, _d, _e, _f, _g, _h: (
            a(self, _a) or b(self, _b) or c(self, _c) or d(self, _d) or e(self, _e)
            or f(self, _f) or g(self, _g) or h(self, _h)
        )
    ),
    lambda a, b, c, d, e, f, g, h, i: (
        lambda self, _a, _b, _c, _d, _e, _f, _g, _h, _i: (
            a(self, _a) or b(self, _b) or c(self, _c) or d(self, _d) or e(self, _e)
            or f(self, _f) or g(self, _g) or h(self, _h) or i(self, _i)
        )
    ),
    lambda a, b, c, d, e, f, g, h, i, j: (
        lambda self, _a, _b, _c, _d, _e, _f, _g, _h, _i, _j: (
            a(self, _a) or b(self, _b) or c(self, _c) or d(self, _d) or e(self, _e)
            or f(self, _f) or g(self, _g) or h(self, _h) or i(self, _i) or j(self, _j)
        )
    ),
    lambda a, b, c, d, e, f, g, h, i, j, k: (
        lambda self, _a, _b, _c, _d, _e, _f, _g, _h, _i, _j, _k: (
            a(self, _a) or b(self, _b) or c(self, _c) or d(self, _d) or e(self, _e)
            or f(self, _f) or g(self, _g) or h(self, _h) or i(self, _i) or j(self, _j)
            or k(self, _k)
        )
    ),
    lambda a, b, c, d, e, f, g, h, i, j, k, m: (
        lambda self, _a, _b, _c, _d, _e, _f, _g, _h, _i, _j, _k, _m: (
            a(self, _a) or b(self, _b) or c(self, _c) or d(self, _d) or e(self, _e)
            or f(self, _f) or g(self, _g) or h(self, _h) or i(self, _i) or j(self, _j)
            or k(self, _k) or m(self, _m)
        )
    ),
    lambda a, b, c, d, e, f, g, h, i, j, k, m, n: (
        lambda self, _a, _b, _c, _d, _e, _f, _g, _h, _i, _j, _k, _m, _n: (
            a(self, _a) or b(self, _b) or c(self, _c) or d(self, _d) or e(self, _e)
            or f(self, _f) or g(self, _g) or h(self, _h) or i(self, _i) or j(self, _j)
            or k(self, _k) or m(self, _m) or n(self, _n)
        )
    ),
    lambda a, b, c, d, e, f, g, h, i, j, k, m, n, o: (
        lambda self, _a, _b, _c, _d, _e, _f, _g, _h, _i, _j, _k, _m, _n, _o: (
            a(self, _a) or b(self, _b) or c(self, _c) or d(self, _d) or e(self, _e)
            or f(self, _f) or g(self, _g) or h(self, _h) or i(self, _i) or j(self, _j)
            or k(self, _k) or m(self, _m) or n(self, _n) or o(self, _o)
        )
    ),
    lambda a, b, c, d, e, f, g, h, i, j, k, m, n, o, p: (
        lambda self, _a, _b, _c, _d, _e, _f, _g, _h, _i, _j, _k, _m, _n, _o, _p: (
            a(self, _a) or b(self, _b) or c(self, _c) or d(self, _d) or e(self, _e)
            or f(self, _f) or g(self, _g) or h(self, _h) or i(self, _i) or j(self, _j)
            or k(self, _k) or m(self, _m) or n(self, _n) or o(self, _o) or p(self, _p)
        )
    ),
)
"""By number of fields: takes a setter for each, gives ``__init__``."""
# fmt: on
