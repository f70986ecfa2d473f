#!/usr/bin/env python3
"""Runs piglit's OpenGL tests bare and under shadestep in turn, and compares what they say: every test and every subtest.

    scripts/transparency [PATTERN...] [--sample N] [--seed N] [--minutes M] [--every-draw] [--jobs 2] [--out DIR]
                         [--no-idle] [--resume] [--without PATTERN]...

PATTERN, and of those that are left out: of names as piglit gives them (spec@arb_draw_instanced@*), and for shader tests of their paths
(tests/spec/glsl-1.30/*). Default: all of tests/spec; --generated: the generated shader tests too. --every-draw also runs each test with one
capture at every draw, --no-idle then leaves out the run without captures. Tests come in an order that --seed chooses, the same share of every directory at any time, so that
--sample and --minutes cut off a fair part. What differs is run again, as often as bare: a test that does not say the same each
time proves nothing, and is listed as unsteady; one that takes longer than --timeout tells nothing, and is counted apart.
--resume goes on where a run with the same build, --out and seed was cut off.
Writes results.jsonl and table.md to --out (build/transparency), and prints the table. Exit status: 0 if nothing differs, 1 if something
does, 77 if piglit or Xvfb is not installed.
"""

from __future__ import annotations

import argparse
import ast
import collections
import concurrent.futures
import contextlib
import fnmatch
import gzip
import json
import os
import random
import shutil
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import piglit

REPOSITORY = Path(__file__).resolve().parent.parent.parent
AGAIN = 2  # more runs of what differs, and of the bare test
KINDS = {"idle": [], "every draw": ["--every-draw"]}  # options of `shadestep run`


def compiled_tests(root: Path) -> dict[str, list[str]]:
    """Name -> command of the tests that are programs of their own."""
    found = {}
    for test in ElementTree.fromstring(gzip.open(root / "tests" / "opengl.xml.gz").read()).iter("Test"):
        if test.get("type") != "gl" or not test.get("name").startswith("spec@"):
            continue
        options = {o.get("name"): o.get("value") for o in test.iter("option")}
        program, *arguments = ast.literal_eval(options["command"])
        if (root / "bin" / program).exists():
            concurrent = ["-fbo"] if options.get("run_concurrent") == "True" else []
            found[test.get("name")] = [str(root / "bin" / program), *arguments, "-auto", *concurrent]
    return found


def shader_tests(root: Path, folders: list[str]) -> dict[str, list[str]]:
    """Path -> command of the tests that are text."""
    paths = [p for folder in folders for p in (root / folder / "spec").rglob("*.shader_test")]
    return {str(p.relative_to(root)): piglit.command(root, str(p)) for p in paths}


def directory(name: str) -> str:
    return name.split("@")[1] if "@" in name else piglit.directory(name)


def fair_order(names: list[str], seed: int) -> list[str]:
    """Shuffled so that any beginning holds about the same share of every directory."""
    by_directory = collections.defaultdict(list)
    for name in sorted(names):
        by_directory[directory(name)].append(name)
    chance = random.Random(seed)
    keyed = []
    for group in by_directory.values():
        chance.shuffle(group)
        keyed += [((i + chance.random()) / len(group), name) for i, name in enumerate(group)]
    return [name for _, name in sorted(keyed)]


@contextlib.contextmanager
def x_server():
    """The environment of a virtual X server of our own."""
    reading, writing = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-screen", "0", "1024x768x24", "-noreset"], pass_fds=[writing],
                              stderr=subprocess.DEVNULL)
    os.close(writing)
    with os.fdopen(reading) as display:
        number = display.readline().strip()
    try:
        yield {"DISPLAY": f":{number}", "PIGLIT_PLATFORM": "mixed_glx_egl"}
    finally:
        server.terminate()
        server.wait()


def kinds(options: argparse.Namespace) -> list[str]:
    return ["idle"] * (not options.no_idle) + ["every draw"] * options.every_draw


def verdict(said: dict) -> tuple:
    """What counts of what a test says."""
    return said["result"], said.get("subtest", {})


class Runner:
    def __init__(self, root: Path, environment: dict[str, str], options: argparse.Namespace) -> None:
        self.root = root
        self.environment = os.environ | environment | {"PIGLIT_SOURCE_DIR": str(root)}
        self.seconds = options.timeout
        self.shadestep = str(options.shadestep)
        self.kinds = kinds(options)

    def said(self, command: list[str]) -> dict:
        """What the test says: its result, and those of its subtests."""
        with subprocess.Popen(command, env=self.environment, cwd=self.root, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, errors="replace", start_new_session=True) as process:
            try:
                out, _ = process.communicate(timeout=self.seconds)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, 9)
                process.communicate()
                return {"result": "timeout"}
        verdict: dict = {"said": out[-400:]}
        for line in out.splitlines():
            if line.startswith("PIGLIT: {"):
                with contextlib.suppress(json.JSONDecodeError):
                    for key, value in json.loads(line.removeprefix("PIGLIT: ")).items():
                        verdict[key] = verdict.get(key, {}) | value if isinstance(value, dict) else value
        if "result" not in verdict:
            verdict["result"] = "crash" if process.returncode else "nothing"
        return verdict

    def check(self, name: str, command: list[str]) -> dict:
        start = time.monotonic()
        runs = {"bare": command} | {kind: [self.shadestep, "run", *KINDS[kind], "--quiet", "--", *command] for kind in self.kinds}
        entry = {"test": name, "directory": directory(name), "command": command}
        entry["said"] = said = {kind: self.said(line) for kind, line in runs.items()}
        late = [kind for kind in runs if said[kind]["result"] == "timeout"]
        differs = [kind for kind in runs if kind not in late and verdict(said[kind]) != verdict(said["bare"])]
        differs = [] if "bare" in late else differs
        unsteady = set()
        if differs:
            for kind in ["bare", *differs]:
                entry[f"{kind} again"] = again = [self.said(runs[kind]) for _ in range(AGAIN)]
                unsteady |= {kind} if any(verdict(one) != verdict(said[kind]) for one in again) else set()
        entry["differs"] = [] if "bare" in unsteady else [kind for kind in differs if kind not in unsteady]
        entry["unsteady"] = sorted(unsteady)
        entry["late"] = late
        entry["seconds"] = round(time.monotonic() - start, 2)
        return entry


def matches(name: str, patterns: list[str]) -> bool:
    return any(fnmatch.fnmatch(name, pattern) for pattern in patterns)


def table(entries: list[dict], kinds: list[str]) -> str:
    header = ["directory", "tests", "skipped by the driver", "unsteady"]
    header += [f"{kind}: {what}" for kind in kinds for what in ("out of time", "differ")]
    rows: dict[str, collections.Counter] = collections.defaultdict(collections.Counter)
    for entry in entries:
        for name in (entry["directory"], "all"):
            row = rows[name]
            row["tests"] += 1
            row[header[2]] += entry["said"]["bare"].get("result") == "skip"
            row[header[3]] += bool(entry.get("unsteady"))
            for kind in kinds:
                row[f"{kind}: differ"] += kind in entry["differs"]
                row[f"{kind}: out of time"] += kind in entry["late"] or "bare" in entry["late"]
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    for name in sorted(rows, key=lambda one: (one == "all", one)):
        lines.append("| " + " | ".join([name] + [str(rows[name][column]) for column in header[1:]]) + " |")
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("patterns", nargs="*", metavar="PATTERN")
    parser.add_argument("--without", action="append", default=[], metavar="PATTERN")
    parser.add_argument("--sample", type=int, help="only N of them")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, help="begin no test after this time")
    parser.add_argument("--every-draw", action="store_true")
    parser.add_argument("--no-idle", action="store_true")
    parser.add_argument("--generated", action="store_true")
    parser.add_argument("--resume", action="store_true")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--timeout", type=float, default=60, help="seconds for one run of one test")
    parser.add_argument("--shadestep", type=Path, default=REPOSITORY / "build" / "release" / "bin" / "shadestep")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / "transparency")
    options = parser.parse_args()

    if options.no_idle and not options.every_draw:
        parser.error("--no-idle leaves nothing to run without --every-draw")

    root = piglit.root()
    if root is None or shutil.which("Xvfb") is None:
        print(f"transparency: skipped: {piglit.HOW_TO_GET_IT if root is None else 'Xvfb is not installed'}", file=sys.stderr)
        return 77
    tests = compiled_tests(root) | shader_tests(root, ["tests"] + ["generated_tests"] * options.generated)
    names = [n for n in tests if matches(n, options.patterns or ["*"]) and not matches(n, options.without)]
    names = fair_order(names, options.seed)[: options.sample]
    if not names or not options.shadestep.exists():
        print("transparency: " + ("no test matches" if options.shadestep.exists() else f"no {options.shadestep}; build first"),
              file=sys.stderr)
        return 2

    start = time.monotonic()
    options.out.mkdir(parents=True, exist_ok=True)
    results_file = options.out / "results.jsonl"
    entries = [json.loads(line) for line in open(results_file)] if options.resume and results_file.exists() else []
    done = {entry["test"] for entry in entries}
    names = [name for name in names if name not in done]
    with x_server() as environment, open(results_file, "a" if options.resume else "w") as results:
        runner = Runner(root, environment, options)

        def begin(name: str) -> dict | None:
            late = options.minutes and time.monotonic() - start > 60 * options.minutes
            return None if late else runner.check(name, tests[name])

        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            for entry in filter(None, pool.map(begin, names)):
                results.write(json.dumps(entry) + "\n")
                results.flush()
                entries.append(entry)
                if entry["differs"]:
                    said = ", ".join(f"{kind} {entry['said'][kind]['result']}" for kind in ["bare", *entry["differs"]])
                    print(f"{entry['test']}: {said}\n  {' '.join(entry['command'])}", flush=True)
    text = table(entries, kinds(options))
    (options.out / "table.md").write_text(text)
    print(f"{text}\n{len(entries)} of {len(tests)} tests, seed {options.seed}, {time.monotonic() - start:.0f} s")
    return 1 if any(entry["differs"] for entry in entries) else 0


if __name__ == "__main__":
    sys.exit(main())
