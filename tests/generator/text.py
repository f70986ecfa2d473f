"""A program's text, and where each statement stands in it."""

from __future__ import annotations

import random

from dialect import Dialect
from stages import header
from tree import E, Function, Program, S, Subroutine, Type, Variable

PRECEDENCE = {"*": 12, "/": 12, "%": 12, "+": 11, "-": 11, "<<": 10, ">>": 10, "<": 9, ">": 9, "<=": 9, ">=": 9, "==": 8,
              "!=": 8, "&": 7, "^": 6, "|": 5, "&&": 4, "^^": 3, "||": 2}


class Mark:
    """Stands before the first token of a statement, or before a function's name."""

    def __init__(self, of: S | Function):
        self.of = of


def number(e: E) -> list[str]:
    base, value = e.type.base, e.data
    if base == "bool":
        return ["true" if value else "false"]
    text = {"int": str, "uint": lambda v: f"{v}u", "int64": lambda v: f"{v}L", "uint64": lambda v: f"{v}UL", "float": lambda v: repr(float(v)),
            "double": lambda v: f"{float(v)!r}lf"}[base](value)
    return ["(", "-", text[1:], ")"] if text.startswith("-") else [text]


class Writer:
    def __init__(self, program: Program, dialect: Dialect):
        self.program, self.dialect = program, dialect
        self.random = random.Random(program.layout_seed)
        self.odd = program.layout_seed != 0
        self.macros = program.layout_seed % 3 == 1
        self.tokens: list = []

    # ---- expressions --------------------------------------------------------------------------------------------

    def kid(self, e: E, least: int) -> list[str]:
        text, binds = self.expression(e)
        if binds < least or (binds < 14 and self.random.random() < 0.3):
            return ["(", *text, ")"]
        return text

    def list_(self, args: list[E]) -> list[str]:
        text: list[str] = []
        for i, arg in enumerate(args):
            text += ([","] if i else []) + self.kid(arg, 1)
        return text

    def expression(self, e: E) -> tuple[list[str], int]:
        """Its tokens and how strongly it binds."""
        k = e.kind
        if k == "lit":
            if self.macros and e.type.base == "int" and e.data == 1 and self.random.random() < 0.4:
                return ["ONE"], 15
            return number(e), 15
        if k == "bin" and e.data == "+" and self.macros and self.random.random() < 0.2:
            return ["ADD", "(", *self.kid(e.args[0], 1), ",", *self.kid(e.args[1], 1), ")"], 14
        if k == "var":
            return [e.data.name], 15
        if k == "implicit":
            return self.expression(e.args[0])
        if k == "index":
            return [*self.kid(e.args[0], 14), "[", *self.kid(e.args[1], 0), "]"], 14
        if k in ("member", "swizzle"):
            return [*self.kid(e.args[0], 14), ".", e.data], 14
        if k == "length":
            return [*self.kid(e.args[0], 14), ".", "length", "(", ")"], 14
        if k == "un":
            return [e.data, *self.kid(e.args[0], 14)], 13
        if k == "incdec":
            op, prefix = e.data
            target = self.kid(e.args[0], 14)
            return ([op, *target], 13) if prefix else ([*target, op], 14)
        if k in ("bin", "logic"):
            p = PRECEDENCE[e.data]
            return [*self.kid(e.args[0], p), e.data, *self.kid(e.args[1], p + 1)], p
        if k == "cond":
            return [*self.kid(e.args[0], 2), "?", *self.kid(e.args[1], 1), ":", *self.kid(e.args[2], 1)], 1
        if k == "assign":
            return [*self.kid(e.args[0], 13), e.data, *self.kid(e.args[1], 1)], 1
        if k == "comma":
            return [*self.kid(e.args[0], 0), ",", *self.kid(e.args[1], 1)], 0
        if k == "call":
            return [e.data.name, "(", *self.list_(e.args), ")"], 14
        if k == "builtin":
            return [e.data, "(", *self.list_(e.args), ")"], 14
        if k == "ctor":
            dims = [t for n in e.type.dims for t in ("[", str(n), "]")]
            return [e.type.name(), *dims, "(", *self.list_(e.args), ")"], 14
        if k == "memory":
            return self.memory(e), 14
        if k == "emit":
            return ["EmitVertex", "(", ")"], 14
        if k == "fetch":
            at = ["ivec2", "(", *self.list_(e.args), ")"]
            return ["texelFetch", "(", e.data.name, ",", *at, ",", "0", ")"], 14
        raise ValueError(k)

    def memory(self, e: E) -> list[str]:
        op, v = e.data
        if op == "increment":
            return ["atomicCounterIncrement", "(", v.name, ")"]
        if op == "store":
            w = str(self.program.width)
            pix = self.kid(e.args[0], 14)
            return ["imageStore", "(", v.name, ",", "ivec2", "(", *pix, "%", w, ",", *pix, "/", w, ")", ",", "ivec4", "(",
                    *self.kid(e.args[1], 1), ")", ")"]
        return [op, "(", *self.list_(e.args), ")"]

    # ---- statements ---------------------------------------------------------------------------------------------

    def declared(self, variables: list[tuple[Variable, int]], exprs: list) -> list[str]:
        """One declaration of several names of one type."""
        text: list[str] = []
        for i, ((v, _), e) in enumerate(zip(variables, exprs)):
            text += [","] if i else []
            text += [v.name, *(t for n in v.type.dims for t in ("[", str(n), "]"))]
            if e is not None:
                text += ["=", *self.kid(e, 1)]
        return text

    def qualified(self, type_: Type) -> list[str]:
        highp = self.dialect.es and type_.base in ("int", "float", "uint") and self.random.random() < 0.2
        return (["highp"] if highp else []) + [type_.name()]

    def statement(self, s: S) -> list:
        text: list = [Mark(s)]
        k = s.kind
        if k == "macro":
            return text + ["BOTH", "(", *self.kid(s.exprs[0], 1), ",", *self.kid(s.exprs[1], 1), ")"]
        if self.macros and self.random.random() < 0.25:
            made = self.by_macro(s)
            if made:
                return text + made
        if k == "expr":
            return text + self.expression(s.exprs[0])[0] + [";"]
        if k == "empty":
            return text + [";"]
        if k == "decl":
            return text + self.qualified(s.data[0][0].type) + self.declared(s.data, s.exprs) + [";"]
        if k == "block":
            inner: list = []
            for one in s.body:
                inner += self.statement(one)
            return text + ["{"] + inner + ["}"]
        if k == "if":
            text += ["if", "(", *self.kid(s.exprs[0], 0), ")"] + self.statement(s.body[0])
            return text + (["else"] + self.statement(s.body[1]) if len(s.body) > 1 else [])
        if k == "for":
            cond, step = ([] if e is None else self.kid(e, 0) for e in s.exprs)
            return text + ["for", "("] + self.statement(s.body[0]) + [*cond, ";", *step, ")"] + self.statement(s.body[1])
        if k == "while":
            head = ["bool", s.data.name, "="] if s.data else []
            return text + ["while", "(", *head, *self.kid(s.exprs[0], 1 if s.data else 0), ")"] + self.statement(s.body[0])
        if k == "do":
            return text + ["do"] + self.statement(s.body[0]) + ["while", "(", *self.kid(s.exprs[0], 0), ")", ";"]
        if k == "switch":
            inner = []
            for one in s.body:
                inner += self.statement(one)
            return text + ["switch", "(", *self.kid(s.exprs[0], 0), ")", "{"] + inner + ["}"]
        if k == "case":
            label = ["default"] if s.data is None else ["case", *(["-", "1"] if s.data < 0 else [str(s.data)])]
            return text + label + [":"]
        if k == "return":
            return text + ["return", *(self.kid(s.exprs[0], 0) if s.exprs else []), ";"]
        return text + [k, ";"]

    def by_macro(self, s: S) -> list:
        """The statement, or its head, made by a macro."""
        if s.kind == "expr":
            return ["DO", "(", *self.kid(s.exprs[0], 1), ")", ";"]
        if s.kind == "decl" and len(s.data) == 1 and s.exprs[0] is not None and not s.data[0][0].type.dims:
            v = s.data[0][0]
            return ["LET", "(", v.type.name(), ",", v.name, ",", *self.kid(s.exprs[0], 1), ")", ";"]
        if s.kind == "if" and len(s.body) == 1:
            return ["WHEN", "(", *self.kid(s.exprs[0], 1), ")"] + self.statement(s.body[0])
        if s.kind == "while" and not s.data:
            return ["AS_LONG_AS", "(", *self.kid(s.exprs[0], 1), ")"] + self.statement(s.body[0])
        if s.kind == "return" and s.exprs:
            return ["GIVE", "(", *self.kid(s.exprs[0], 1), ")"]
        return []

    # ---- the whole ----------------------------------------------------------------------------------------------

    def header(self) -> list[str]:
        lines = [self.dialect.line()]
        if self.macros:
            lines += ["#define ONE 1", "#define ADD(a, b) ((a) + \\", "                   (b))"] if self.dialect.version >= 420 \
                else ["#define ONE 1", "#define ADD(a, b) ((a) + (b))"]
            lines += ["#define DO(e) e", "#define LET(t, name, e) t name = e", "#define WHEN(c) if (c)",
                      "#define AS_LONG_AS(c) while (c)", "#define GIVE(e) return e;"]
        lines += ["#define BOTH(a, b) { a; b; }"]
        if self.dialect.int64:
            lines.insert(1, "#extension GL_ARB_gpu_shader_int64 : enable")
        if self.dialect.es:
            lines += ["precision highp float;", "precision highp int;"]
        return lines + header(self.program.stage, self.dialect)

    def global_(self, v: Variable, location: int) -> list[str]:
        q, dims = v.qualifier, [t for n in v.type.dims for t in ("[", str(n), "]")]
        highp = ["highp"] if self.dialect.es else []
        if q == "storage":
            return []  # with the others, in one block
        if q == "texture":
            prefix = "i" if v.type.base == "int" else ""
            return ["uniform", *highp, prefix + "sampler2D", v.name, ";"]
        if q == "image":
            return ["layout", "(", "r32i", ",", "binding", "=", "0", ")", "writeonly", "uniform", *highp, "iimage2D", v.name,
                    ";"]
        if q == "counter":
            return ["layout", "(", "binding", "=", "0", ",", "offset", "=", "0", ")", "uniform", "atomic_uint", v.name, ";"]
        if q == "block":
            return ["layout", "(", "std140", ")", "uniform", "Block", "{", v.type.name(), v.name, *dims, ";", "}", ";"]
        if q == "out" and self.program.stage != "fragment":
            return ["flat", "out", *highp, v.type.name(), v.name, ";"]
        if q == "out" and self.dialect.locations:
            return ["layout", "(", "location", "=", str(location), ")", "out", v.type.name(), v.name, ";"]
        init = ["=", *self.kid(v.initializer, 1)] if v.initializer is not None else []
        return [*([q] if q else []), *self.qualified(v.type), v.name, *dims, *init, ";"]

    def function(self, f: Function, mark: bool) -> list:
        params: list[str] = []
        for i, p in enumerate(f.params):
            params += [","] if i else []
            params += p.qualifier.split() + self.qualified(p.type) + ([p.name] if p.name else [])
            params += [t for n in p.type.dims for t in ("[", str(n), "]")]
        dims = [t for n in f.type.dims for t in ("[", str(n), "]")]
        of = ["subroutine", "(", f.subroutine.type_name, ")"] if f.subroutine and f.subroutine.call is not f else []
        return [*of, f.type.name(), *dims, *([Mark(f)] if mark else []), f.name, "(", *params, ")"]

    def write(self) -> str:
        tokens: list = []
        for struct in self.program.structs:
            tokens += ["struct", struct.name, "{"]
            for name, member in struct.members:
                tokens += self.qualified(member) + [name, *(t for n in member.dims for t in ("[", str(n), "]")), ";"]
            tokens += ["}", ";"]
        cells = [v for v in self.program.globals if v.qualifier == "storage"]
        if cells:
            tokens += ["layout", "(", "std430", ",", "binding", "=", "0", ")", "buffer", "Cells", "{"]
            for v in cells:
                tokens += [v.type.name(), v.name, *(t for n in v.type.dims for t in ("[", str(n), "]")), ";"]
            tokens += ["}", ";"]
        for one in self.program.subroutines:
            f = one.call
            params = [t for i, p in enumerate(f.params)
                      for t in [*([","] if i else []), *p.qualifier.split(), p.type.name(), p.name]]
            tokens += ["subroutine", f.type.name(), one.type_name, "(", *params, ")", ";"]
        for f in self.program.functions:
            if f.prototype:
                tokens += self.function(f, False) + [";"]
        location = 0
        for x in self.program.declarations:
            if isinstance(x, Variable):
                tokens += self.global_(x, location)
                location += x.qualifier == "out"
            elif isinstance(x, Subroutine):
                tokens += ["subroutine", "uniform", x.type_name, x.name, ";"]
            else:
                tokens += self.function(x, True) + ["{"]
                for one in x.body:
                    tokens += self.statement(one)
                tokens += ["}"]
        return "\n".join(self.header()) + "\n" + self.layout(tokens, len(self.header()) + 1)

    # ---- layout -------------------------------------------------------------------------------------------------

    def layout(self, tokens: list, first_line: int) -> str:
        text: list[str] = []
        line, column, indent, depth = first_line, 1, 0, 0
        marks: list[Mark] = []
        before = ""

        def put(piece: str) -> None:
            nonlocal line, column
            text.append(piece)
            newlines = piece.count("\n")
            line += newlines
            column = len(piece) - piece.rfind("\n") if newlines else column + len(piece)

        for token in tokens:
            if isinstance(token, Mark):
                marks.append(token)
                continue
            if token == "}":
                indent -= 1
            put(self.gap(before, token, depth, indent))
            for mark in marks:
                mark.of.line, mark.of.column = line, column
            marks = []
            put(token)
            depth += (token == "(") - (token == ")")
            indent += token == "{"
            before = token
        return "".join(text) + "\n"

    def gap(self, before: str, token: str, depth: int, indent: int) -> str:
        r = self.random
        word = lambda t: t[-1:].isalnum() or t[-1:] == "_"
        first = lambda t: t[0].isalnum() or t[0] == "_" or t[0] == "." and before[0].isdigit()
        glued = not before or not (word(before) and first(token) or
                                   before[-1] in "+-*/<>=!&|^%" and token[0] in "+-*/<>=!&|^%")
        if self.odd:
            x = r.random()
            if x < 0.06:
                return r.choice(["\n", "\n\n  ", " /* ; } */ ", " // x = 1; {\n", "\t", " \t ", " /**/"])
            if x < 0.3 and glued and before not in (";", "{", "}"):
                return ""
            if x < 0.5 and before in (";", "{", "}"):
                return " "
        if depth == 0 and before in (";", "{", "}", ":") and token not in (";", ","):
            return "\n" + "  " * indent
        if not before or token in (";", ",", ")", "]", ".", "++", "--", "[") or before in ("(", "[", ".", "!", "~"):
            return "" if glued else " "
        if token == "(" and (word(before) and before not in ("if", "for", "while", "switch", "return")):
            return ""
        return " "
