"""One shader through everything: the driver alone, verify, recorded runs, a place for all threads, the loops."""

from __future__ import annotations

import csv
import json
import random
import re
import subprocess
from dataclasses import dataclass, field, replace
from pathlib import Path

import compare
import scene
import scopes
from dialect import Dialect
from interpret import Interpreter, Pixel, Undefined
from stages import STAGES, selection, split_row
from tree import Program, S, Variable


@dataclass
class Tools:
    shadestep: Path
    draw: Path
    timeout: float = 120


@dataclass
class Outcome:
    """`kind` is empty if all is well. "driver": the driver alone does not draw what GLSL says (or the generator errs)."""

    kind: str = ""
    problems: list[str] = field(default_factory=list)
    command: list[str] = field(default_factory=list)
    steps: int = 0
    values: int = 0
    zero_signs: int = 0


def run(command: list[str], timeout: float) -> tuple[int | None, str, str]:
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=timeout,
                              stdin=subprocess.DEVNULL)
        return done.returncode, done.stdout, done.stderr
    except subprocess.TimeoutExpired:
        return None, "", "ran out of time"


def number(cell: str) -> bool | int | float:
    if cell in ("true", "false"):
        return cell == "true"
    return int(cell) if cell.lstrip("-").isdigit() else float(cell)


def interpret(program: Program, record: set[tuple[int, int]]) -> tuple[Interpreter, list[Pixel]]:
    scopes.resolve(program)
    interpreter = Interpreter(program)
    pixels = [interpreter.run(x, y, (x, y) in record) for y in range(program.height) for x in range(program.width)]
    return interpreter, pixels


class Check:
    def __init__(self, program: Program, dialect: Dialect, folder: Path, tools: Tools, seed: str,
                 only: str | None = None):
        self.program, self.dialect, self.folder, self.tools = program, dialect, folder, tools
        self.random = random.Random(seed)
        self.only = only
        self.outcome = Outcome()

    def fail(self, kind: str, problems: list[str], command: list[str]) -> Outcome:
        self.outcome.kind, self.outcome.problems, self.outcome.command = kind, [one[:400] for one in problems[:4]], command
        return self.outcome

    def run(self) -> Outcome:
        """Throws Undefined or scopes.Invalid if the program is none to check."""
        width, height = self.program.width, self.program.height
        self.stage = [] if self.program.stage == "fragment" else ["--stage", self.program.stage]
        chosen = [(self.random.randrange(width), self.random.randrange(height)) for _ in range(2)]
        files = scene.write(self.program, self.dialect, self.folder)
        self.interpreter, self.pixels = interpret(self.program, set(chosen))
        self.draw = [str(self.tools.draw), *files]
        self.truth = scene.expected(self.program, self.interpreter, self.pixels)
        if self.bare():
            return self.outcome
        checks = {"verify": self.verify, "place": self.place, "loops": self.loops}
        for n, (x, y) in enumerate(chosen):
            checks[f"run {n}"] = lambda x=x, y=y, n=n: self.thread(x, y, f"run {n}")
        for name, check in checks.items():
            if self.only in (None, name) and check():
                return self.outcome
        return self.outcome

    def bare(self) -> bool:
        result = self.folder / "bare.txt"
        command = [*self.draw, str(result)]
        status, _, err = run(command, self.tools.timeout)
        if status != 0:
            return bool(self.fail("compile", [f"status {status}: {err.strip()}"], command))
        wrong = scene.differences(self.truth, scene.read_result(result))
        return bool(wrong and self.fail("driver", wrong, command))

    def verify(self) -> bool:
        result = self.folder / "verified.txt"
        command = [str(self.tools.shadestep), "verify", "--json", "--stage", self.program.stage, "--continue", "--pixels", "3", "--",
                   *self.draw, str(result)]
        result.unlink(missing_ok=True)
        status, out, err = run(command, self.tools.timeout)
        try:
            report = json.loads(out)
        except json.JSONDecodeError:
            return bool(self.fail("verify", [f"status {status}: {err.strip()[-600:]}"], command))
        self.outcome.values += report["values_compared"]
        problems = [f"{f['kind']}: line {f['line']}:{f['column']}, {f['plan']}, {f['variable']}: {f['detail']}"
                    for f in report["failures"] if not self.zero_sign(f)]
        problems += [f"skipped: {one['reason']}" for one in report["skipped"] if self.unexpected(one["reason"])]
        if report["analysis_failed"]:
            problems.append("cannot be analysed")
        if report["program_status"] != 0:
            problems.append(f"the program ends with status {report['program_status']}: {err.strip()[-300:]}")
        problems += ["left changed: " + one for one in scene.differences(self.truth, scene.read_result(result))]
        return bool(problems and self.fail("verify", problems, command))

    def zero_sign(self, failure: dict) -> bool:
        """0 and -0: which of them comes out is the driver's own affair."""
        if failure["kind"] != "value" or "-0" not in failure["detail"]:
            return False
        halves = failure["detail"].replace("(80000000", "(00000000").replace(" 80000000", " 00000000").split(", recorded ")
        words = [half[half.rfind("(") + 1:half.rfind(")")] for half in halves]
        self.outcome.zero_signs += len(words) == 2 and words[0] == words[1]
        return len(words) == 2 and words[0] == words[1]

    def unexpected(self, reason: str) -> bool:
        known = ["never defined differs", "no fragment of the draw is visible", "needs storage buffers", "time for one draw",
                 "a keyword, and the shader uses it", "which returns an array",
                 "does not fit into", "is larger than what this driver lets a pass capture"]
        return not any(one in reason for one in known)

    def thread(self, x: int, y: int, name: str) -> bool:
        pixel = self.pixels[y * self.program.width + x]
        thread = selection(self.program.stage, x, y)
        command = [str(self.tools.shadestep), "debug", "--json", *self.stage, *thread, "--", *self.draw]
        recorded = self.recorded()
        if not recorded and (pixel.discarded or len(pixel.steps) > 60):
            return False  # one redraw a step; a fragment that is not visible cannot be followed
        status, out, err = run(command, self.tools.timeout)
        if status != 0:
            return bool(self.fail(name, [f"status {status}: {err.strip()[-600:]}"], command))
        shown = json.loads(out)
        problems = []
        if not recorded:
            problems = self.without_recording(shown["steps"], pixel)
        else:
            problems = compare.steps(shown["steps"], pixel)
        # What depends on a uniform that the driver dropped is said to be uncertain.
        dropped = shown["check"].get("dropped") or ""
        uncertain = re.findall(r"'(\w+)'", dropped) if not dropped.endswith(" more") else [r"\w+"]
        uncertain = [f": {name} (=|is|has)" for name in uncertain] + [": returns "]
        problems = [one for one in problems if not dropped or not any(re.search(one_of, one) for one_of in uncertain)]
        if shown["check"]["outputs"] != "identical":
            problems.append(f"check: {shown['check']}")
        ended = "discarded" if pixel.discarded else "finished"
        if shown["outcome"] != ended:
            problems.append(f"{shown['outcome']} instead of {ended}")
        self.outcome.steps += len(shown["steps"])
        return bool(problems and self.fail(name, problems, command))

    def recorded(self) -> bool:
        """Not where there are no storage buffers, nor where their extension makes a keyword of a name."""
        words = set(re.findall(r"\w+", (self.folder / STAGES[self.program.stage].file).read_text()))
        names = {"buffer"} if self.dialect.version < 430 else set()
        return not (self.dialect.es and self.dialect.version < 310) and not (
            not self.dialect.es and words & (names | ({"layout"} if self.dialect.version < 140 else set())))

    def without_recording(self, shown: list[dict], pixel: Pixel) -> list[str]:
        """One redraw a step: what main does, without what it calls."""
        kinds = ("statement", "condition")
        own = [step for step in shown if step["depth"] == 0 and step["kind"] in kinds]
        truth = [step for step in pixel.steps if step.depth == 0 and step.kind in kinds]
        return compare.steps(own, replace(pixel, steps=truth), complete=False)

    def place(self) -> bool:
        """All threads at one place, the last time that they got there."""
        inside = [s for s in self.program.statements() if s.kind in ("expr", "decl", "if", "return") and s.visible
                  and s.line and not self.is_init(s)]
        if not inside:
            return False
        s: S = self.random.choice(inside)
        after = s.kind in ("expr", "decl") and self.random.random() < 0.5
        interpreter = Interpreter(self.program)
        interpreter.watched, interpreter.watched_after = (None, s) if after else (s, None)
        truth = {}
        names: dict[str, list] = {}
        for y in range(self.program.height):
            for x in range(self.program.width):
                interpreter.run(x, y, False)
                found = interpreter.at_watched
                if found is not None:
                    truth[f"{x},{y}"] = found
                    for name, (v, _) in found.items():
                        if not v.name.startswith("gl_") and v.type.words() <= 16 and self.used(v):
                            names[name] = v.type.bases()
        names = dict(self.random.sample(sorted(names.items()), min(len(names), 4)))
        names = {name: bases for name, bases in names.items() if all(name in one for one in truth.values())}
        if not names or not truth:
            return False
        values = self.folder / "values.csv"
        command = [str(self.tools.shadestep), "debug", "--at", f"{s.line}:{s.column}", *(["--after"] if after else []), *self.stage,
                   "--print", ",".join(names), "--csv", str(values.resolve()), "--json", "--", *self.draw]
        status, out, err = run(command, self.tools.timeout)
        if status != 0:
            return bool(self.fail("place", [f"status {status}: {err.strip()[-600:]}"], command))
        with open(values) as file:
            rows = list(csv.reader(file))[1:]
        shown = dict(split_row(self.program.stage, self.dialect, row) for row in rows)
        problems = []
        # What depends on a uniform that the driver dropped is said to be uncertain.
        dropped = json.loads(out)["check"].get("dropped") or ""
        uncertain = dropped.endswith(" more") or any(f"'{name}'" in dropped for name in names)
        if set(shown) != set(truth):
            problems.append(f"threads that get there: {len(shown)} instead of {len(truth)}, such as "
                            f"{sorted(set(shown) ^ set(truth))[0]}")
        # What no thread has written on the way to the place has no column.
        unwritten = [name for name in names if "no_value" in json.loads(out)["values"][name]]
        for name in unwritten:
            if not uncertain and any(word is not None for one in truth.values() for word in one[name][1]):
                problems.append(f"{name} is said to have no value, must be {next(iter(truth.values()))[name][1]}")
        for thread in sorted(set(shown) & set(truth)):
            cells = shown[thread]
            right = [one for name in names if name not in unwritten for one in truth[thread][name][1]]
            got = [number(cell) for cell in cells]
            if not uncertain and not compare.same(right, got):
                problems.append(f"thread {thread}: {', '.join(names)} = {cells}, must be {right}")
        self.outcome.values += len(shown) * len(names)
        return bool(problems and self.fail("place", problems, command))

    def used(self, v: Variable) -> bool:
        """What lies outside of the shader can be looked at only where the shader names it."""
        if v.storage in ("local", "parameter", "global", "constant"):
            return True
        own = [e for s in self.program.statements() for one in s.exprs if one is not None for e in one.walk()]
        return any(e.kind == "var" and e.data.name == v.name.split("[")[0] and e.data.storage == v.storage for e in own)

    def is_init(self, s: S) -> bool:
        return any(one.kind == "for" and one.body[0] is s for one in self.program.statements())

    def loops(self) -> bool:
        if not any(s.kind in ("for", "while", "do") for s in self.program.statements()):
            return False
        command = [str(self.tools.shadestep), "loops", "--json", *self.stage, "--", *self.draw]
        status, out, err = run(command, self.tools.timeout)
        if status != 0:
            return bool(self.fail("loops", [f"status {status}: {err.strip()[-600:]}"], command))
        problems = compare.loops(json.loads(out)["loops"], self.pixels)
        return bool(problems and self.fail("loops", problems, command))
