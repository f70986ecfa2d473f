"""Evaluates expressions and finds the places that they mean, for one pixel."""

from __future__ import annotations

from arithmetic import Undefined, binary, builtin, convert, exact, wrap
from tree import E, Function, Program, Type, Variable


SIDE = 4  # texels of a texture, each way


def texel(base: str, x: int, y: int) -> list:
    """What textures hold, as draw.cpp fills them."""
    values = [7 * x + 13 * y + 3 * c - 20 for c in range(4)]
    return values if base == "int" else [v / 4 for v in values]


class Evaluator:
    """Needs of its owner: call(), and a pixel's state."""

    program: Program
    env: dict[Variable, list]
    coord: list
    memory: dict[Variable, list]
    picture: list[int]
    counted: int
    expressions: dict

    def call(self, function: Function, args: list) -> list | None:
        raise NotImplementedError

    def eval(self, e: E) -> list:
        value = self.expressions[e.kind](e)
        return value

    def place(self, e: E) -> tuple[list, list[int]]:
        """Storage and the offsets of the components that a place means."""
        if e.kind == "var":
            store = self.env.get(e.data)
            if store is None:
                store = self.env[e.data] = [None] * e.type.words()
            return store, list(range(len(store)))
        if not e.args:
            raise Undefined("a value is no place")  # what the reducer may try
        store, at = self.place(e.args[0])
        t = e.args[0].type
        if e.kind == "index":
            i = self.eval(e.args[1])[0]
            if not 0 <= i < t.length():
                raise Undefined("index")
            n = t.element().words()
            return store, at[i * n:(i + 1) * n]
        if e.kind == "member":
            first, n = member_at(t, e.data)
            return store, at[first:first + n]
        return store, [at[i] for i in swizzled(e.data)]

    def e_lit(self, e: E) -> list:
        return [e.data]

    def e_var(self, e: E) -> list:
        if e.data.storage == "builtin":
            return self.place_on_target if e.data.name == "corner" else self.coord
        value = self.env.get(e.data)
        if value is None:
            raise Undefined("uninitialised")
        if None in value:
            # The parts of it that are read count; whole reads of such a value are not for comparison.
            return value
        return list(value)

    def e_implicit(self, e: E) -> list:
        return [exact(float(v), e.type.base) for v in self.defined(self.eval(e.args[0]))]

    def defined(self, value: list) -> list:
        if None in value:
            raise Undefined("uninitialised")
        return value

    def e_index(self, e: E) -> list:
        value, i, n = self.eval(e.args[0]), self.defined(self.eval(e.args[1]))[0], e.type.words()
        if not 0 <= i < e.args[0].type.length():
            raise Undefined("index")
        return value[i * n:(i + 1) * n]

    def e_member(self, e: E) -> list:
        first, n = member_at(e.args[0].type, e.data)
        return self.eval(e.args[0])[first:first + n]

    def e_swizzle(self, e: E) -> list:
        value = self.eval(e.args[0])
        return [value[i] for i in swizzled(e.data)]

    def e_length(self, e: E) -> list:
        return [e.args[0].type.dims[0]]

    def e_un(self, e: E) -> list:
        value = self.defined(self.eval(e.args[0]))
        base = e.type.base
        if e.data == "!":
            return [not v for v in value]
        return [wrap(~v if e.data == "~" else -v, base) for v in value]

    def e_incdec(self, e: E) -> list:
        op, prefix = e.data
        store, at = self.place(e.args[0])
        old = self.defined([store[i] for i in at])
        new = [wrap(v + (1 if op == "++" else -1), e.type.base) for v in old]
        for i, v in zip(at, new):
            store[i] = v
        return new if prefix else old

    def e_bin(self, e: E) -> list:
        a, b = self.defined(self.eval(e.args[0])), self.defined(self.eval(e.args[1]))
        return self.binary(e.data, a, b, e)

    def binary(self, op: str, a: list, b: list, e: E) -> list:
        wraps = self.program.version >= (300 if self.program.es else 130)
        return binary(op, a, b, e.args[0].type, e.args[1].type, e.type, None if wraps else 2 ** 24)

    def e_logic(self, e: E) -> list:
        a = self.defined(self.eval(e.args[0]))[0]
        if e.data == "&&" and not a or e.data == "||" and a:
            return [a]
        b = self.defined(self.eval(e.args[1]))[0]
        return [a != b if e.data == "^^" else b]

    def e_cond(self, e: E) -> list:
        return self.eval(e.args[1] if self.defined(self.eval(e.args[0]))[0] else e.args[2])

    def e_comma(self, e: E) -> list:
        self.eval(e.args[0])
        return self.eval(e.args[1])

    def e_assign(self, e: E) -> list:
        store, at = self.place(e.args[0])
        value = self.defined(list(self.eval(e.args[1])))
        if e.data != "=":
            old = self.defined([store[i] for i in at])
            value = self.binary(e.data[:-1], old, value, e)
        for i, v in zip(at, value):
            store[i] = v
        return [store[i] for i in at]

    def e_call(self, e: E) -> list | None:
        function = e.data.picked or e.data
        args, back = [], []
        for i, (p, arg) in enumerate(zip(function.params, e.args)):
            if function.out(i):
                place = self.place(arg)
                back.append((p, *place))
                old = [place[0][k] for k in place[1]]
                args.append(self.defined(old) if p.qualifier == "inout" else None)
            else:
                args.append(self.defined(list(self.eval(arg))))
        result = self.call(function, args)
        for p, store, at in back:
            value = self.defined(self.env[p])
            for i, v in zip(at, value):
                store[i] = v
        return list(result) if result is not None else None

    def e_ctor(self, e: E) -> list:
        t = e.type
        if t.dims or t.struct:
            return [v for arg in e.args for v in self.defined(self.eval(arg))]
        values = [(v, arg.type.base) for arg in e.args for v in self.defined(list(self.eval(arg)))]
        converted = [convert(v, base, t.base) for v, base in values]
        if len(converted) == 1 and t.is_matrix():
            return [converted[0] if c == r else 0.0 for c in range(t.cols) for r in range(t.rows)]
        if len(converted) == 1:
            return converted * t.words()
        return converted[:t.words()]

    def e_fetch(self, e: E) -> list:
        x, y = (self.defined(self.eval(arg))[0] for arg in e.args)
        if not (0 <= x < SIDE and 0 <= y < SIDE):
            raise Undefined("texel")
        return texel(e.type.base, x, y)

    def e_memory(self, e: E) -> list:
        op, v = e.data
        if op == "increment":
            self.counted += 1
            return [0]
        value = self.defined(self.eval(e.args[1]))[0]
        if op == "store":
            self.picture[self.eval(e.args[0])[0]] = value
            return []
        store = self.memory[v]
        old = store[0]
        store[0] = wrap(old + value if op == "atomicAdd" else max(old, value) if op == "atomicMax" else old ^ value, "int")
        return [old]

    def e_builtin(self, e: E) -> list:
        args = [self.defined(list(self.eval(arg))) for arg in e.args]
        base, op = e.args[0].type.base, e.data
        if op in ("any", "all"):
            return [any(args[0]) if op == "any" else all(args[0])]
        if op == "dot":
            total = 0.0
            for x, y in zip(*args):
                total = exact(total + exact(x * y, base), base)
            return [total]
        if op == "transpose":
            t = e.args[0].type
            return [args[0][c * t.rows + r] for r in range(t.rows) for c in range(t.cols)]
        n = max(len(a) for a in args)
        if op == "bitfieldExtract":
            offset, bits = args[1][0], args[2][0]
            field_ = [(v >> offset) & ((1 << bits) - 1) for v in args[0]]
            return [v - (1 << bits) if base == "int" and v >> (bits - 1) else v for v in field_]
        args = [a * n if len(a) == 1 else a for a in args]
        return [builtin(op, base, *values) for values in zip(*args)]


def member_at(t: Type, name: str) -> tuple[int, int]:
    first = 0
    for member, type_ in t.struct.members:
        if member == name:
            return first, type_.words()
        first += type_.words()
    raise KeyError(name)


def swizzled(names: str) -> list[int]:
    return ["xrs".find(c) >= 0 and 0 or "ygt".find(c) >= 0 and 1 or "zbp".find(c) >= 0 and 2 or "waq".find(c) >= 0 and 3
            or 0 for c in names]
