"""Random valid shaders, the same for the same seed."""

from __future__ import annotations

import random

from dialect import DIALECTS, Dialect
from operands import MANY, REST, Context, lit, var
from stages import STAGES
from statements import Statements
from tree import BOOL, E, FLOAT, INT, UINT, VOID, Function, Program, S, Struct, Subroutine, Type, Variable, vec

NAMES = ["a", "b", "c", "d", "e", "i", "j", "k", "n", "v", "w", "sum", "value", "state", "color", "x1", "tmp", "result",
         "sd_x", "sd_end", "sd_words", "sd_at", "sd2_words", "sd_record", "record", "probe", "shadestep", "main_", "l",
         "mark", "reached", "words", "index_", "S1", "hit", "pixel", "sd_main", "_", "_0", "aVeryLongNameForAVariable"]
OLD_NAMES = ["sample", "patch", "buffer", "shared", "texture", "smooth", "layout", "flat", "uint"]
FUNCTION_NAMES = ["f", "g", "h", "shade", "step1", "pick", "sd_f", "helper", "next", "apply"]


class Generator(Statements):
    def __init__(self, seed: str, dialect: Dialect, stage: str = "fragment", size: int = 24):
        self.stage = stage
        self.random = random.Random(seed)
        self.dialect = dialect
        self.budget = size
        self.program = Program(dialect.version, dialect.es, *STAGES[stage].size, stage)
        self.functions: list[Function] = []
        self.structs: list[Struct] = []
        self.scopes: list[dict] = [{}]
        self.lim = self.low = None
        # Where the thread is, in halves: stages.py
        self.coord = Variable("gl_FragCoord" if stage == "fragment" else "place", vec("float", 4), "builtin", (0.5, 31.5), False)
        self.current: Function | None = None
        self.loops = 0  # around the current statement, in its function
        self.switches = 0  # between it and the innermost loop
        self.outputs = self.program.outputs
        self.pix: Variable | None = None
        self.atomic = self.random.choice(["atomicAdd", "atomicMax", "atomicXor"])  # one, so that its order is free

    # ---- names --------------------------------------------------------------------------------------------------

    def visible(self) -> dict:
        seen: dict = {}
        for scope in self.scopes:
            seen |= scope
        return seen

    def name(self) -> str:
        """Not yet in the innermost scope; now and then one that hides another."""
        here = self.scopes[-1]
        outer = [n for n in self.visible() if n not in here and not n.startswith("gl_") and n not in ("lim", "low", "pix", "used")
                 and len(self.scopes) > 1 and (len(self.scopes) > 2 or not n.startswith("out_"))]
        if outer and self.random.random() < 0.25:
            return self.random.choice(outer)
        pool = NAMES + (OLD_NAMES if not self.dialect.es and self.dialect.version < 130 else [])
        taken = self.visible()
        free = [n for n in pool if n not in taken]
        if free:
            return self.random.choice(free)
        return f"v{self.random.randrange(10 ** 6)}"

    def declare(self, variable: Variable) -> Variable:
        if variable.name:
            self.scopes[-1][variable.name] = variable
        return variable

    # ---- types --------------------------------------------------------------------------------------------------

    def type(self, deep: int = 2) -> Type:
        r = self.random.random()
        bases = ["int", "int", "int", "float", "float", "bool"] + (["uint", "uint"] if self.dialect.integers else []) + (
            ["double"] if self.dialect.doubles else []) + (["int64", "uint64"] if self.dialect.int64 else [])
        base = self.random.choice(bases)
        if r < 0.55:
            return Type(base)
        if r < 0.75:
            return Type(base, self.random.randint(2, 4))
        if r < 0.83 and base in ("float", "double"):
            cols = self.random.randint(2, 4)
            return Type(base, self.random.randint(2, 4) if self.dialect.array_values else cols, cols)
        if r < 0.90 and self.structs:
            return Type("struct", struct=self.random.choice(self.structs))
        if deep > 0:
            element = self.type(deep - 1)
            if element.dims and not self.dialect.arrays_of_arrays:
                element = element.element()
            if element.words() <= 12:
                return Type(element.base, element.rows, element.cols, (self.random.randint(1, 4),) + element.dims,
                            element.struct)
        return Type(base)

    def range_for(self, type_: Type):
        if type_.base in ("float", "double"):
            return REST
        if type_.base != "int":
            return None
        if not self.dialect.integers:
            return self.random.choice([MANY, MANY, (0, 3)]) if type_.is_scalar() else MANY
        return self.random.choice([None, None, None, (0, 3), (0, 7)]) if type_.is_scalar() else None

    def is_value(self, type_: Type) -> bool:
        """Can it be initialized, assigned and returned?"""
        return not has_array(type_) or self.dialect.array_values

    # ---- the whole ----------------------------------------------------------------------------------------------

    def generate(self) -> Program:
        r = self.random
        for i in range(r.choice([0, 1, 1, 2])):
            members = []
            for n in range(r.randint(1, 3)):
                t = self.type(1)
                members.append((r.choice("pqrstuvw") + str(n), t))
            struct = Struct(r.choice(["S", "Record", "sd_S", "Pair"]) + str(i), tuple(members))
            self.structs.append(struct)
        self.program.structs = list(self.structs)
        self.inputs()
        if not self.dialect.integers:
            self.limiters()
        self.used()
        for _ in range(r.randint(0, 3)):
            self.global_variable()
        for _ in range(r.randint(1, 3)):
            self.function()
        if self.dialect.subroutines and r.random() < 0.5:
            self.subroutine()
        if r.random() < 0.5:
            self.global_variable()
        self.main()
        if r.random() < 0.4:
            self.program.layout_seed = r.randint(1, 10 ** 6)
        return self.program

    def add_global(self, v: Variable, qualifier: str = "") -> Variable:
        v.qualifier = qualifier
        self.program.declarations.append(v)
        return self.declare(v)

    def inputs(self) -> None:
        r, d = self.random, self.dialect
        for i in range(r.randint(1, 3)):
            base = r.choice(["int", "float"] + (["uint"] if d.integers else []) + (["bool"] if d.integers else []))
            t = Type(base, r.choice([1, 1, 2, 3, 4]))
            v = Variable(f"u_{i}", t, "uniform", (0, 7) if base in ("int", "uint") else (0.0, 8.0), False)
            v.value = [self.leaf_value(base) for _ in range(t.words())]
            self.add_global(v, "uniform")
        if d.blocks and r.random() < 0.5:
            v = Variable("blocked", Type("int", 4, 1, (2,)), "uniform", (0, 7), False)
            v.value = [self.leaf_value("int") for _ in range(8)]
            self.add_global(v, "block")
        if d.fetches:
            for base in r.sample(["int", "float"], r.randint(0, 2)):
                # texel() of evaluate.py
                v = Variable(f"map_{base}", Type(base, 4), "texture", (-20, 49) if base == "int" else (-5.0, 12.25), False)
                self.add_global(v, "texture")
        if d.memory and (r.random() < 0.7 or STAGES[self.stage].memory_only):
            cells = Variable("cells", Type("int", 1, 1, (self.program.width * self.program.height,)), "buffer", None)
            total = Variable("total", INT, "buffer", None)
            self.add_global(total, "storage")
            self.add_global(cells, "storage")
            if r.random() < 0.6:
                self.add_global(Variable("picture", INT, "image", None), "image")
            if r.random() < 0.6:
                self.add_global(Variable("counted", UINT, "counter", None), "counter")
        if STAGES[self.stage].memory_only:
            return
        if d.integers:
            for i in range(r.choice([1, 1, 2, 3])):
                base = r.choice(["float", "float", "int", "uint"])
                v = Variable(f"out_{i}", Type(base, 4), "out", (64.0, 192.0) if base == "float" else None)
                self.outputs.append(self.add_global(v, "out"))
        elif self.stage == "vertex":
            v = Variable("out_0", vec("float", 4), "out", (64.0, 192.0))
            self.outputs.append(self.add_global(v, "varying"))
        else:
            v = Variable("gl_FragColor", vec("float", 4), "builtin-out", (64.0, 192.0))
            if not d.es and r.random() < 0.5:
                v = Variable("gl_FragData", Type("float", 4, 1, (2,)), "builtin-out", (64.0, 192.0))
                self.outputs.append(v)  # longer than these two: not for the shader's own expressions
            else:
                self.outputs.append(self.declare(v))
        if r.random() < 0.25 and not (d.es and d.version < 300) and self.stage == "fragment":
            depth = Variable("gl_FragDepth", FLOAT, "builtin-out", (0.25, 0.75))
            self.outputs.append(depth)

    def leaf_value(self, base: str):
        if base == "bool":
            return self.random.random() < 0.5
        value = self.random.randint(0, 7)
        return float(value) + self.random.choice([0.0, 0.25, 0.5]) if base == "float" else value

    def limiters(self) -> None:
        """Functions that keep integers small where GLSL does not define their wrapping."""
        v = Variable("v", INT, "parameter", None)
        thousand = E("bin", INT, [E("bin", INT, [var(v), lit(INT, 1000)], "/"), lit(INT, 1000)], "*")
        self.lim = Function("lim", INT, [v], [S("return", [E("bin", INT, [var(v), thousand], "-")])], MANY)
        v, top = Variable("v", INT, "parameter", None), Variable("top", INT, "parameter", None)
        self.low = Function("low", INT, [v, top], [
            S("if", [E("bin", BOOL, [var(v), lit(INT, 0)], "<")], [S("return", [lit(INT, 0)])]),
            S("return", [E("cond", INT, [E("bin", BOOL, [var(v), var(top)], ">"), var(top), var(v)])])], (0, 3))
        for f in (self.lim, self.low):
            self.functions.append(f)
            self.program.declarations.append(f)
            self.scopes[0][f.name] = f

    def global_variable(self) -> None:
        t = self.type()
        if self.program.es and not self.is_value(t):
            return
        v = Variable(self.name(), t, "global", self.range_for(t))
        if not self.is_value(t):
            return
        constant = not self.dialect.free_initializers or self.random.random() < 0.5
        ctx = Context(2, constant=constant, pure=self.random.random() < 0.9)
        v.initializer = self.simple(t, v.range) if constant else self.settled(t, ctx, v.range)
        if t.dims and not self.keeps(v.initializer, v.range) and t.base not in ("bool", "struct"):
            v.initializer = self.simple(t, v.range)
        if self.random.random() < 0.2 and constant:
            v.storage, v.writable = "constant", False
        self.add_global(v, "const" if v.storage == "constant" else "")

    # ---- functions ----------------------------------------------------------------------------------------------

    def function(self) -> None:
        r = self.random
        t = r.choice([VOID, INT, INT, BOOL, FLOAT]) if r.random() < 0.7 else self.type(1)
        if t.dims and not self.dialect.array_values or t != VOID and not self.is_value(t):
            t = INT
        params = []
        self.scopes.append({})
        for _ in range(r.choice([0, 1, 1, 2, 3])):
            p = self.type(1)
            if not self.is_value(p):
                p = FLOAT
            v = Variable(self.name(), p, "parameter", self.range_for(p))
            v.qualifier = r.choice(["", "", "in", "const in", "out", "inout"])
            if v.qualifier == "const in":
                v.writable = False
            params.append(v)
            self.declare(v)
        functions = [f.name for f in self.functions if f not in (self.lim, self.low) and f.name != "used"]
        name = r.choice(functions) if functions and r.random() < 0.35 else r.choice(FUNCTION_NAMES)
        if any(f.name == name and len(f.params) == len(params) for f in self.functions) or \
                isinstance(self.scopes[0].get(name), Variable):
            name = f"f{len(self.functions)}"
        function = Function(name, t, params, range=self.range_for(t) if t != VOID else None,
                            prototype=r.random() < 0.2)
        if t.dims and t.base in ("int", "uint"):
            function.range = None if self.dialect.integers else MANY
        self.function_body(function)

    def function_body(self, function: Function) -> None:
        """The innermost scope holds its parameters, and is left."""
        r, t, params = self.random, function.type, function.params
        self.current = function
        self.loops = self.switches = 0
        self.budget = r.randint(2, 7)
        self.scopes.append({})  # what the body declares hides the parameters at most in inner blocks
        self.scopes[-1] = dict(self.scopes[-2])
        body = [self.first_value(p) for i, p in enumerate(params) if function.out(i) and p.qualifier == "out"]
        body += self.statements(r.randint(1, 4))
        if t != VOID:
            body.append(S("return", [self.returned()]))
        self.scopes.pop()
        self.scopes.pop()
        function.body = body
        self.finish(function)

    def subroutine(self) -> None:
        """Two functions, one of which a uniform picks."""
        r = self.random
        t = r.choice([VOID, INT, FLOAT])
        made: list[Function] = []
        kinds = [(r.choice([INT, FLOAT]), r.choice(["", "in", "inout"])) for _ in range(r.randint(0, 2))]
        ranges = [self.range_for(p) for p, _ in kinds]
        for n in range(2):
            self.scopes.append({})
            params = []
            for (p, qualifier), range_ in zip(kinds, ranges):
                v = Variable(self.name(), p, "parameter", range_)
                v.qualifier = qualifier
                params.append(self.declare(v))
            function = Function(f"way_{n}", t, params, range=made[0].range if made else self.range_for(t))
            self.function_body(function)
            made.append(function)
        names = [Variable(f"p{i}", p, "parameter", range_) for i, ((p, _), range_) in enumerate(zip(kinds, ranges))]
        for v, (_, qualifier) in zip(names, kinds):
            v.qualifier = qualifier
        call = Function("chosen", t, names, range=made[0].range, picked=r.choice(made))
        call.reads, call.writes = made[0].reads | made[1].reads, made[0].writes | made[1].writes
        call.discards = any(f.discards for f in made)
        one = Subroutine("Way", call, made)
        for f in (*made, call):
            f.subroutine = one
        self.program.declarations.append(one)
        self.functions = [f for f in self.functions if f not in made] + [call]
        self.scopes[0]["chosen"] = call

    def returned(self) -> E:
        f = self.current
        e = self.settled(f.type, Context(2), f.range)
        if f.type.dims and f.type.base not in ("bool", "struct") and not self.keeps(e, f.range):
            e = self.simple(f.type, f.range)
        return e

    def finish(self, function: Function) -> None:
        reads: frozenset = frozenset()
        writes: frozenset = frozenset()
        for one in function.body:
            for s in one.walk():
                function.discards |= s.kind == "discard"
                for e in own_expressions(s):
                    reads, writes = reads | e.reads, writes | e.writes
                    function.discards |= self.discarding(e)
        outside = set(self.program.globals) | {v for v in self.scopes[0].values() if isinstance(v, Variable)}
        function.reads = frozenset(reads & outside)
        function.writes = frozenset(writes & outside)
        self.functions.append(function)
        self.program.declarations.append(function)
        self.scopes[0][function.name] = function

    def first_value(self, v: Variable) -> S:
        e = E("assign", v.type, [var(v), self.simple(v.type, v.range)], "=", v.range)
        e.writes |= {v}
        return S("expr", [e])

    def main(self) -> None:
        r = self.random
        function = Function("main", VOID, [])
        self.current = function
        self.loops = self.switches = 0
        self.budget = r.randint(8, 20)
        self.scopes.append({})
        body = self.first_builtins()
        body += [s for v in self.outputs for s in self.first_values(v)]
        x, y = (E("ctor", INT, [E("swizzle", FLOAT, [var(self.coord)], c, (0.5, 31.5), 1)], range_=(0, 31)) for c in "xy")
        self.pix = Variable("pix", INT, "local", (0, self.program.width * self.program.height - 1), False)
        at = E("bin", INT, [E("bin", INT, [y, lit(INT, self.program.width)], "*"), x], "+")
        body.append(S("decl", [at], data=[(self.declare(self.pix), 0)]))
        body += self.statements(r.randint(4, 9))
        for v in self.outputs:
            body.append(self.output(v))
        used = E("call", BOOL, [], self.scopes[0]["used"])
        body.append(S("if", [used], [S("block", body=self.first_values(self.outputs[0]) if self.outputs else self.touch())]))
        if self.stage == "geometry":
            body.append(S("expr", [E("emit", VOID)]))
        self.scopes.pop()
        function.body = body
        self.finish(function)

    def first_builtins(self) -> list[S]:
        """A point on each pixel; patches of as many vertices as they are made for."""
        if self.stage == "tess-control":
            v = Variable("gl_TessLevelOuter", Type("float", dims=(4,)), "builtin-out", (1.0, 1.0))
            places = [E("index", FLOAT, [var(v), lit(INT, i)]) for i in range(2)]
            return [S("expr", [E("assign", FLOAT, [place, lit(FLOAT, 1.0)], "=", v.range)]) for place in places]
        if self.stage not in ("vertex", "tess-eval", "geometry"):
            return []
        v = Variable("gl_Position", vec("float", 4), "builtin-out", (-1.0, 1.0))
        corner = Variable("corner", v.type, "builtin", (-1.0, 1.0), False)
        made = [S("expr", [E("assign", v.type, [var(v), var(corner)], "=", v.range)])]
        if self.dialect.es:
            size = Variable("gl_PointSize", FLOAT, "builtin-out", (1.0, 1.0))
            made.append(S("expr", [E("assign", FLOAT, [var(size), lit(FLOAT, 1.0)], "=", size.range)]))
        return made

    def touch(self) -> list[S]:
        total = next(v for v in self.program.globals if v.name == "total")
        e = E("memory", INT, [var(total), lit(INT, 1)], (self.atomic, total))
        e.writes |= {total}
        return [S("expr", [e])]

    def used(self) -> None:
        """Keeps the driver from dropping uniforms that nothing drawn depends on: those have no value to show."""
        test = lit(BOOL, False)
        for v in self.program.globals:
            if v.storage != "uniform":
                continue
            e = E("index", v.type.element(), [var(v), lit(INT, 0)]) if v.type.dims else var(v)
            if e.type.is_vector():
                e = E("swizzle", e.type.scalar(), [e], "x")
            if e.type == BOOL:
                left = E("swizzle", FLOAT, [var(self.coord)], "x", (0.5, 31.5), 1)
                one = E("logic", BOOL, [e, E("bin", BOOL, [left, lit(FLOAT, 0.25)], "<")], "&&")
            else:
                one = E("bin", BOOL, [e, lit(e.type, 77)], "==")
            test = E("logic", BOOL, [test, one], "||")
        self.finish(Function("used", BOOL, [], [S("return", [test])]))

    def first_values(self, v: Variable) -> list[S]:
        if not v.type.dims:
            return [self.first_value(v)]
        made = []
        for i in range(v.type.dims[0]):
            made += self.fill(E("index", v.type.element(), [var(v), lit(INT, i)]), v.type.element(), v.range)
        return made

    def output(self, v: Variable) -> S:
        """What it draws with depends on what was computed; a zero's sign never gets there."""
        if self.visible().get(v.name, v) is not v:
            return S("empty")
        target, t = var(v), v.type
        if t.dims:
            target = E("index", t.element(), [target, lit(INT, self.random.randrange(t.dims[0]))], range_=v.range, frac=2)
            t = t.element()
        if t.base == "float":
            one = t.scalar()
            e = self.settled(t, Context(2), REST)
            if v.name == "gl_FragDepth":
                scaled = E("bin", one, [e, lit(one, 512.0)], "/", (-0.125, 0.125), e.frac + 9)
                e = E("bin", one, [scaled, lit(one, 0.5)], "+", (0.25, 0.75), 11)
            else:
                e = E("bin", t, [e, lit(one, 128.0)], "+", (64.0, 192.0), 2)
        else:
            e = self.expression(t, Context(3))
        assign = E("assign", t, [target, e], "=", v.range)
        assign.writes |= {v}
        return S("expr", [assign])


def own_expressions(s: S):
    return [e for e in s.exprs if e is not None]


def has_array(t: Type) -> bool:
    return bool(t.dims) or bool(t.struct and any(has_array(member) for _, member in t.struct.members))


def dialect_of(seed: int, stage: str) -> Dialect:
    """Those that have the stage, in turn."""
    dialects = [d for d in DIALECTS if STAGES[stage].runs(d)]
    return dialects[seed % len(dialects)]
