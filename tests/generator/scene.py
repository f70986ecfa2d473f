"""A program as files that generator-draw takes, and what it must draw."""

from __future__ import annotations

import struct
from pathlib import Path

from dialect import Dialect
from interpret import Interpreter, Pixel
from stages import STAGES, companions
from text import Writer
from tree import Program


def describe(program: Program, dialect: Dialect) -> str:
    shows = program.stage == "fragment"
    lines = ["call " + STAGES[program.stage].call, "context " + ("es" if dialect.es else "core" if dialect.core else "compatibility"),
             f"size {program.width} {program.height}"]
    for v in program.outputs:
        if v.name == "gl_FragDepth":
            lines.append("depth")
        elif v.type.dims:
            lines += ["target float"] * v.type.dims[0]
        else:
            lines.append(f"target {v.type.base}")
    if not program.outputs and program.stage != "compute":
        lines.append("target float")
    if not dialect.locations:
        names = [v.name if shows else "shown_" + v.name for v in program.outputs if v.storage == "out"]
        lines += [f"out {name} {n}" for n, name in enumerate(names)]
    for v in program.globals:
        values = " ".join(str(float(one)) if v.type.base == "float" else str(int(one)) for one in v.value or [])
        if v.qualifier == "uniform":
            kind = {"float": "f", "uint": "u"}.get(v.type.base, "i")
            lines.append(f"uniform {v.name} {kind} {v.type.rows} {values}")
        if v.qualifier == "block":
            lines.append(f"block Block {values}")
        if v.qualifier in ("image", "counter"):
            lines.append(v.qualifier)
        if v.qualifier == "texture":
            lines.append(f"texture {v.name} {v.type.base}")
    lines += [f"subroutine {one.name} {one.call.picked.name}" for one in program.subroutines]
    cells = sum(v.type.words() for v in program.globals if v.qualifier == "storage")
    return "\n".join(lines + ([f"storage {cells}"] if cells else [])) + "\n"


def write(program: Program, dialect: Dialect, folder: Path) -> list[str]:
    """Arguments of generator-draw."""
    folder.mkdir(parents=True, exist_ok=True)
    texts = {"scene.txt": describe(program, dialect), STAGES[program.stage].file: Writer(program, dialect).write(),
             **companions(program.stage, dialect, program.outputs)}
    for name, text in texts.items():
        (folder / name).write_text(text)
    return [str(folder / name) for name in texts]


def word(value, base: str) -> int:
    if base == "float":
        return struct.unpack("I", struct.pack("f", value))[0]
    return int(value) & 0xffffffff


def expected(program: Program, interpreter: Interpreter, pixels: list[Pixel]) -> dict[str, list]:
    """What RESULT must hold after all pixels; None for what GLSL leaves open."""
    result: dict[str, list] = {}
    location = 0
    for v in program.outputs:
        if v.name == "gl_FragDepth":
            if not program.es:
                result["depth"] = [word(1.0 if p.nothing else p.outputs[v][0], "float") for p in pixels]
            continue
        for n in range(v.type.dims[0] if v.type.dims else 1):
            words = []
            for p in pixels:
                values = p.outputs.get(v, [None] * v.type.words())[4 * n:4 * n + 4]
                words += [0 if p.nothing else None if one is None else word(one, v.type.base) for one in values]
            result[f"target {location}"] = words
            location += 1
    if interpreter.memory:
        result["storage"] = [word(one, "int") for cells in interpreter.memory.values() for one in cells]
    if any(v.storage == "counter" for v in program.globals):
        result["counter"] = [interpreter.counted]
    if any(v.storage == "image" for v in program.globals):
        result["image"] = [word(one, "int") for one in interpreter.picture]
    return result


def read_result(path: Path) -> dict[str, list[int]]:
    result = {}
    for line in path.read_text().splitlines() if path.exists() else []:
        words = line.split()
        head = 2 if words[0] == "target" else 1
        result[" ".join(words[:head])] = [int(one, 16) for one in words[head:]]
    return result


def differences(truth: dict[str, list], found: dict[str, list[int]]) -> list[str]:
    problems = []
    for name, words in truth.items():
        got = found.get(name, [])
        if len(got) != len(words):
            problems.append(f"{name}: {len(got)} words instead of {len(words)}")
            continue
        wrong = [i for i, (a, b) in enumerate(zip(words, got)) if a is not None and a != b]
        if wrong:
            i = wrong[0]
            problems.append(f"{name}: {len(wrong)} of {len(words)} words wrong; word {i} is {got[i]:x}, must be {words[i]:x}")
    return problems
