"""Makes a failing program smaller while it fails in the same way: statements, then expressions, are taken out."""

from __future__ import annotations

import copy
from pathlib import Path

import check
import scopes
from dialect import Dialect
from interpret import Broken, Continued, Undefined
from tree import E, Program, S

MOST_TRIES = 400


def reduce(program: Program, dialect: Dialect, folder: Path, tools: check.Tools, seed: str,
           outcome: check.Outcome) -> check.Outcome:
    return Reducer(program, dialect, folder, tools, seed, outcome).run()


class Reducer:
    def __init__(self, program, dialect, folder, tools, seed, outcome):
        self.program, self.dialect, self.folder, self.tools, self.seed = program, dialect, folder, tools, seed
        self.outcome = outcome
        self.tries = 0

    def run(self) -> check.Outcome:
        only = self.outcome.kind if self.outcome.kind not in ("compile", "driver") else "none"
        plain = copy.deepcopy(self.program)
        plain.layout_seed = 0
        self.accept(plain, only)
        again = True
        while again and self.tries < MOST_TRIES:
            again = self.pass_(declarations, only) | self.pass_(statements, only) | self.pass_(expressions, only)
        # The files of the last failure, whole again.
        final = check.Check(self.program, self.dialect, self.folder, self.tools, self.seed, only).run()
        return final if final.kind else self.outcome

    def accept(self, candidate: Program, only: str) -> bool:
        """Does it fail in the same way? Then it is the program from now on."""
        self.tries += 1
        try:
            found = check.Check(candidate, self.dialect, self.folder / "reduced", self.tools, self.seed, only).run()
        except (Undefined, Broken, Continued, scopes.Invalid, KeyError, RecursionError):
            return False
        if found.kind != self.outcome.kind:
            return False
        self.program, self.outcome = candidate, found
        return True

    def pass_(self, changes, only: str) -> bool:
        """Tries every change, the later ones first; each is made on a copy."""
        progress = False
        n = sum(1 for _ in changes(copy.deepcopy(self.program)))
        while n > 0 and self.tries < MOST_TRIES:
            n -= 1
            candidate = copy.deepcopy(self.program)
            change = next((c for i, c in enumerate(changes(candidate)) if i == n), None)
            if change is None:
                continue
            change()
            progress |= self.accept(candidate, only)
        return progress


def declarations(program: Program):
    """Takes out a function, a global, a structure."""
    for i in range(len(program.declarations) - 1):
        if getattr(program.declarations[i], "name", "") == "used":
            continue  # what keeps uniforms from being dropped
        yield lambda i=i: program.declarations.pop(i)
    for i in range(len(program.structs)):
        yield lambda i=i: program.structs.pop(i)


def statements(program: Program):
    for function in program.functions:
        if function.name != "used":
            yield from inside(function.body, 1 if function is program.functions[-1] else 0)


def inside(body: list[S], kept: int = 0):
    """All but the last `kept` statements."""
    for i, s in enumerate(body[:len(body) - kept]):
        if s.kind == "case":
            continue
        yield lambda i=i: body.pop(i)
        if s.kind in ("block", "if", "for", "while", "do", "switch"):
            inner = s.body[1:] if s.kind == "for" else s.body
            yield lambda i=i, inner=inner: body.__setitem__(slice(i, i + 1), [one for one in inner if one.kind != "case"])
        if s.kind == "if" and len(s.body) > 1:
            yield lambda s=s: s.body.pop()
        if s.kind in ("block", "switch"):
            yield from inside(s.body)
        else:
            for k, one in enumerate(s.body):
                if one.kind in ("block", "switch", "if", "for", "while", "do"):
                    yield from inside_one(s.body, k)


def inside_one(body: list[S], k: int):
    """A body that must stay one statement."""
    s = body[k]
    if s.kind == "block":
        if len(s.body) == 1 and s.body[0].kind != "decl":
            yield lambda: body.__setitem__(k, s.body[0])
        yield from inside(s.body)
    elif s.kind == "switch":
        yield from inside(s.body)
    else:
        for n in range(len(s.body)):
            yield from inside_one(s.body, n)


def expressions(program: Program):
    for v in program.globals:
        if v.initializer is not None:
            yield from smaller(v.initializer, lambda e, v=v: setattr(v, "initializer", e))
    used = {id(s) for f in program.functions if f.name == "used" for s in f.body} | {id(program.functions[-1].body[-1])}
    for s in program.statements():
        if id(s) in used:
            continue
        for i, e in enumerate(s.exprs):
            if e is not None:
                yield from smaller(e, lambda new, s=s, i=i: s.exprs.__setitem__(i, new))
        if s.kind == "decl" and len(s.data) > 1:
            for i in range(len(s.data)):
                yield lambda s=s, i=i: (s.data.pop(i), s.exprs.pop(i))


def smaller(e: E, put):
    """One of its own parts instead, or a literal."""
    for one in e.args:
        if one.type == e.type:
            yield lambda one=one: put(one)
    if e.kind not in ("lit", "var") and e.type.is_scalar() and e.type.base != "void":
        value = {"bool": True, "int": 1, "uint": 1}.get(e.type.base, 1.0)
        yield lambda: put(E("lit", e.type, data=value))
    for i, one in enumerate(e.args):
        yield from smaller(one, lambda new, i=i: e.args.__setitem__(i, new))
