"""Runs a program for one thread after another, by the rules of GLSL alone: the truth that the debugger must show.

Everything is exact: integers wrap, and a float operation whose result would have to be rounded ends the run
with Undefined, like everything else that GLSL leaves open (uninitialised reads, indices outside of bounds, ...).
"""

from __future__ import annotations

from dataclasses import dataclass, field

from arithmetic import Undefined
from evaluate import Evaluator
from tree import E, Function, Program, S, Variable, vec


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
    nothing: bool  # the thread draws nothing
    outputs: dict  # Variable -> value, as far as it draws
    initial: dict  # of globals: their values before main
    loops: dict  # loop statement -> list of iterations, one per time that it was entered


class Interpreter(Evaluator):
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
        self.place_on_target = [2 * (x + 0.5) / self.program.width - 1, 2 * (y + 0.5) / self.program.height - 1, 0.0, 1.0]
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
        self.emitted: dict | None = None
        try:
            self.call(self.main, [])
        except Discarded:
            discarded = True
        outputs = self.emitted if self.program.stage == "geometry" else self.given()
        return Pixel(self.steps, discarded, discarded or outputs is None, outputs or {}, self.initial,
                     self.loop_counts)

    def given(self) -> dict[Variable, list]:
        return {v: list(value) for v, value in self.env.items() if v.storage in ("out", "builtin-out")}

    def e_emit(self, e: E) -> list:
        """Outputs are undefined behind it."""
        self.emitted = self.given()
        for v in self.emitted:
            self.env[v] = [None] * v.type.words()
        return []

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
        for v in visible.values():  # stored with one value in all components
            if v.storage == "image" and place is not None and 0 <= place < len(self.picture):
                values[v.name] = (Variable(v.name, vec("int", 4), "buffer"), [self.picture[place]] * 4)
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

    def s_macro(self, s: S) -> None:
        """Two in one: made by one use of a macro, it is one step."""
        for e in s.exprs:
            self.eval(e)
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


def declared(s: S) -> list[Variable]:
    return [v for v, _ in s.data] if s.kind == "decl" else []
