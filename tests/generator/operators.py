"""Random operators and built-in functions of a wanted type, without undefined behaviour and with exact results."""

from __future__ import annotations

from operands import WIDE, Context, fits, lit, math_floor, product_bound, products, union, var, within
from tree import BOOL, DOUBLE, E, FLOAT, INT, INT64, UINT, UINT64, Type, vec


class Operators:
    """Part of Expressions, whose methods it calls."""

    def operands(self, type_: Type, ctx: Context, mixed: bool = True) -> tuple[E, E]:
        """Two of the type; one may be a scalar if the type is a vector."""
        ta = tb = type_
        if mixed and type_.is_vector() and self.random.random() < 0.3:
            if self.random.random() < 0.5:
                ta = type_.scalar()
            else:
                tb = type_.scalar()
        a = self.expression(ta, ctx.deeper())
        return a, self.expression(tb, ctx.deeper().beside(a))

    def int_op(self, type_: Type, ctx: Context) -> E | None:
        wrap = self.dialect.integers
        op = self.random.choice(["+", "-", "*", "/"] + (["%", "&", "|", "^", "<<", ">>", "~", "-u", "min", "max", "conv",
                                                        "sel"] if wrap else ["-u", "conv"]))
        if op == "conv" and type_.is_scalar():
            return self.convert(self.expression(self.random.choice([FLOAT, BOOL] + ([UINT] if wrap else []) + self.wides()),
                                                ctx.deeper()), INT)
        if op == "sel":
            op = self.random.choice(["abs", "bitCount", "findMSB", "bitfieldExtract", "length"])
            if op == "length":
                arrays = [v for v in self.variables(ctx) if v.type.dims]
                if not arrays or not type_.is_scalar():
                    return None
                v = self.random.choice(arrays)
                return E("length", INT, [var(v)], range_=(v.type.dims[0],) * 2)
            a = self.expression(type_, ctx.deeper())
            if op == "abs":
                return E("builtin", type_, [a], "abs", (0, max(abs(a.range[0]), abs(a.range[1])))) if a.range else None
            if not self.dialect.bit_functions:
                return None
            if op == "bitfieldExtract":
                offset = self.random.randint(0, 20)
                bits = self.random.randint(1, 11)
                return E("builtin", type_, [a, lit(INT, offset), lit(INT, bits)], op, (-1024, 1023))
            return E("builtin", type_, [a], op, (0, 32) if op == "bitCount" else (-1, 31))
        if op in ("~", "-u", "conv"):
            a = self.expression(type_, ctx.deeper())
            r = (-a.range[1], -a.range[0]) if a.range and op == "-u" else None
            if op == "conv" or (r is None and not wrap):
                return None
            return E("un", type_, [a], "-" if op == "-u" else op, r)
        if op in ("min", "max"):
            a, b = self.operands(type_, ctx, False)
            return E("builtin", type_, [a, b], op, union(a.range, b.range))
        if op in ("<<", ">>"):
            a = self.expression(type_, ctx.deeper())
            return E("bin", type_, [a, lit(INT, self.random.randint(0, 12))], op)
        if op in ("/", "%"):
            a = self.expression(type_, ctx.deeper())
            if op == "%":
                a = E("bin", type_, [a, lit(INT, 2147483647)], "&", (0, 2147483647))
            by = self.random.randint(2, 17)
            r = (int(a.range[0] / by) - 1, int(a.range[1] / by) + 1) if a.range else None
            return E("bin", type_, [a, lit(INT, by)], op, r if op == "/" else (0, by - 1))
        a, b = self.operands(type_, ctx)
        r = None
        if a.range and b.range:
            ends = [x + y if op == "+" else x - y if op == "-" else x * y for x in a.range for y in b.range]
            if op == "&" and a.range[0] >= 0:
                r = (0, a.range[1])
            elif op in ("+", "-", "*"):
                r = (min(ends), max(ends))
                if not within(r, (-WIDE, WIDE)):
                    r = None
        if r is None and not wrap:
            return None
        return E("bin", type_, [a, b], op, r)

    def wides(self) -> list[Type]:
        return [INT64, UINT64] if self.dialect.int64 else []

    def wide_op(self, type_: Type, ctx: Context) -> E | None:
        # No min, no max: Mesa 22.3 folds those of 64-bit constants to 0.
        op = self.random.choice(["+", "-", "*", "/", "&", "|", "^", "<<", ">>", "~", "conv"])
        if op == "conv":
            if not type_.is_scalar():
                return None
            return self.convert(self.expression(self.random.choice([INT, UINT, BOOL]), ctx.deeper()), type_)
        if op == "~":
            return E("un", type_, [self.expression(type_, ctx.deeper())], "~")
        if op in ("<<", ">>"):
            return E("bin", type_, [self.expression(type_, ctx.deeper()), lit(INT, self.random.randint(0, 63))], op)
        if op == "/":
            a = self.expression(type_, ctx.deeper())
            return E("bin", type_, [a, lit(type_.scalar(), self.random.randint(2, 1000))], op)
        a, b = self.operands(type_, ctx)
        return E("bin", type_, [a, b], op)

    def uint_op(self, type_: Type, ctx: Context) -> E | None:
        op = self.random.choice(["+", "-", "*", "/", "%", "&", "|", "^", "<<", ">>", "~", "min", "max", "conv"])
        if op == "conv":
            if not type_.is_scalar():
                return None
            return self.convert(self.expression(self.random.choice([INT, INT, BOOL]), ctx.deeper()), UINT)
        if op == "~":
            return E("un", type_, [self.expression(type_, ctx.deeper())], "~")
        if op in ("min", "max"):
            return E("builtin", type_, list(self.operands(type_, ctx, False)), op)
        if op in ("<<", ">>"):
            a = self.expression(type_, ctx.deeper())
            return E("bin", type_, [a, lit(UINT, self.random.randint(0, 31))], op)
        if op in ("/", "%"):
            a = self.expression(type_, ctx.deeper())
            by = self.random.randint(1, 17)
            return E("bin", type_, [a, lit(UINT, by)], op, (0, by - 1) if op == "%" else None)
        a, b = self.operands(type_, ctx)
        return E("bin", type_, [a, b], op)

    def bool_op(self, type_: Type, ctx: Context) -> E | None:
        if type_.is_vector() and not ctx.constant and self.random.random() < 0.4:
            decisions = [E("logic", BOOL, [self.rare(), self.rare()], self.random.choice(["&&", "||"]))
                         for _ in range(type_.rows)]
            return E("ctor", type_, decisions)
        if type_.is_vector():
            base = self.random.choice(["int", "float"] + (["uint"] if self.dialect.integers else []))
            a, b = self.operands(Type(base, type_.rows), ctx, False)
            return E("builtin", type_, [a, b], self.random.choice(["lessThan", "greaterThanEqual", "equal", "notEqual"]))
        r = self.random.random()
        if r < 0.4:
            base = self.random.choice([INT, INT, FLOAT] + ([UINT] if self.dialect.integers else []) +
                                      ([DOUBLE] if self.dialect.doubles else []) + self.wides())
            a, b = self.operands(base, ctx)
            return E("bin", BOOL, [a, b], self.random.choice(["<", ">", "<=", ">=", "==", "!="]))
        if r < 0.7:
            a, b = self.expression(BOOL, ctx.deeper()), self.expression(BOOL, ctx.deeper())
            op = self.random.choice(["&&", "||", "^^"])
            if op == "^^":
                b = self.expression(BOOL, ctx.deeper().beside(a))
            return E("logic", BOOL, [a, b], op)
        if r < 0.8:
            return E("un", BOOL, [self.expression(BOOL, ctx.deeper())], "!")
        if r < 0.9:
            v = self.expression(vec("bool", self.random.randint(2, 4)), ctx.deeper())
            return E("builtin", BOOL, [v], self.random.choice(["any", "all"]))
        wanted = [v.type for v in self.variables(ctx) if not v.type.is_scalar()
                  and (self.dialect.array_values or not v.type.dims and not v.type.struct)]
        if not wanted:
            return None
        a, b = self.operands(self.random.choice(wanted), ctx, False)
        return E("bin", BOOL, [a, b], self.random.choice(["==", "!="]))

    def float_op(self, type_: Type, ctx: Context) -> E | None:
        s = type_.scalar()
        op = self.random.choice(["+", "-", "*", "*", "/", "min", "max", "floor", "abs", "clamp", "mix", "dot", "matrix",
                                 "conv", "implicit", "step", "sign"])
        if op == "conv":
            if not type_.is_scalar():
                return None
            return self.convert(self.expression(self.random.choice([INT, BOOL] + (
                [FLOAT] if s == DOUBLE else [DOUBLE] if self.dialect.doubles else [])), ctx.deeper()), s)
        if op == "implicit":
            if not self.dialect.implicit or ctx.constant:
                return None
            a = self.expression(type_, ctx.deeper())
            b = self.expression(INT, ctx.deeper().beside(a))
            if b.range is None or not within(b.range, (-1024, 1024)):
                return None
            b = E("implicit", s, [b], range_=(float(b.range[0]), float(b.range[1])))
            args, op = ([a, b], self.random.choice("+-"))
        elif op in ("floor", "abs", "sign"):
            a = self.expression(type_, ctx.deeper())
            if op == "floor":
                return E("builtin", type_, [a], op, (math_floor(a.range[0]), a.range[1]), 0)
            if op == "sign":
                return E("builtin", type_, [a], op, (-1.0, 1.0), 0)
            return E("builtin", type_, [a], op, (0.0, max(abs(a.range[0]), abs(a.range[1]))), a.frac)
        elif op == "clamp":
            a = self.expression(type_, ctx.deeper())
            return E("builtin", type_, [a, lit(s, -4.0), lit(s, 7.5)], op, (-4.0, 7.5), max(a.frac, 1))
        elif op == "mix":
            if type_.base == "double":
                return None
            a, b = self.operands(type_, ctx, False)
            r = (2 * min(a.range[0], b.range[0], 0), 2 * max(a.range[1], b.range[1], 0))
            return E("builtin", type_, [a, b, lit(s, self.random.choice([0.0, 0.25, 0.5, 1.0]))], op, r,
                     max(a.frac, b.frac) + 2)
        elif op == "step":
            a, b = self.operands(type_, ctx, False)
            return E("builtin", type_, [a, b], op, (0.0, 1.0), 0)
        elif op == "dot":
            if not type_.is_scalar():
                return None
            n = self.random.randint(2, 4)
            a, b = self.operands(Type(s.base, n), ctx, False)
            r = (-n * product_bound(a, b), n * product_bound(a, b))
            frac = a.frac + b.frac
            return E("builtin", type_, [a, b], op, r, frac) if fits(r, frac) else None
        elif op == "matrix":
            if not type_.is_vector():
                return None
            cols = self.random.randint(2, 4) if self.dialect.array_values else type_.rows
            m = self.expression(Type(s.base, type_.rows, cols), ctx.deeper())
            v = self.expression(Type(s.base, cols), ctx.deeper().beside(m))
            r = (-cols * product_bound(m, v), cols * product_bound(m, v))
            return E("bin", type_, [m, v], "*", r, m.frac + v.frac) if fits(r, m.frac + v.frac) else None
        elif op == "/":
            a = self.expression(type_, ctx.deeper())
            e = self.random.choice([1, 2])
            r = (a.range[0] / 2 ** e, a.range[1] / 2 ** e)
            return E("bin", type_, [a, lit(s, 2.0 ** e)], "/", r, a.frac + e)
        else:
            args = list(self.operands(type_, ctx, op not in ("min", "max")))
        a, b = args
        if op in ("min", "max"):
            return E("builtin", type_, [a, b], op, union(a.range, b.range), max(a.frac, b.frac))
        if op == "*":
            r, frac = products(a, b), a.frac + b.frac
        else:
            r = ((a.range[0] + b.range[0], a.range[1] + b.range[1]) if op == "+" else
                 (a.range[0] - b.range[1], a.range[1] - b.range[0]))
            frac = max(a.frac, b.frac)
        return E("bin", type_, [a, b], op, r, frac) if fits(r, frac) else None

    def matrix(self, type_: Type, ctx: Context) -> E | None:
        op = self.random.choice(["ctor", "ctor", "+", "-", "*", "scale", "comp", "transpose", "diagonal"])
        if op == "ctor":
            return self.composed(type_, ctx)
        if op == "diagonal":
            a = self.expression(type_.scalar(), ctx.deeper())
            return E("ctor", type_, [a], range_=union(a.range, (0.0, 0.0)), frac=a.frac)
        if op == "transpose":
            if not self.dialect.array_values:
                return None
            a = self.expression(Type(type_.base, type_.cols, type_.rows), ctx.deeper())
            return E("builtin", type_, [a], op, a.range, a.frac)
        if op == "scale":
            a = self.expression(type_, ctx.deeper())
            by = lit(type_.scalar(), self.random.choice([0.5, 2.0, 0.25]))
            r = (a.range[0] * by.data, a.range[1] * by.data)
            return E("bin", type_, [a, by], "*", r, a.frac + by.frac) if fits(r, a.frac + by.frac) else None
        if op == "*":
            inner = self.random.randint(2, 4) if self.dialect.array_values else type_.cols
            a = self.expression(Type(type_.base, type_.rows, inner), ctx.deeper())
            b = self.expression(Type(type_.base, inner, type_.cols), ctx.deeper().beside(a))
            r = (-inner * product_bound(a, b), inner * product_bound(a, b))
            return E("bin", type_, [a, b], "*", r, a.frac + b.frac) if fits(r, a.frac + b.frac) else None
        a = self.expression(type_, ctx.deeper())
        b = self.expression(type_, ctx.deeper().beside(a))
        if op == "comp":
            r, frac = (-product_bound(a, b), product_bound(a, b)), a.frac + b.frac
            return E("builtin", type_, [a, b], "matrixCompMult", r, frac) if fits(r, frac) else None
        r = ((a.range[0] + b.range[0], a.range[1] + b.range[1]) if op == "+" else
             (a.range[0] - b.range[1], a.range[1] - b.range[0]))
        frac = max(a.frac, b.frac)
        return E("bin", type_, [a, b], op, r, frac) if fits(r, frac) else None
