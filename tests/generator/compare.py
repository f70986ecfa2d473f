"""What the debugger shows of a thread's run, held against the interpreter's."""

from __future__ import annotations

from interpret import Pixel, Step
from tree import Function, Type, Variable

WIDEST = 64  # words: wider values are left out of recordings (instrumenter.h)
MOST = 8  # problems that are worth reading


def flat(value) -> list:
    if isinstance(value, dict):
        return [one for member in value.values() for one in flat(member)]
    if isinstance(value, list):
        return [one for element in value for one in flat(element)]
    return [value]


def same(truth: list, shown: list) -> bool:
    """None in the truth is anything. A zero's sign is the driver's own affair."""
    return len(truth) == len(shown) and all(a is None or (a == b and isinstance(a, bool) == isinstance(b, bool))
                                            for a, b in zip(truth, shown))


def too_wide(t: Type) -> bool:
    return sum(2 if base == "double" or base.endswith("64") else 1 for base in t.bases()) > WIDEST


def whole_declarations(shown: list[dict]) -> list[dict]:
    """The steps of a declaration's single names go into the one that ends it; what comes between sees them as `before`."""
    whole: list[dict] = []
    open_at: dict[int, dict] = {}  # depth -> what the names so far have changed
    for step in shown:
        if step["kind"] == "declarator":
            open_at.setdefault(step["depth"], {}).update(step["changed"])
        elif step["kind"] == "statement" and step["depth"] in open_at:
            whole.append(step | {"changed": open_at.pop(step["depth"]) | step["changed"]})
        else:
            before = {name: one for changed in open_at.values() for name, one in changed.items()}
            whole.append(step | {"before": before} if before else step)
            for changed in open_at.values():  # newer values than those
                for name, one in step["changed"].items():
                    if name in changed and changed[name]["type"] == one["type"]:  # else another variable's
                        del changed[name]
    return whole


def calls_nothing(steps: list[Step], n: int) -> bool:
    """A call that literals keep from being made may be announced or not."""
    return steps[n].kind == "call" and (n + 1 == len(steps) or steps[n + 1].kind != "enter")


def steps(shown: list[dict], pixel: Pixel, complete: bool = True) -> list[str]:
    """Every step: its place, what it is, which way it went, every value that changed, and that none is missing (unless
    the steps are not complete)."""
    problems: list[str] = []
    view: list[dict[Variable, list]] = [{}, {}]  # globals, then a dictionary a call
    initial = dict(pixel.initial)
    shown = whole_declarations(shown)
    for n, truth in enumerate(pixel.steps):
        if calls_nothing(pixel.steps, n) and (n >= len(shown) or shown[n]["kind"] != "call"):
            shown.insert(n, {"line": truth.at.line, "column": truth.at.column, "function": truth.function,
                             "kind": "call", "depth": truth.depth, "iteration": truth.iteration, "changed": {}})
        if len(problems) >= MOST:
            break
        if n >= len(shown):
            problems.append(f"step {n}: the run ends, instead of {describe(truth)}")
            break
        step = shown[n]
        outcome = {"outcome": truth.outcome} if truth.outcome is not None else {}
        wanted = {"line": truth.at.line, "column": truth.at.column, "function": truth.function, "kind": truth.kind,
                  "depth": truth.depth, "iteration": truth.iteration} | outcome
        wrong = [f"{key} {step.get(key)} instead of {value}" for key, value in wanted.items() if step.get(key) != value]
        if wrong:
            problems.append(f"step {n}, {describe(truth)}: " + ", ".join(wrong))
            if any(key in wrong[0] for key in ("line", "kind", "depth")):
                break
        if truth.kind == "enter":
            del view[truth.depth + 1:]
            view.append({})
        changed = {name: one for name, one in step.get("before", {}).items()
                   if name in truth.values and truth.values[name][0].storage not in ("local", "parameter")
                   and truth.values[name][0].type.spelled() == one["type"].replace(" ", "")}  # else a local of that name
        problems += [f"step {n}, {describe(truth)}: {one}"
                     for one in values(changed | step["changed"], truth, view, initial, complete)]
    else:
        if len(shown) > len(pixel.steps):
            problems.append(f"{len(shown)} steps instead of {len(pixel.steps)}")
    return problems


def describe(step: Step) -> str:
    return f"{step.kind} at {step.at.line}:{step.at.column} in {step.function}"


def values(changed: dict, truth: Step, view: list[dict], initial: dict, complete: bool) -> list[str]:
    problems = []
    # What changes where an inner name hides it is unknown until it is shown again.
    for v in [v for v in view[0] if truth.hidden.get(v) not in (None, view[0][v])]:
        del view[0][v]
        initial.pop(v, None)
    for name, one in changed.items():
        got = flat(one["value"])
        if name == "return" and truth.returned is not None and name not in truth.values:
            if not same(truth.returned[1], got):
                problems.append(f"returns {got}, must return {truth.returned[1]}")
            continue
        if name.startswith("gl_"):
            continue
        name = name.split("[")[0] if name.startswith("picture[") else name  # the thread's own texel
        if name not in truth.values:
            if not (name == "return" and truth.returned is not None):
                problems.append(f"{name} is shown, and means nothing here")
            continue
        v, right = truth.values[name]
        if one["type"].replace(" ", "") != v.type.spelled():
            problems.append(f"{name} is {one['type']}, must be {v.type.spelled()}")
        if not same(right, got):
            problems.append(f"{name} = {got}, must be {right}")
        slot(v, truth, view)[v] = got
    for name, (v, right) in truth.values.items() if complete else ():
        if too_wide(v.type) or v.name.startswith("gl_") or v.storage in ("condition", "buffer"):
            continue
        known = slot(v, truth, view).get(v)
        if known is not None:
            if not same(right, known):
                problems.append(f"{name} is {right} now, which is not shown (last shown: {known})")
                slot(v, truth, view)[v] = right
        elif v.storage in ("local", "parameter"):
            if any(one is not None for one in right):
                problems.append(f"{name} = {right} is never shown")
                slot(v, truth, view)[v] = right
        elif v not in view[0] and right != initial.get(v, right):
            problems.append(f"{name} has changed to {right}, which is not shown")
            slot(v, truth, view)[v] = right
    return problems


def slot(v: Variable, truth: Step, view: list[dict]) -> dict:
    return view[truth.depth + 1] if v.storage in ("local", "parameter") else view[0]


def loops(shown: list[dict], pixels: list[Pixel]) -> list[str]:
    """Iterations of all threads, those that end in a discard included."""
    problems = []
    alive = pixels
    by_place: dict[tuple, list] = {}
    for p in alive:
        for s, counts in p.loops.items():
            by_place.setdefault((s.line, s.column), []).append(counts)
    by_line: dict[int, list] = {}
    for (line, _), counts in sorted(by_place.items()):
        by_line.setdefault(line, []).append(counts)
    for line, found in by_line.items():
        entries = [one for one in shown if one["line"] == line and one["threads"] > 0]
        if len(entries) != len(found):
            problems.append(f"line {line}: {len(entries)} loops instead of {len(found)}")
            continue
        for one, counts in zip(entries, found):
            longest = [max(c) for c in counts]
            active = [sum(1 for n in longest if n > i) for i in range(max(longest))]
            sums = [sum(c) for c in counts]
            truth = {"threads": len(counts), "active": active, "max": max(sums)}
            wrong = [f"{key} {one[key]} instead of {value}" for key, value in truth.items() if one[key] != value]
            if wrong:
                problems.append(f"loop at line {line}: " + ", ".join(wrong))
    return problems
