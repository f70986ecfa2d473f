"""What each stage's shaders need: where their threads are, what runs them, and how the debugger names a thread.

A program has width x height threads. What stages before the fragment stage hand on is drawn as one point for each thread, on
the pixel of its number; where a stage hands nothing on (tess-control, compute), only memory tells what its threads did.
"""

from __future__ import annotations

from dataclasses import dataclass

from dialect import Dialect


@dataclass(frozen=True)
class Stage:
    file: str
    call: str  # of scene.txt: what runs it
    size: tuple[int, int] = (8, 4)  # powers of two: places are computed exactly
    number: str = ""  # of the thread, in its own words; "" where its place is given otherwise
    layout: str = ""
    least: int = 110  # version of GLSL that has it; without ES where it is no stage of ES 3.10
    es: bool = True
    memory_only: bool = False

    def runs(self, dialect: Dialect) -> bool:
        return (self.es if dialect.es else dialect.version >= self.least) and (not self.memory_only or dialect.memory)


STAGES = {
    "fragment": Stage("shader.frag", "triangle", (6, 5)),
    "vertex": Stage("shader.vert", "points"),
    "tess-control": Stage("shader.tesc", "patches 4", number="(gl_PrimitiveID * 4 + gl_InvocationID)",
                          layout="layout(vertices = 4) out;", least=400, es=False, memory_only=True),
    # Two vertices a patch: u is 0, then 1.
    "tess-eval": Stage("shader.tese", "patches 2", number="(gl_PrimitiveID * 2 + int(gl_TessCoord.x))",
                       layout="layout(isolines, point_mode) in;", least=400, es=False),
    "geometry": Stage("shader.geom", "points", number="gl_PrimitiveIDIn",
                      layout="layout(points) in; layout(points, max_vertices = 1) out;", least=150, es=False),
    "compute": Stage("shader.comp", "dispatch", layout="layout(local_size_x = 4, local_size_y = 2) in;", memory_only=True),
}


def header(stage: str, dialect: Dialect) -> list[str]:
    """Lines that declare where the thread is: `place` (pixel centre in x and y) and `corner` (the same on the target)."""
    one = STAGES[stage]
    if stage == "fragment":
        return []
    if stage == "vertex":
        return [f"{'in' if dialect.integers else 'attribute'} vec4 place, corner;"]
    if stage == "compute":
        return [one.layout, "#define place (vec4(gl_GlobalInvocationID.xyxy) + 0.5)"]
    width, height = one.size
    return [one.layout,
            f"#define place (vec4(float({one.number} % {width}), float({one.number} / {width}), 0.0, 0.5) + 0.5)",
            f"#define corner vec4(place.xy * vec2({2 / width}, {2 / height}) - 1.0, 0.0, 1.0)"]


def selection(stage: str, x: int, y: int) -> list[str]:
    """The thread as the command line names it."""
    n = y * STAGES[stage].size[0] + x
    return {"fragment": ["--pixel", f"{x},{y}"], "vertex": ["--vertex", f"{n}"], "compute": ["--invocation", f"{x},{y},0"],
            "geometry": ["--primitive", f"{n}"],
            "tess-control": ["--primitive", f"{n // 4}", "--vertex", f"{n % 4}"],
            "tess-eval": ["--primitive", f"{n // 2}", "--vertex", f"{n % 2}"]}[stage]


def split_row(stage: str, dialect: Dialect, row: list[str]) -> tuple[str, list[str]]:
    """A row of a CSV: where its thread is, "x,y", and its values."""
    if stage in ("fragment", "compute"):
        return f"{row[0]},{row[1]}", row[2 if stage == "fragment" else 3:]
    first = int(row[0])
    if stage == "tess-control":
        columns, n = 2, first * 4 + int(row[1])
    elif stage == "tess-eval":
        columns, n = 3, first * 2 + int(float(row[1]))
    else:
        columns, n = 1 if stage == "geometry" and dialect.version < 400 else 2, first
    width = STAGES[stage].size[0]
    return f"{n % width},{n // width}", row[columns:]


def companions(stage: str, dialect: Dialect, outputs: list) -> dict[str, str]:
    """The other shaders that it takes to run one: file -> text. `outputs`: variables, as scene.py shows them."""
    texts = {}
    line = dialect.line()
    attribute = "in" if dialect.integers else "attribute"
    if stage == "fragment":
        texts["shader.vert"] = f"{line}\n{attribute} vec2 corner;\nvoid main() {{ gl_Position = vec4(corner, 0.0, 1.0); }}\n"
    elif stage not in ("vertex", "compute"):
        texts["shader.vert"] = f"{line}\nin vec4 corner;\nvoid main() {{ gl_Position = corner; }}\n"
    if stage == "tess-control":
        texts["shader.tese"] = f"{line}\n{STAGES['tess-eval'].layout}\nvoid main() {{ gl_Position = vec4(0.0, 0.0, 0.0, 1.0); }}\n"
    if stage not in ("fragment", "compute"):
        texts["shader.frag"] = shown(dialect, outputs)
    return texts


def shown(dialect: Dialect, outputs: list) -> str:
    """A fragment shader that draws what comes from the stage before it."""
    lines = [dialect.line()] + (["precision highp float;", "precision highp int;"] if dialect.es else [])
    if not dialect.integers:
        return "\n".join([*lines, "varying vec4 out_0;", "void main() { gl_FragColor = out_0; }", ""])
    for n, v in enumerate(outputs):
        where = f"layout(location = {n}) " if dialect.locations else ""
        highp = "highp " if dialect.es else ""
        lines += [f"flat in {highp}{v.type.name()} {v.name};", f"{where}out {highp}{v.type.name()} shown_{v.name};"]
    assignments = " ".join(f"shown_{v.name} = {v.name};" for v in outputs)
    return "\n".join([*lines, f"void main() {{ {assignments} }}", ""])
