"""Shaders as trees: what the generator makes, the interpreter runs and the reducer makes smaller.

A value is the flat list of its components in canonical order: array elements, columns, rows, members in order. A
component that the shader has not given a value is None.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Iterator


@dataclass(frozen=True)
class Struct:
    name: str
    members: tuple[tuple[str, "Type"], ...]


@dataclass(frozen=True)
class Type:
    base: str  # int uint int64 uint64 bool float double void struct
    rows: int = 1
    cols: int = 1  # more than 1: a matrix
    dims: tuple[int, ...] = ()  # outermost first
    struct: Struct | None = None

    def name(self) -> str:
        """Without the array's dimensions."""
        if self.struct:
            return self.struct.name
        prefix = {"int": "i", "uint": "u", "int64": "i64", "uint64": "u64", "bool": "b", "double": "d", "float": ""}.get(
            self.base, "")
        if self.cols > 1:
            size = f"{self.cols}" if self.cols == self.rows else f"{self.cols}x{self.rows}"
            return f"{prefix}mat{size}"
        scalar = self.base + "_t" if self.base.endswith("64") else self.base
        return f"{prefix}vec{self.rows}" if self.rows > 1 else scalar

    def spelled(self) -> str:
        return self.name() + "".join(f"[{n}]" for n in self.dims)

    def words(self) -> int:
        """Components, not words of 32 bits: a double is one."""
        if self.dims:
            return self.dims[0] * self.element().words()
        if self.struct:
            return sum(member.words() for _, member in self.struct.members)
        return 0 if self.base == "void" else self.rows * self.cols

    def element(self) -> "Type":
        """Of an array, a matrix or a vector."""
        if self.dims:
            return Type(self.base, self.rows, self.cols, self.dims[1:], self.struct)
        return Type(self.base, self.rows) if self.cols > 1 else Type(self.base)

    def length(self) -> int:
        return self.dims[0] if self.dims else self.cols if self.cols > 1 else self.rows

    def scalar(self) -> "Type":
        return Type(self.base)

    def is_scalar(self) -> bool:
        return not self.dims and not self.struct and self.rows == 1 and self.cols == 1

    def is_vector(self) -> bool:
        return not self.dims and not self.struct and self.rows > 1 and self.cols == 1

    def is_matrix(self) -> bool:
        return not self.dims and self.cols > 1

    def bases(self) -> list[str]:
        """Of each component."""
        if self.dims:
            return self.element().bases() * self.dims[0]
        if self.struct:
            return [base for _, member in self.struct.members for base in member.bases()]
        return [self.base] * self.words()


INT, UINT, BOOL, FLOAT, DOUBLE, VOID = (Type(b) for b in ("int", "uint", "bool", "float", "double", "void"))
INT64, UINT64 = Type("int64"), Type("uint64")


def vec(base: str, n: int) -> Type:
    return Type(base, n)


class Variable:
    """`range`: the values that its components keep to (None: any integer); floats at rest are multiples of 1/4."""

    def __init__(self, name: str, type_: Type, storage: str = "local", range_: Any = None, writable: bool = True):
        self.name, self.type, self.storage, self.range, self.writable = name, type_, storage, range_, writable
        self.ready = True  # has a value; the generator makes nothing of it before
        self.qualifier = ""  # as written before its type
        self.initializer: E | None = None  # of a global
        self.value: list | None = None  # of a uniform or an input

    def __repr__(self) -> str:
        return self.name


class E:
    """An expression. `data` is the operator, the variable, the name, ..., by kind."""

    def __init__(self, kind: str, type_: Type, args: list["E"] | None = None, data: Any = None, range_: Any = None,
                 frac: int = 0):
        self.kind, self.type, self.args, self.data = kind, type_, args or [], data
        self.range, self.frac = range_, frac
        self.reads: frozenset = frozenset().union(*(a.reads for a in self.args)) if self.args else frozenset()
        self.writes: frozenset = frozenset().union(*(a.writes for a in self.args)) if self.args else frozenset()

    def walk(self) -> Iterator["E"]:
        yield self
        for arg in self.args:
            yield from arg.walk()


class S:
    """A statement. `exprs`: its own expressions (some None); `body`: the statements in it."""

    def __init__(self, kind: str, exprs: list | None = None, body: list["S"] | None = None, data: Any = None):
        self.kind, self.exprs, self.body, self.data = kind, exprs or [], body or [], data
        self.line = self.column = 0  # of its first token, once written
        self.visible: dict[str, Variable] = {}  # before it
        self.visible_after: dict[str, Variable] = {}  # after it, or after its condition

    def walk(self) -> Iterator["S"]:
        yield self
        for one in self.body:
            yield from one.walk()

    def calls(self) -> bool:
        """Does it call user functions in its own expressions?"""
        own = [e for e in self.exprs if e is not None]
        return any(e.kind == "call" for one in own for e in one.walk())


@dataclass(eq=False)
class Function:
    name: str
    type: Type
    params: list[Variable]  # qualifier: "", "in", "const in", "out", "inout"; name "": unnamed
    body: list[S] = field(default_factory=list)
    range: Any = None
    reads: frozenset = frozenset()  # globals, calls included
    writes: frozenset = frozenset()
    discards: bool = False
    prototype: bool = False
    subroutine: "Subroutine | None" = None  # whose candidate it is
    picked: "Function | None" = None  # of what a subroutine uniform calls: the candidate that runs
    line: int = 0
    column: int = 0
    visible: dict = field(default_factory=dict)

    def out(self, i: int) -> bool:
        return "out" in self.params[i].qualifier


@dataclass(eq=False)
class Subroutine:
    """A subroutine uniform with its type."""

    type_name: str
    call: Function  # as it is called: its name is the uniform's
    candidates: list[Function]

    @property
    def name(self) -> str:
        return self.call.name


@dataclass
class Program:
    version: int
    es: bool
    width: int  # threads: pixels, a vertex for each pixel, or invocations of a dispatch
    height: int
    stage: str = "fragment"  # of stages.py
    structs: list[Struct] = field(default_factory=list)
    # Variable (outputs and uniforms too), Function and Subroutine, in the order of the text; the last is main
    declarations: list = field(default_factory=list)
    outputs: list[Variable] = field(default_factory=list)  # of the fragment, by location; built-in ones too
    layout_seed: int = 0  # 0: plain layout

    @property
    def globals(self) -> list[Variable]:
        return [one for one in self.declarations if isinstance(one, Variable)]

    @property
    def subroutines(self) -> list[Subroutine]:
        return [one for one in self.declarations if isinstance(one, Subroutine)]

    @property
    def functions(self) -> list[Function]:
        return [one for one in self.declarations if isinstance(one, Function)]

    def statements(self) -> Iterator[S]:
        for function in self.functions:
            for one in function.body:
                yield from one.walk()
