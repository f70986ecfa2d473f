"""Which variable each name means at each statement; finds what is not a valid program (a reduction can make one)."""

from __future__ import annotations

from tree import E, Function, Program, S, Subroutine, Variable


class Invalid(Exception):
    pass


def resolve(program: Program) -> None:
    Resolver(program).run()


class Resolver:
    def __init__(self, program: Program):
        self.program = program
        self.scopes: list[dict] = [{}]

    def run(self) -> None:
        for one in self.program.declarations:
            if isinstance(one, Variable):
                if one.initializer is not None:
                    self.expression(one.initializer)
                self.scopes[0][one.name] = one
            elif isinstance(one, Subroutine):
                if not all(f in self.program.declarations for f in one.candidates):
                    raise Invalid("a subroutine without its functions")
                self.scopes[0][one.name] = [one.call]
            else:
                self.function(one)

    def visible(self) -> dict:
        seen: dict = {}
        for scope in self.scopes:
            seen |= scope
        return seen

    def variables(self) -> dict:
        return {name: v for name, v in self.visible().items() if isinstance(v, Variable)}

    def declare(self, v: Variable) -> None:
        if not v.name:
            return
        if v.name in self.scopes[-1]:
            raise Invalid(f"{v.name} is declared twice")
        self.scopes[-1][v.name] = v

    def expression(self, e: E | None) -> None:
        if e is None:
            return
        for one in e.walk():
            if one.kind == "var" and not one.data.storage.startswith("builtin"):
                if self.visible().get(one.data.name) is not one.data:
                    raise Invalid(f"{one.data.name} means something else")
            elif one.kind == "fetch":
                if self.visible().get(one.data.name) is not one.data:
                    raise Invalid(f"{one.data.name} means something else")
            elif one.kind == "call":
                seen = self.visible().get(one.data.name)
                if not isinstance(seen, list) or one.data not in seen:
                    raise Invalid(f"{one.data.name} is no function here")

    def function(self, f: Function) -> None:
        overloads = self.scopes[0].setdefault(f.name, [])
        if not isinstance(overloads, list):
            raise Invalid(f"{f.name} is a variable already")
        if f.prototype:
            overloads.append(f)
        self.scopes.append({})
        for p in f.params:
            self.declare(p)
        f.visible = self.variables()
        for one in f.body:
            self.statement(one)
        self.scopes.pop()
        if not f.prototype:
            overloads.append(f)

    def inner(self, statements: list[S]) -> None:
        self.scopes.append({})
        for one in statements:
            self.statement(one)
        self.scopes.pop()

    def statement(self, s: S) -> None:
        s.visible = self.variables()
        if s.kind == "decl":
            for (v, _), e in zip(s.data, s.exprs):
                self.expression(e)
                self.declare(v)
            s.visible_after = self.variables()
        elif s.kind == "block":
            self.inner(s.body)
        elif s.kind == "for":
            self.scopes.append({})
            self.statement(s.body[0])
            for e in s.exprs:
                self.expression(e)
            s.visible_after = self.variables()
            names = dict(self.scopes[-1])
            body = s.body[1].body if s.body[1].kind == "block" else [s.body[1]]
            if any(v.name in names for one in body if one.kind == "decl" for v, _ in one.data):
                raise Invalid("hides a counter in the loop's own block")
            self.inner([s.body[1]])
            self.scopes.pop()
        elif s.kind == "while":
            self.expression(s.exprs[0])
            self.scopes.append({})
            if s.data:
                self.declare(s.data)
            s.visible_after = self.variables()
            body = s.body[0].body if s.body[0].kind == "block" else [s.body[0]]
            if s.data and any(v.name == s.data.name for one in body if one.kind == "decl" for v, _ in one.data):
                raise Invalid("hides a condition's variable in the loop's own block")
            self.inner([s.body[0]])
            self.scopes.pop()
        else:
            for e in s.exprs:
                self.expression(e)
            s.visible_after = s.visible
            if s.kind == "do":
                self.inner([s.body[0]])
            elif s.kind == "switch":
                self.inner(s.body)
            else:
                for one in s.body:
                    self.inner([one])
