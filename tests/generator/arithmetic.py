"""What GLSL's operators and built-in functions make of values, exactly: integers wrap, and a float operation whose result
would have to be rounded ends the run with Undefined, like everything else that GLSL leaves open."""

from __future__ import annotations

import struct

from tree import Type

BITS = {"int": 32, "uint": 32, "int64": 64, "uint64": 64}


class Undefined(Exception):
    """The program does what GLSL does not define, or would need rounding, or runs for too long."""


def wrap(value: int, base: str) -> int:
    bits = BITS[base]
    value &= (1 << bits) - 1
    return value - (1 << bits) if not base.startswith("u") and value >> (bits - 1) else value


def exact(value: float, base: str) -> float:
    if base == "float" and struct.unpack("f", struct.pack("f", value))[0] != value:
        raise Undefined("rounding")
    return value + 0.0 if value == 0 else value


def binary(op: str, a: list, b: list, ta: Type, tb: Type, t: Type, most: int | None = None) -> list:
    """`most`: integers beyond it overflow, where GLSL does not say that they wrap."""
    if op in ("==", "!="):
        return [(a == b) == (op == "==")]
    if op == "*" and (ta.is_matrix() or tb.is_matrix()) and not (ta.is_scalar() or tb.is_scalar()):
        return product(a, b, ta, tb, t)
    n = max(len(a), len(b))
    a, b = (a * n if len(a) == 1 else a), (b * n if len(b) == 1 else b)
    return [scalar(op, x, y, ta.base, most) for x, y in zip(a, b)]


def product(a: list, b: list, ta: Type, tb: Type, t: Type) -> list:
    rows_a, cols_a = (ta.rows, ta.cols) if ta.is_matrix() else (1, ta.rows) if tb.is_matrix() else (ta.rows, 1)
    rows_b, cols_b = (tb.rows, tb.cols) if tb.is_matrix() else (tb.rows, 1)
    result = []
    for c in range(cols_b):
        for r in range(rows_a):
            total = 0.0
            for k in range(cols_a):
                total += exact(a[k * rows_a + r] * b[c * rows_b + k], t.base)
                exact(total, t.base)
            result.append(exact(total, t.base))
    return result


def scalar(op: str, x, y, base: str, most: int | None = None):
    if op in ("<", ">", "<=", ">="):
        return x < y if op == "<" else x > y if op == ">" else x <= y if op == "<=" else x >= y
    if base in ("float", "double"):
        if op == "/" and y == 0:
            raise Undefined("division")
        value = x + y if op == "+" else x - y if op == "-" else x * y if op == "*" else x / y
        return exact(value, base)
    if op in ("/", "%"):
        if y == 0 or op == "%" and (x < 0 or y < 0):
            raise Undefined("division")
        quotient = abs(x) // abs(y) * (1 if (x < 0) == (y < 0) else -1)
        return wrap(quotient if op == "/" else x - quotient * y, base)
    if op in ("<<", ">>") and not 0 <= y < BITS[base]:
        raise Undefined("shift")
    value = {"+": lambda: x + y, "-": lambda: x - y, "*": lambda: x * y, "&": lambda: x & y, "|": lambda: x | y,
             "^": lambda: x ^ y, "<<": lambda: x << y, ">>": lambda: x >> y}[op]()
    if most is not None and abs(value) > most:
        raise Undefined("overflow")
    return wrap(value, base)


def convert(v, base: str, to: str):
    if to in ("float", "double"):
        return exact(float(v), to)
    if to == "bool":
        return bool(v)
    if base in ("float", "double"):
        if not -2 ** 31 < v < 2 ** 31 or to.startswith("u") and v < 0:
            raise Undefined("conversion")
        return int(v)
    return wrap(int(v), to)


def builtin(op: str, base: str, x, y=None, z=None):
    if op in ("min", "max"):
        return min(x, y) if op == "min" else max(x, y)
    if op == "clamp":
        return min(max(x, y), z)
    if op == "abs":
        if x == -2 ** 31:
            raise Undefined("abs")
        return abs(x)
    if op == "floor":
        return float(x // 1)
    if op == "sign":
        return float((x > 0) - (x < 0))
    if op == "step":
        return 0.0 if y < x else 1.0
    if op == "mix":
        for one in (x * (1 - z), y * z, z * (y - x), x * (1 - z) + y * z, y - x):
            exact(one, base)
        return exact(x * (1 - z) + y * z, base)
    if op == "matrixCompMult":
        return exact(x * y, base)
    if op == "bitCount":
        return bin(x & 0xffffffff).count("1")
    if op == "findMSB":
        return (x if x >= 0 else ~x).bit_length() - 1
    return {"lessThan": x < y if y is not None else None,
            "greaterThanEqual": x >= y if y is not None else None, "equal": x == y, "notEqual": x != y}[op]
