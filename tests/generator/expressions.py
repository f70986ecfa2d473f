"""Random expressions of a wanted type, without undefined behaviour and with exact results.

Integers wrap where GLSL says that they do (1.30 and later) and keep to a small range elsewhere. Floats are multiples of
powers of two small enough that no operation rounds: contraction and reordering cannot change a bit of them.
Operands whose order of evaluation GLSL leaves open never touch what another one changes.
"""

from __future__ import annotations

import random
from dataclasses import replace

from dialect import Dialect
from operands import MANY, OPAQUE, REST, WIDE, Context, fits, lit, math_floor, union, var, within
from operators import Operators
from tree import BOOL, E, FLOAT, INT, Function, Struct, Type, Variable


class Expressions(Operators):
    """Needs of its owner: self.random, self.dialect, self.scopes, self.functions, self.structs, self.program."""

    random: random.Random
    dialect: Dialect
    functions: list[Function]
    structs: list[Struct]
    lim: Function | None
    low: Function | None

    # ---- what is there ------------------------------------------------------------------------------------------

    def visible(self) -> dict[str, Variable | Function]:
        raise NotImplementedError

    def is_value(self, type_: Type) -> bool:
        raise NotImplementedError

    def variables(self, ctx: Context) -> list[Variable]:
        if ctx.constant:
            return []
        return [v for v in self.visible().values() if isinstance(v, Variable) and v not in ctx.no_read and v.ready
                and v.storage not in OPAQUE]

    def reaches(self, type_: Type, wanted: Type) -> bool:
        """Can an access path lead from a value of the one type to the other?"""
        if type_ == wanted:
            return True
        if type_.dims or type_.is_matrix():
            return self.reaches(type_.element(), wanted)
        if type_.struct:
            return any(self.reaches(member, wanted) for _, member in type_.struct.members)
        return type_.is_vector() and type_.base == wanted.base and wanted.rows <= 4 and not wanted.is_matrix() and \
            not wanted.dims and (wanted.rows <= type_.rows)

    def walk_to(self, e: E, wanted: Type, ctx: Context, to_write: bool = False) -> E | None:
        """A random access path from e to a value of the wanted type. With to_write, no component comes twice."""
        while e.type != wanted:
            t = e.type
            if t.dims or t.is_matrix() or (t.is_vector() and wanted.is_scalar() and self.random.random() < 0.3):
                root = next(self.root(e)) if e.kind == "var" else None
                if root is not None and root.storage in ("out", "builtin-out") and self.dialect.es:
                    i = lit(INT, self.random.randrange(t.length()))  # glslang refuses more
                else:
                    i = self.index(t.length(), ctx.beside(e) if e.reads or e.writes else ctx)
                e = E("index", t.element(), [e, i], range_=e.range, frac=e.frac)
            elif t.struct:
                ways = [(name, member) for name, member in t.struct.members if self.reaches(member, wanted)]
                if not ways:
                    return None
                name, member = self.random.choice(ways)
                frac = 2 if member.base in ("float", "double") else 0
                e = E("member", member, [e], data=name, range_=self.rest(member), frac=frac)
            elif t.is_vector() and t.base == wanted.base:
                names = self.random.choice(["xyzw", "rgba", "stpq"])[:t.rows]
                picked = (self.random.sample(names, wanted.rows) if to_write
                          else [self.random.choice(names) for _ in range(wanted.rows)])
                e = E("swizzle", wanted, [e], data="".join(picked), range_=e.range, frac=e.frac)
            else:
                return None
        return e

    def rest(self, type_: Type):
        """The range that members of structures keep to."""
        if type_.base in ("float", "double"):
            return REST
        if type_.base == "int":
            return None if self.dialect.integers else MANY
        return None

    def index(self, n: int, ctx: Context) -> E:
        """An integer in [0, n)."""
        choices = [lambda: lit(INT, self.random.randrange(n))]
        counters = [v for v in self.variables(ctx) if v.type == INT and within(v.range, (0, n - 1))]
        if counters:
            choices += [lambda: var(self.random.choice(counters))] * 3
        if ctx.depth > 0 and not ctx.constant:
            if self.dialect.integers and n & (n - 1) == 0:
                def masked():
                    e = E("bin", INT, [self.int_(ctx.deeper()), lit(INT, n - 1)], "&", (0, n - 1))
                    return e
                choices.append(masked)
            if self.dialect.integers:
                choices.append(lambda: E("builtin", INT, [self.int_(ctx.deeper()), lit(INT, 0), lit(INT, n - 1)],
                                         "clamp", (0, n - 1)))
            calls = self.callable(INT, ctx, (0, n - 1))
            if calls:
                choices += [lambda: self.call(self.random.choice(calls), ctx.deeper())] * 2
            elif self.low and self.usable(self.low, ctx):
                choices.append(lambda: self.bounded(self.int_(ctx.deeper()), n - 1))
        return self.random.choice(choices)() or lit(INT, self.random.randrange(n))

    def bounded(self, e: E, top: int) -> E:
        call = E("call", INT, [e, lit(INT, top)], self.low, (0, top))
        return call

    # ---- calls --------------------------------------------------------------------------------------------------

    def usable(self, function: Function, ctx: Context) -> bool:
        if ctx.constant or (ctx.pure and (function.writes or function.discards)):
            return False
        if isinstance(self.visible().get(function.name), Variable):
            return False
        return not (function.reads & ctx.no_read) and not (function.writes & (ctx.no_write | ctx.no_read))

    def callable(self, type_: Type, ctx: Context, range_=None) -> list[Function]:
        found = [f for f in self.functions if f.type == type_ and self.usable(f, ctx)
                 and f is not self.lim and f is not self.low]
        if ctx.pure:
            found = [f for f in found if not any(f.out(i) for i in range(len(f.params)))]
        if range_ is not None:
            found = [f for f in found if within(f.range, range_)]
        return found

    def call(self, function: Function, ctx: Context) -> E | None:
        """None if an out parameter finds no variable."""
        args: list[E] = []
        written: frozenset = frozenset()  # by copying out, behind all arguments
        for i, param in enumerate(function.params):
            beside = ctx.beside(*args)
            beside = replace(beside, no_read=beside.no_read | function.writes,
                             no_write=beside.no_write | function.reads | function.writes)
            if function.out(i):
                target = self.lvalue(param.type, replace(beside, no_write=beside.no_write | written), param.range)
                if target is None:
                    return None
                root = next(v for v in self.root(target))
                written |= {root}
                if param.qualifier == "out":
                    pass
                args.append(target)
            else:
                args.append(self.settled(param.type, beside, param.range))
        # An argument that an earlier one writes through its index cannot be told apart here: beside() saw to it.
        e = E("call", function.type, args, function, function.range,
              2 if function.type.base in ("float", "double") else 0)
        e.reads |= function.reads
        e.writes |= function.writes | written
        if e.writes & ctx.no_write or written & ctx.no_read:
            return None
        return e

    def root(self, e: E):
        while e.kind != "var":
            e = e.args[0]
        yield e.data

    # ---- places to write to -------------------------------------------------------------------------------------

    def lvalue(self, type_: Type, ctx: Context, range_=None) -> E | None:
        """A place whose variable keeps to the same range as what is written."""
        if ctx.pure or ctx.constant:
            return None
        wanted = range_ if type_.base != "bool" else None
        found = [v for v in self.visible().values()
                 if isinstance(v, Variable) and v.writable and v.ready and v not in ctx.no_write and v not in ctx.no_read
                 and v.storage not in OPAQUE and self.reaches(v.type, type_)]
        self.random.shuffle(found)
        for v in found:
            e = self.walk_to(var(v), type_, replace(ctx.deeper(), no_read=ctx.no_read | {v},
                                                    no_write=ctx.no_write | {v}), True)
            if e is not None and (wanted == "any" or e.range == wanted or type_.base == "bool" or type_.struct):
                return e
        return None

    # ---- keeping to ranges --------------------------------------------------------------------------------------

    def settled(self, type_: Type, ctx: Context, range_, tries: int = 4) -> E:
        """An expression whose value keeps to the range."""
        for _ in range(tries):
            e = self.expression(type_, ctx)
            settled = self.settle(e, range_, ctx)
            if settled is not None:
                return settled
        return self.simple(type_, range_)

    def settle(self, e: E, range_, ctx: Context) -> E | None:
        base = e.type.base
        if e.type.dims or e.type.struct or base == "bool":
            return e if e.type.dims == () or e.type.struct or base == "bool" or self.keeps(e, range_) else None
        if base in ("float", "double"):
            if within(e.range, range_) and e.frac <= 2:
                return e
            if e.type.is_matrix():
                return None
            s = e.type.scalar()
            if e.frac > 2:
                if not fits(e.range, e.frac + 2):
                    return None
                four = E("bin", e.type, [e, lit(s, 4.0)], "*", (e.range[0] * 4, e.range[1] * 4), e.frac)
                floor = E("builtin", e.type, [four], "floor", (math_floor(four.range[0]), four.range[1]), 0)
                e = E("bin", e.type, [floor, lit(s, 0.25)], "*", (floor.range[0] / 4, floor.range[1] / 4), 2)
            if not within(e.range, range_):
                e = E("builtin", e.type, [e, lit(s, range_[0]), lit(s, range_[1])], "clamp", range_, 2)
            return e
        if range_ is None or within(e.range, range_):
            return e
        if self.dialect.integers:
            s = e.type.scalar()
            return E("builtin", e.type, [e, lit(s, range_[0]), lit(s, range_[1])], "clamp", range_)
        if not e.type.is_scalar() or ctx.constant:
            return None
        if range_ == MANY and self.lim and e.range and within(e.range, (-WIDE, WIDE)) and self.usable(self.lim, ctx):
            return E("call", INT, [e], self.lim, MANY)
        if range_[0] == 0 and self.low and self.usable(self.low, ctx):
            return self.bounded(e, range_[1])
        return None

    def keeps(self, e: E, range_) -> bool:
        return e.range == range_ or within(e.range, range_)

    def simple(self, type_: Type, range_) -> E:
        """Literals in constructors."""
        if type_.is_scalar():
            return self.literal(type_, range_)
        if type_.dims:
            args = [self.simple(type_.element(), range_) for _ in range(type_.dims[0])]
        elif type_.struct:
            args = [self.simple(member, self.rest(member)) for _, member in type_.struct.members]
        else:
            args = [self.literal(type_.scalar(), range_) for _ in range(type_.words())]
        e = E("ctor", type_, args)
        e.range = None if type_.struct else union(*(a.range for a in args)) if type_.base != "bool" else None
        e.frac = max((a.frac for a in args), default=0)
        return e

    def literal(self, type_: Type, range_=None) -> E:
        base = type_.base
        if base == "bool":
            return lit(type_, self.random.random() < 0.5)
        if base.endswith("64"):
            wide = self.random.random() < 0.4
            value = self.random.randint(0, 2 ** 62) if wide else self.random.randint(0, 99)
            return lit(type_, -value if base == "int64" and self.random.random() < 0.4 else value)
        if base in ("float", "double"):
            low, high = range_ or (-8.0, 8.0)
            return lit(type_, max(low, min(high, self.random.randint(-32, 32) / self.random.choice([1, 2, 4]) +
                                           (low + high) / 2)))
        low, high = range_ or ((0, 40) if base == "uint" else (-9, 40))
        if range_ is None and self.dialect.integers and self.random.random() < 0.1:
            return lit(type_, self.random.choice([2147483647, 65535, 65536] + (
                [4294967295, 2147483648] if base == "uint" else [-2147483647])))
        return lit(type_, self.random.randint(max(low, -99), min(high, 99)))

    # ---- expressions --------------------------------------------------------------------------------------------

    def expression(self, type_: Type, ctx: Context) -> E:
        for _ in range(6):
            e = self.attempt(type_, ctx)
            if e is not None and not (e.writes & ctx.no_write) and not (e.reads & ctx.no_read) and \
                    not (e.writes & ctx.no_read) and not (ctx.pure and (e.writes or self.discarding(e))):
                return e
        return self.simple(type_, self.rest(type_) if not type_.struct else None)

    def discarding(self, e: E) -> bool:
        return any(one.kind == "call" and one.data.discards for one in e.walk())

    def attempt(self, type_: Type, ctx: Context) -> E | None:
        r = self.random.random()
        if ctx.depth <= 0 or ctx.constant and r < 0.5:
            return self.leaf(type_, ctx)
        if r < 0.25:
            return self.leaf(type_, ctx)
        if r < 0.40:
            calls = self.callable(type_, ctx)
            if calls:
                return self.call(self.random.choice(calls), ctx.deeper())
        if r < 0.46 and not type_.dims:
            return self.ternary(type_, ctx)
        if r < 0.49 and not ctx.constant and not type_.dims:
            first = self.effect(ctx.deeper())
            if first is not None:
                second = self.expression(type_, ctx.deeper())
                return E("comma", type_, [first, second], range_=second.range, frac=second.frac)
        if r < 0.53 and not ctx.pure and (self.dialect.array_values or not type_.dims):
            return self.assignment(type_, ctx.deeper())
        if type_.dims or type_.struct:
            return self.leaf(type_, ctx) if self.random.random() < 0.6 else self.composed(type_, ctx)
        if type_.is_matrix():
            return self.matrix(type_, ctx)
        if type_.is_vector() and self.random.random() < 0.35:
            return self.composed(type_, ctx)
        if type_.rows == 4 and type_.base in ("int", "float") and self.random.random() < 0.15:
            fetched = self.fetch(type_, ctx)
            if fetched is not None:
                return fetched
        return {"int": self.int_op, "uint": self.uint_op, "int64": self.wide_op, "uint64": self.wide_op, "bool": self.bool_op, "float": self.float_op,
                "double": self.float_op}[type_.base](type_, ctx)

    def fetch(self, type_: Type, ctx: Context) -> E | None:
        found = [v for v in self.visible().values() if isinstance(v, Variable) and v.storage == "texture" and v.type == type_]
        if not found or ctx.constant:
            return None
        x = self.index(4, ctx.deeper())
        y = self.index(4, ctx.deeper().beside(x))
        v = self.random.choice(found)
        return E("fetch", type_, [x, y], v, v.range, 2 if type_.base == "float" else 0)

    def int_(self, ctx: Context) -> E:
        return self.expression(INT, ctx)

    def leaf(self, type_: Type, ctx: Context) -> E | None:
        if self.random.random() < 0.8:
            found = [v for v in self.variables(ctx) if self.reaches(v.type, type_)]
            if found:
                return self.walk_to(var(self.random.choice(found)), type_, ctx.deeper())
            if type_ == FLOAT and not ctx.constant and self.random.random() < 0.7:
                return E("swizzle", FLOAT, [var(self.coord)], self.random.choice("xy"), (0.5, 31.5), 1)
        if type_.dims and not self.dialect.array_values:
            return None
        return self.simple(type_, self.rest(type_) if not type_.struct else None)

    def composed(self, type_: Type, ctx: Context) -> E | None:
        args: list[E] = []
        if type_.dims:
            if not self.dialect.array_values:
                return None
            for _ in range(type_.dims[0]):
                args.append(self.settled(type_.element(), ctx.deeper().beside(*args), self.rest(type_)))
        elif type_.struct:
            for _, member in type_.struct.members:
                args.append(self.settled(member, ctx.deeper().beside(*args), self.rest(member)))
        elif type_.is_matrix():
            column = Type(type_.base, type_.rows)
            for _ in range(type_.cols):
                args.append(self.expression(column, ctx.deeper().beside(*args)))
        else:
            left = type_.rows
            while left > 0:
                n = self.random.randint(1, left)
                if n == type_.rows:
                    n = 1
                source = self.random.choice([type_.base, type_.base, "int"]) if n == 1 else type_.base
                if source == "bool" or type_.base == "bool":
                    source = type_.base
                one = self.expression(Type(source, n), ctx.deeper().beside(*args))
                if source != type_.base:
                    one = self.convert(one, type_.scalar())
                    if one is None:
                        return None
                args.append(one)
                left -= n
        e = E("ctor", type_, args)
        if type_.base not in ("bool", "struct"):
            e.range = union(*(a.range for a in args))
            e.frac = max(a.frac for a in args)
        if type_.struct:
            e.range = None
        return e

    def convert(self, e: E, to: Type) -> E | None:
        """Constructor of a scalar from a scalar."""
        if e.type.base == to.base:
            return e
        if to.base in ("float", "double"):
            if e.type.base in ("float", "double"):
                return E("ctor", to, [e], range_=e.range, frac=e.frac)
            if e.type.base == "bool":
                return E("ctor", to, [e], range_=(0.0, 1.0))
            if e.range is None or not within(e.range, (-4096, 4096)):
                if not self.dialect.integers or e.range is not None and e.range[0] < 0 and e.type.base == "uint":
                    return None
                e = E("bin", e.type, [e, lit(e.type, 63)], "&", (0, 63))
            return E("ctor", to, [e], range_=(float(e.range[0]), float(e.range[1])))
        if to.base.endswith("64"):
            if e.type.base == "bool" or e.range is not None and e.range[0] >= 0 and e.type.base in ("int", "uint") or \
                    to.base == "int64" and e.type.base == "int":
                return E("ctor", to, [e])
            return None
        if e.type.base.endswith("64"):
            if to.base not in ("int", "uint"):
                return None
            few = E("bin", e.type, [e, lit(e.type, 0xfffff)], "&")
            return E("ctor", to, [few], range_=(0, 0xfffff))
        if to.base == "int":
            if e.type.base in ("float", "double"):
                return E("ctor", to, [e], range_=(int(e.range[0]) - 1, int(e.range[1]) + 1))
            if e.type.base == "bool":
                return E("ctor", to, [e], range_=(0, 1))
            known = e.range if e.range is not None and within(e.range, (0, WIDE)) else None
            return E("ctor", to, [e], range_=known)
        if to.base == "uint":
            if e.type.base in ("float", "double"):
                if e.range[0] < 0:
                    return None
                return E("ctor", to, [e], range_=(0, int(e.range[1]) + 1))
            if e.type.base == "bool":
                return E("ctor", to, [e], range_=(0, 1))
            known = e.range if e.range is not None and within(e.range, (0, WIDE)) else None
            return E("ctor", to, [e], range_=known)
        if to.base == "bool":
            return E("ctor", to, [e])
        return None

    def ternary(self, type_: Type, ctx: Context) -> E:
        c = self.bool_(ctx.deeper())
        a, b = self.expression(type_, ctx.deeper()), self.expression(type_, ctx.deeper())
        return E("cond", type_, [c, a, b], range_=union(a.range, b.range), frac=max(a.frac, b.frac))

    def bool_(self, ctx: Context) -> E:
        return self.expression(BOOL, ctx)

    def assignment(self, type_: Type, ctx: Context) -> E | None:
        """As an expression: =, an operator's assignment, ++ and --."""
        target = self.lvalue(type_, ctx, "any")
        if target is None:
            return None
        root = next(self.root(target))
        keep = root.range if not self.through_struct(target) else self.rest(type_)
        beside = ctx.beside(target)
        op, value = "=", None
        if type_.base in ("int", "uint") and self.dialect.integers and keep is None and not type_.dims:
            if type_.is_scalar() and self.random.random() < 0.35:
                e = E("incdec", type_, [target], (self.random.choice(["++", "--"]), self.random.random() < 0.5))
                e.writes |= {root}
                return e
            op = self.random.choice(["=", "=", "+=", "-=", "*=", "^=", "|=", "&="])
            value = self.expression(type_, beside)
        if value is None:
            value = self.settled(type_, beside, keep)
            if type_.dims and not self.keeps(value, keep) and type_.base != "bool":
                return None
        e = E("assign", type_, [target, value], op, keep if op == "=" else None, value.frac if op == "=" else 0)
        e.writes |= {root}
        return e

    def through_struct(self, e: E) -> bool:
        return any(one.type.struct and not one.type.dims for one in e.walk())

    def effect(self, ctx: Context) -> E | None:
        """Something worth doing for its side effects."""
        if ctx.pure or ctx.constant:
            return None
        r = self.random.random()
        if r < 0.3:
            calls = [f for f in self.functions if self.usable(f, ctx) and f not in (self.lim, self.low)]
            if calls:
                return self.call(self.random.choice(calls), ctx)
        types = [v.type for v in self.visible().values() if isinstance(v, Variable) and v.writable and v.ready
                 and v.storage not in OPAQUE and v not in ctx.no_write]
        if not types:
            return None
        wanted = self.random.choice(types)
        while not wanted.is_scalar() and self.random.random() < 0.6:
            wanted = (self.random.choice(wanted.struct.members)[1] if wanted.struct and not wanted.dims
                      else wanted.element())
        if not self.is_value(wanted):
            return None
        return self.assignment(wanted, ctx)
