"""What expressions are made of: literals and variables with the range of their values, and what may stand beside them.

A range is (least, most) of every component, None where any integer can come; `frac`: binary places behind the point.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from tree import E, Type, Variable

REST = (-64.0, 64.0)  # floats in variables, in quarters
MANY = (-999, 999)  # integers where they do not wrap
WIDE = 2 ** 24
OPAQUE = ("buffer", "image", "counter", "texture")  # not used as plain variables


@dataclass(frozen=True)
class Context:
    depth: int = 3
    pure: bool = False  # no side effects at all
    constant: bool = False  # literals and operators only
    no_read: frozenset = frozenset()
    no_write: frozenset = frozenset()

    def deeper(self) -> "Context":
        return replace(self, depth=self.depth - 1)

    def beside(self, *others: E) -> "Context":
        """For an operand whose order relative to the others is open."""
        reads = frozenset().union(*(o.reads for o in others))
        writes = frozenset().union(*(o.writes for o in others))
        return replace(self, no_read=self.no_read | writes, no_write=self.no_write | reads | writes)


def union(*ranges):
    if any(r is None for r in ranges):
        return None
    return (min(r[0] for r in ranges), max(r[1] for r in ranges))


def within(inner, outer) -> bool:
    return outer is None or (inner is not None and inner[0] >= outer[0] and inner[1] <= outer[1])


def fits(range_, frac: int) -> bool:
    return max(abs(range_[0]), abs(range_[1])) * 2 ** frac < 2 ** 23


def lit(type_: Type, value) -> E:
    if type_.base == "bool":
        return E("lit", type_, data=bool(value))
    frac = 0
    if type_.base in ("float", "double"):
        value = float(value)
        while value * 2 ** frac != int(value * 2 ** frac):
            frac += 1
    return E("lit", type_, data=value, range_=(value, value), frac=frac)


def var(variable: Variable) -> E:
    frac = 2 if variable.type.base in ("float", "double") else 0
    if variable.storage == "builtin":
        frac = 1
    e = E("var", variable.type, data=variable, range_=variable.range, frac=frac)
    if variable.storage not in ("constant", "uniform", "builtin"):
        e.reads = frozenset([variable])
    return e


def math_floor(x: float) -> float:
    return float(x // 1)


def product_bound(a: E, b: E) -> float:
    return max(abs(a.range[0]), abs(a.range[1])) * max(abs(b.range[0]), abs(b.range[1]))


def products(a: E, b: E):
    ends = [x * y for x in a.range for y in b.range]
    return (min(ends), max(ends))
