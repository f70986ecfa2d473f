"""Runs a program for one pixel after another, by the rules of GLSL alone: the truth that the debugger must show.

Everything is exact: integers wrap at 32 bits, and a float operation whose result would have to be rounded ends the run
with Undefined, like everything else that GLSL leaves open (uninitialised reads, indices outside of bounds, ...).
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, field

from tree import BOOL, E, FLOAT, Function, Program, S, Type, Variable


class Undefined(Exception):
    """The program does what GLSL does not define, or would need rounding, or runs for too long."""


class Discarded(Exception):
    pass


class Returned(Exception):
    def __init__(self, value):
        self.value = value


class Broken(Exception):
    pass


class Continued(Exception):
    pass


@dataclass
class Step:
    kind: str
    at: S | Function
    function: str
    depth: int
    iteration: list[int]
    outcome: str | None = None
    returned: tuple | None = None  # type, value
    # name -> (variable, its value) of all that can be named behind the step
    values: dict = field(default_factory=dict)
    hidden: dict = field(default_factory=dict)  # globals that cannot be named there -> value


@dataclass
class Pixel:
    steps: list[Step]
    discarded: bool
    outputs: dict  # Variable -> value
    loops: dict  # loop statement -> list of iterations, one per time that it was entered


def wrap(value: int, base: str) -> int:
    value &= 0xffffffff
    return value - 0x100000000 if base == "int" and value >= 0x80000000 else value


def exact(value: float, base: str) -> float:
    if base == "float" and struct.unpack("f", struct.pack("f", value))[0] != value:
        raise Undefined("rounding")
    return value + 0.0 if value == 0 else value


class Interpreter:
    MOST_STEPS = 1200

    def __init__(self, program: Program):
        self.program = program
        self.main = program.functions[-1]
        self.memory = {v: [0] * v.type.words() for v in program.globals if v.storage == "buffer"}
        self.picture = [0] * (program.width * program.height)
        self.counted = 0
        self.watched = self.watched_after = None  # statements: what is visible there, the last time, to at_watched
        self.expressions = {name[2:]: getattr(self, name) for name in dir(self) if name.startswith("e_")}
        self.statements = {name[2:]: getattr(self, name) for name in dir(self) if name.startswith("s_")}

    # ---- the run of a pixel -------------------------------------------------------------------------------------

    def run(self, x: int, y: int, record: bool) -> Pixel:
        self.env: dict[Variable, list] = dict(self.memory)
        self.coord = [x + 0.5, y + 0.5, None, None]
        self.steps: list[Step] = []
        self.record = False  # not what initializes globals
        self.count = 0
        self.frames: list[tuple[Function, list[int]]] = []
        self.loop_counts: dict[S, list[int]] = {}
        discarded = False
        for v in self.program.globals:
            if v.storage in ("uniform", "constant", "global"):
                self.env[v] = list(v.value) if v.value is not None else None
        for v in self.program.globals:
            if v.storage in ("constant", "global"):
                self.env[v] = list(self.eval(v.initializer)) if v.initializer is not None else [None] * v.type.words()
            elif v.storage == "out":
                self.env[v] = [None] * v.type.words()
        self.record, self.count, self.loop_counts = record, 0, {}
        self.initial = {v: list(value) for v, value in self.env.items() if value is not None}
        self.at_watched: dict | None = None
        try:
            self.call(self.main, [])
        except Discarded:
            discarded = True
        outputs = {v: value for v, value in self.env.items() if v.storage in ("out", "builtin-out")}
        return Pixel(self.steps, discarded, outputs, self.loop_counts)

    def step(self, kind: str, at, visible: dict, outcome=None, returned=None, iteration: int | None = None) -> None:
        self.count += 1
        if self.count > self.MOST_STEPS:
            raise Undefined("too many steps")
        if not self.record:
            return
        iterations = [max(i, 0) for _, loops in self.frames for i in loops]
        self.steps.append(Step(kind, at, self.frames[-1][0].name, len(self.frames) - 1, iterations, outcome, returned,
                               self.snapshot(visible), self.out_of_sight(visible)))

    def out_of_sight(self, visible: dict) -> dict:
        return {v: list(self.env[v]) for v in self.initial if self.env[v] is not None and visible and visible.get(v.name) is not v}

    def snapshot(self, visible: dict) -> dict:
        values = {name: (v, list(self.env[v])) for name, v in visible.items()
                  if self.env.get(v) is not None and v.storage not in ("uniform", "constant", "buffer")}
        # Of memory, a statement shows the place that it writes: the thread's own cell.
        place = values.get("pix", (None, [None]))[1][0]
        for v, cells in self.memory.items():
            if v.type.dims and place is not None and visible.get(v.name) is v and 0 <= place < len(cells):
                values[f"{v.name}[pix]"] = (Variable(f"{v.name}[pix]", v.type.element(), "buffer"), [cells[place]])
        return values

    def call(self, function: Function, args: list) -> list | None:
        for p, value in zip(function.params, args):
            self.env[p] = list(value) if value is not None else [None] * p.type.words()
        self.frames.append((function, []))
        main = function is self.main
        if not main:
            self.step("enter", function, function.visible)
        result = None
        try:
            self.block(function.body)
            if function.type.base != "void":
                raise Undefined("no return value")
            last = function.body[-1].kind if function.body else ""
            if not main and last not in ("return", "break", "continue", "discard"):
                self.step("leave", function, function.visible)
        except Returned as returned:
            result = returned.value
        self.frames.pop()
        return result

    # ---- statements ---------------------------------------------------------------------------------------------

    def block(self, body: list[S]) -> None:
        for s in body:
            self.one(s)

    def one(self, s: S) -> None:
        if s is self.watched:
            self.at_watched = self.snapshot(s.visible)
        self.statements[s.kind](s)
        if s is self.watched_after:
            self.at_watched = self.snapshot(s.visible_after)

    def announce(self, s: S) -> None:
        if s.calls():
            self.step("call", s, {})

    def s_expr(self, s: S) -> None:
        self.announce(s)
        self.eval(s.exprs[0])
        self.step("statement", s, s.visible_after)

    def s_empty(self, s: S) -> None:
        self.step("statement", s, s.visible_after)

    def s_case(self, s: S) -> None:
        pass

    def declare(self, s: S) -> None:
        for (v, _), e in zip(s.data, s.exprs):
            self.env[v] = list(self.eval(e)) if e is not None else [None] * v.type.words()

    def s_decl(self, s: S) -> None:
        self.announce(s)
        self.declare(s)
        self.step("statement", s, s.visible_after)

    def s_block(self, s: S) -> None:
        self.block(s.body)

    def s_if(self, s: S) -> None:
        self.announce(s)
        taken = self.eval(s.exprs[0])[0]
        self.step("condition", s, s.visible_after, str(taken).lower())
        if taken:
            self.one(s.body[0])
        elif len(s.body) > 1:
            self.one(s.body[1])

    def s_switch(self, s: S) -> None:
        self.announce(s)
        value = self.eval(s.exprs[0])[0]
        self.step("condition", s, s.visible_after, str(value))
        for one in s.body:
            for v in declared(one):
                self.env[v] = [None] * v.type.words()
        labels = [one.data for one in s.body if one.kind == "case"]
        start = value if value in labels else None
        if start is None and None not in labels:
            return
        at = next(i for i, one in enumerate(s.body) if one.kind == "case" and one.data == start)
        try:
            self.block(s.body[at:])
        except Broken:
            pass

    def loop(self, s: S, body: S) -> bool:
        """False if the loop is left."""
        loops = self.frames[-1][1]
        depth = len(loops)
        self.loop_counts[s][-1] += 1
        try:
            self.one(body)
        except Continued:
            pass
        except Broken:
            return False
        finally:
            del loops[depth:]
        return True

    def s_for(self, s: S) -> None:
        loops = self.frames[-1][1]
        self.loop_counts.setdefault(s, []).append(0)
        loops.append(0)
        try:
            init = s.body[0]
            if init.kind == "decl":
                self.declare(init)
            elif init.kind == "expr":
                self.eval(init.exprs[0])
            while True:
                going = self.eval(s.exprs[0])[0] if s.exprs[0] is not None else True
                self.step("condition", s, s.visible_after, str(going).lower())
                if not going or not self.loop(s, s.body[1]):
                    return
                if s.exprs[1] is not None:
                    self.eval(s.exprs[1])
                loops[-1] += 1
        finally:
            loops.pop()

    def s_while(self, s: S) -> None:
        loops = self.frames[-1][1]
        self.loop_counts.setdefault(s, []).append(0)
        loops.append(0)
        try:
            while True:
                going = self.eval(s.exprs[0])[0]
                if s.data:
                    self.env[s.data] = [going]
                self.step("condition", s, s.visible_after, str(going).lower())
                if not going or not self.loop(s, s.body[0]):
                    return
                loops[-1] += 1
        finally:
            loops.pop()

    def s_do(self, s: S) -> None:
        loops = self.frames[-1][1]
        self.loop_counts.setdefault(s, []).append(0)
        loops.append(0)
        try:
            while True:
                if not self.loop(s, s.body[0]):
                    return
                going = self.eval(s.exprs[0])[0]
                self.step("condition", s, s.visible_after, str(going).lower())
                if not going:
                    return
                loops[-1] += 1
        finally:
            loops.pop()

    def s_return(self, s: S) -> None:
        self.announce(s)
        value = self.eval(s.exprs[0]) if s.exprs else None
        self.step("return", s, s.visible_after, returned=(s.exprs[0].type, value) if s.exprs else None)
        raise Returned(value)

    def s_discard(self, s: S) -> None:
        self.step("jump", s, s.visible_after)
        raise Discarded()

    def s_break(self, s: S) -> None:
        self.step("jump", s, s.visible_after)
        raise Broken()

    def s_continue(self, s: S) -> None:
        self.step("jump", s, s.visible_after)
        raise Continued()

    # ---- expressions --------------------------------------------------------------------------------------------

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
        if e.data.name == "gl_FragCoord":
            return self.coord
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
        return self.binary(e.data, a, b, e.args[0].type, e.args[1].type, e.type)

    def binary(self, op: str, a: list, b: list, ta: Type, tb: Type, t: Type) -> list:
        if op in ("==", "!="):
            return [(a == b) == (op == "==")]
        if op == "*" and (ta.is_matrix() or tb.is_matrix()) and not (ta.is_scalar() or tb.is_scalar()):
            return self.product(a, b, ta, tb, t)
        n = max(len(a), len(b))
        a, b = (a * n if len(a) == 1 else a), (b * n if len(b) == 1 else b)
        return [self.scalar(op, x, y, ta.base) for x, y in zip(a, b)]

    def product(self, a: list, b: list, ta: Type, tb: Type, t: Type) -> list:
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

    def scalar(self, op: str, x, y, base: str):
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
        if op in ("<<", ">>") and not 0 <= y < 32:
            raise Undefined("shift")
        value = {"+": lambda: x + y, "-": lambda: x - y, "*": lambda: x * y, "&": lambda: x & y, "|": lambda: x | y,
                 "^": lambda: x ^ y, "<<": lambda: x << y, ">>": lambda: x >> y}[op]()
        if self.program.version < 130 and not self.program.es or self.program.es and self.program.version < 300:
            if abs(value) > 2 ** 24:
                raise Undefined("overflow")
        return wrap(value, base)

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
            value = self.binary(e.data[:-1], old, value, e.args[0].type, e.args[1].type, e.type)
        for i, v in zip(at, value):
            store[i] = v
        return [store[i] for i in at]

    def e_call(self, e: E) -> list | None:
        function = e.data
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
        converted = [self.convert(v, base, t.base) for v, base in values]
        if len(converted) == 1 and t.is_matrix():
            return [converted[0] if c == r else 0.0 for c in range(t.cols) for r in range(t.rows)]
        if len(converted) == 1:
            return converted * t.words()
        return converted[:t.words()]

    def convert(self, v, base: str, to: str):
        if to in ("float", "double"):
            return exact(float(v), to)
        if to == "bool":
            return bool(v)
        if base in ("float", "double"):
            if not -2 ** 31 < v < 2 ** 31 or to == "uint" and v < 0:
                raise Undefined("conversion")
            return int(v)
        return wrap(int(v), to)

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
        return [self.builtin(op, base, *values) for values in zip(*args)]

    def builtin(self, op: str, base: str, x, y=None, z=None):
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


def declared(s: S) -> list[Variable]:
    return [v for v, _ in s.data] if s.kind == "decl" else []


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
