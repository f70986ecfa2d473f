"""Random statements: what may stand in a function's body."""

from __future__ import annotations

from expressions import Expressions
from operands import REST, Context, lit, var
from tree import BOOL, E, FLOAT, INT, UINT, VOID, S, Type, Variable, vec


class Statements(Expressions):
    """Needs of its owner, too: self.stage, self.current, self.loops, self.switches, self.budget, self.pix, self.atomic."""

    def statements(self, count: int) -> list[S]:
        made: list[S] = []
        for _ in range(count):
            if self.budget <= 0 and made:
                break
            self.budget -= 1
            made += self.statement()
            if made and made[-1].kind in ("return", "break", "continue", "discard") and self.random.random() < 0.8:
                break
        return made

    def body(self, count: int | None = None) -> S:
        """Of a loop or a branch: a block, or one statement without braces."""
        r = self.random
        if r.random() < 0.3:
            self.scopes.append({})
            made = self.statement(single=True)
            self.scopes.pop()
            if len(made) == 1 and made[0].kind != "decl":
                return made[0]
            return S("block", body=made)
        return self.block(count)

    def block(self, count: int | None = None) -> S:
        self.scopes.append({})
        made = self.statements(count or self.random.randint(1, 3))
        self.scopes.pop()
        return S("block", body=made)

    def statement(self, single: bool = False) -> list[S]:
        r = self.random
        nested = len(self.scopes) < 7 and self.budget > 0
        ways = [(self.expression_statement, 10), (self.declaration, 0 if single else 7), (self.memory, 2),
                (self.jump, 3), (lambda: [S("empty")], 0.4), (self.both, 0.5)]
        if nested:
            ways += [(self.if_, 5), (self.loop, 4), (self.elements, 2), (lambda: [self.block()], 1)]
            if self.dialect.integers:
                ways.append((self.switch, 2))
        way = r.choices([w for w, _ in ways], [weight for _, weight in ways])[0]
        return way() or [S("empty")]

    def expression_statement(self) -> list[S]:
        r = self.random
        ctx = Context(3)
        x = r.random()
        if x < 0.12:
            types = [t for t in (v.type for v in self.variables(ctx)) if self.is_value(t)] or [INT]
            return [S("expr", [self.expression(r.choice(types), ctx)])]
        if x < 0.24 and not self.dialect.es or not self.dialect.integers:
            changed = self.compound_float()
            if changed:
                return changed
        e = self.effect(ctx)
        if e is None:
            return [S("empty")]
        if x > 0.93:
            second = self.effect(ctx)
            if second is not None:
                e = E("comma", second.type, [e, second])
        return [S("expr", [e])]

    def both(self) -> list[S]:
        """Two assignments in a block that a macro makes: one step, as nothing is called."""
        made = [self.effect(Context(2)) for _ in range(2)]
        if any(e is None or any(one.kind == "call" for one in e.walk()) for e in made):
            return []
        return [S("macro", made)]

    def compound_float(self) -> list[S]:
        """x += e; x = clamp(x, ...);"""
        target = self.lvalue(FLOAT, Context(2), REST)
        if target is None or any(one.kind not in ("var", "index", "member", "swizzle", "lit") for one in target.walk()):
            return []
        e = self.settled(FLOAT, Context(2).beside(target), REST)
        first = E("assign", FLOAT, [target, e], self.random.choice(["+=", "-="]))
        root = next(self.root(target))
        first.writes |= {root}
        clamp = E("builtin", FLOAT, [target, lit(FLOAT, REST[0]), lit(FLOAT, REST[1])], "clamp", REST, 2)
        second = E("assign", FLOAT, [target, clamp], "=", REST, 2)
        second.writes |= {root}
        if self.random.random() < 0.5:
            return [S("expr", [E("comma", FLOAT, [first, second])])]
        return [S("block", body=[S("expr", [first]), S("expr", [second])])]

    def declaration(self) -> list[S]:
        r = self.random
        t = self.type()
        base = Type(t.base, t.rows, t.cols, (), t.struct)
        names, exprs, later = [], [], []
        for n in range(r.choice([1, 1, 1, 2, 3])):
            own = t if n == 0 or r.random() < 0.3 else base
            v = Variable(self.name(), own, "local", self.range_for(own))
            init = None
            if self.is_value(own) and r.random() < 0.85:
                init = self.settled(own, Context(3), v.range)
                if own.dims and own.base not in ("bool", "struct") and not self.keeps(init, v.range):
                    init = self.simple(own, v.range)
            names.append((v, 0))
            exprs.append(init)
            self.declare(v)
            if init is None:
                v.ready = False
                later += self.fill(var(v), own, v.range)
        for v, _ in names:
            v.ready = True
        return [S("decl", exprs, data=names)] + later

    def fill(self, target: E, t: Type, range_) -> list[S]:
        """Assigns every component, in the largest pieces that this version can assign."""
        if self.is_value(t):
            e = E("assign", t, [target, self.simple(t, range_)], "=", range_)
            e.writes |= {next(self.root(target))}
            return [S("expr", [e])]
        if t.struct and not t.dims:
            made = []
            for name, member in t.struct.members:
                made += self.fill(E("member", member, [target], name), member, self.rest(member))
            return made
        made = []
        for i in range(t.dims[0]):
            made += self.fill(E("index", t.element(), [target, lit(INT, i)]), t.element(), range_)
        return made

    def memory(self) -> list[S]:
        r = self.random
        seen = self.visible()
        if self.current.name != "main" or not isinstance(seen.get("pix"), Variable) or seen["pix"] is not self.pix:
            return []
        found = [v for v in seen.values() if isinstance(v, Variable) and v.storage in ("buffer", "image", "counter")]
        if not found:
            return []
        v = r.choice(found)
        if v.storage == "counter":
            e = E("memory", UINT, [], ("increment", v))
        elif v.storage == "image":
            e = E("memory", VOID, [var(self.pix), self.expression(INT, Context(2))], ("store", v))
        elif v.type.dims:
            cell = E("index", INT, [var(v), var(self.pix)])
            e = E("assign", INT, [cell, self.expression(INT, Context(2))], r.choice(["=", "+=", "^="]))
        else:
            e = E("memory", INT, [var(v), self.expression(INT, Context(2))], (self.atomic, v))
        e.writes |= {v}
        return [S("expr", [e])]

    def jump(self) -> list[S]:
        r = self.random
        choices = ["return"] * 2
        if self.loops and self.switches == 0:
            choices += ["break", "continue"] * 3
        elif self.switches:
            choices += ["break"] * 2 + (["continue"] if self.loops else [])
        if r.random() < 0.3 and self.stage == "fragment":
            choices += ["discard"]
        kind = r.choice(choices)
        if self.current.name == "main" and kind == "return" and r.random() < 0.6:
            return []
        exprs = [self.returned()] if kind == "return" and self.current.type != VOID else []
        jump = S(kind, exprs)
        if r.random() < 0.1 and kind != "discard":
            return [jump]
        condition = self.expression(BOOL, Context(2))
        if kind in ("discard", "return"):
            condition = E("logic", BOOL, [condition, self.rare()], "&&")
        return [S("if", [condition], [jump if r.random() < 0.6 else S("block", body=[jump])])]

    def rare(self) -> E:
        """True on few pixels."""
        c = E("swizzle", FLOAT, [var(self.coord)], self.random.choice("xy"), (0.5, 31.5), 1)
        return E("bin", BOOL, [c, lit(FLOAT, float(self.random.randint(1, 4)))], self.random.choice("<>"))

    def if_(self) -> list[S]:
        r = self.random
        made = S("if", [self.expression(BOOL, Context(3))], [self.body()])
        if r.random() < 0.45:
            if made.body[0].kind == "if":  # whose else?
                made.body = [S("block", body=[made.body[0]])]
            made.body.append(self.body())
        return [made]

    def counter(self, range_) -> Variable:
        return Variable(self.name(), INT, "local", range_, False)

    def loop(self) -> list[S]:
        r = self.random
        n = r.choice([1, 2, 2, 3, 3, 4])
        kind = r.choice(["for", "for", "for", "while", "do", "forever", "cond-decl"])
        saved = self.loops, self.switches
        self.scopes.append({})
        if kind == "for":
            made = self.for_(n)
        else:
            k = self.declare(self.counter((0, n + 1)))
            first = S("decl", [lit(INT, 0)], data=[(k, 0)])
            step = E("incdec", INT, [var(k)], ("++", kind != "while"))
            step.writes |= {k}
            going = E("bin", BOOL, [step, lit(INT, n)], "<")
            if r.random() < 0.4 and kind != "forever":
                extra = self.expression(BOOL, Context(2))
                going = E("logic", BOOL, [going, extra], "&&")
            if kind == "cond-decl" and r.random() < 0.5:
                going = E("bin", BOOL, [step, lit(INT, n)], "<")
            self.loops, self.switches = self.loops + 1, 0
            if kind == "while":
                loop = S("while", [going], [self.body()])
            elif kind == "cond-decl":
                v = Variable(self.name(), BOOL, "condition", None, False)
                if v.name in self.scopes[-1]:
                    v.name = "going"
                self.scopes.append({})
                self.declare(v)
                loop = S("while", [going], [self.block()], data=v)
                self.scopes.pop()
            elif kind == "do":
                loop = S("do", [going], [self.body()])
            else:
                inner = self.block()
                stop = S("if", [E("bin", BOOL, [step, lit(INT, n)], ">")], [S("break")])
                inner.body.insert(0, stop)
                head = r.choice(["for", "while"])
                loop = S("for", [None, None], [S("empty"), inner]) if head == "for" else \
                    S("while", [lit(BOOL, True)], [inner])
            made = [S("block", body=[first, loop])]
        self.scopes.pop()
        self.loops, self.switches = saved
        return made

    def for_(self, n: int) -> list[S]:
        r = self.random
        i = self.counter((0, max(n - 1, 0)))
        start = lit(INT, 0)
        names, exprs = [(i, 0)], [start]
        self.declare(i)
        if r.random() < 0.25:
            v = Variable(self.name(), INT, "local", self.range_for(INT))
            if v.name not in self.scopes[-1]:
                exprs.append(self.settled(INT, Context(2), v.range))
                names.append((v, 0))
                self.declare(v)
        init = S("decl", exprs, data=names)
        going = E("bin", BOOL, [var(i), lit(INT, n)], "<")
        if r.random() < 0.35:
            going = E("logic", BOOL, [going, self.expression(BOOL, Context(2))], "&&")
        step = E("incdec", INT, [var(i)], ("++", r.random() < 0.5))
        step.writes |= {i}
        if r.random() < 0.2:
            step = E("assign", INT, [var(i), lit(INT, 1)], "+=")
            step.writes |= {i}
        if r.random() < 0.3:
            more = self.effect(Context(2))
            if more is not None:
                step = E("comma", INT, [more, step]) if r.random() < 0.5 else E("comma", more.type, [step, more])
        self.loops, self.switches = self.loops + 1, 0
        self.scopes.append(dict(self.scopes[-1]))  # the body may not declare the counter's name again
        body = self.body()
        self.scopes.pop()
        return [S("for", [going, step], [init, body])]

    def elements(self) -> list[S]:
        """A loop over as many elements as a value says that the compiler does not know, all of them at most."""
        r = self.random
        if not self.dialect.dynamic_loops:
            return []
        n = r.choice([2, 3, 3, 4])
        of = self.declare(Variable(self.name(), r.choice([vec("float", n), Type("float", dims=(n,))]), "local", REST))
        of.ready = False
        made = [S("decl", [None], data=[(of, 0)])] + self.fill(var(of), of.type, REST)
        of.ready = True
        many = self.counter((0, n))
        where = E("ctor", INT, [E("swizzle", FLOAT, [var(self.coord)], r.choice("xy"), (0.5, 31.5), 1)], range_=(0, 31))
        if self.dialect.integers and r.random() < 0.7:
            bound = E("bin", INT, [where, lit(INT, n + 1)], "%", many.range)
        else:
            bound = self.settle(where, many.range, Context(2)) or self.settled(INT, Context(3), many.range)
        made.append(S("decl", [bound], data=[(many, 0)]))
        self.declare(many)
        last = self.declare(Variable(self.name(), FLOAT, "local", REST))
        made.append(S("decl", [lit(FLOAT, 0.0)], data=[(last, 0)]))
        i = self.counter((0, n - 1))

        saved = self.loops, self.switches, dict(self.scopes[-1])
        self.loops, self.switches = self.loops + 1, 0
        self.declare(i)
        self.scopes.append(dict(self.scopes[-1]))
        body = self.block()
        self.scopes.pop()
        self.loops, self.switches, self.scopes[-1] = saved
        take = E("assign", FLOAT, [var(last), E("index", FLOAT, [var(of), var(i)], range_=REST, frac=2)], "=", REST, 2)
        take.writes |= {last}
        step = E("incdec", INT, [var(i)], ("++", r.random() < 0.5))
        step.writes |= {i}
        first = S("decl", [lit(INT, 0)], data=[(i, 0)])
        going = E("bin", BOOL, [var(i), var(many)], "<")
        body.body.insert(r.choice([0, 0, len(body.body)]), S("expr", [take]))
        if r.random() < 0.5:
            return made + [S("for", [going, step], [first, body])]
        body.body.insert(0, S("if", [E("bin", BOOL, [var(i), var(many)], ">=")], [S("break")]))
        if r.random() < 0.3:
            body.body.insert(0, self.expression_statement()[0])
        return made + [S("for", [None, step], [first, body])]

    def switch(self) -> list[S]:
        r = self.random
        labels = r.sample(range(-1, 5), r.randint(1, 4))
        selector = self.settled(INT, Context(3), (0, 7)) if r.random() < 0.7 else self.expression(INT, Context(2))
        cases: list = []
        default = r.randint(0, 2 * len(labels))
        saved = self.switches
        self.switches += 1
        body: list[S] = []
        self.scopes.append({})
        for n, label in enumerate(labels):
            here = [label] + ([None] if n == default else [])
            r.shuffle(here)
            body += [S("case", data=one) for one in here]
            if r.random() < 0.2 and n + 1 < len(labels):
                continue
            self.scopes.append({})
            made = self.statements(r.randint(1, 2))
            self.scopes.pop()
            if any(one.kind == "decl" for one in made):
                made = [S("block", body=made)]
            if r.random() < 0.6:
                made.append(S("break"))
            body += made or [S("empty")]
        if body[-1].kind == "case":
            body.append(S("empty"))
        self.scopes.pop()
        self.switches = saved
        return [S("switch", [selector], body)]
