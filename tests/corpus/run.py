#!/usr/bin/env python3
"""Runs `shadestep verify` on piglit's shader tests and compares each test's own verdict with and without it.

    scripts/corpus [TEST...] [--list FILE] [--stage S] [--sample N] [--minutes M] [--jobs 2] [--timeout S] [--budget S]
                   [--out DIR]

TEST: paths below piglit's directory (tests/spec/..., generated_tests/spec/...), or patterns of such paths; a
directory stands for all .shader_test files below it: 'tests/spec/glsl-[1-4].[0-9]*' is what every version of GLSL has.
Default: the fixed list tests/corpus/list-300.txt. --stage vertex|tess-control|tess-eval|geometry|fragment|compute|all says
which shaders are looked at (default: fragment); of tests
that are given, those that draw or dispatch with such a shader in the file. Writes results.jsonl (a line a test, with every failure) and
table.md to --out (build/corpus), and prints the table. Exit status: 0 if nothing failed, 1 if something did,
77 if piglit is not installed.
"""

from __future__ import annotations

import argparse
import collections
import concurrent.futures
import fnmatch
import json
import random
import re
import subprocess
import sys
import time
from pathlib import Path

import piglit

FOLDER = Path(__file__).resolve().parent
REPOSITORY = FOLDER.parent.parent
SECTIONS = {"vertex": "vertex", "tess-control": "tessellation control", "tess-eval": "tessellation evaluation",
            "geometry": "geometry", "compute": "compute"}
FAILURES = ("compile_failed", "output_mismatch", "value_mismatch", "state_leaks", "crashes", "unsteady",
            "timeouts")


def check(test: str, root: Path, options: argparse.Namespace) -> dict:
    """One test: bare, then under verify."""
    start = time.monotonic()
    command = piglit.command(root, test)
    entry: dict = {"test": test, "directory": piglit.directory(test)}
    status, out, err = piglit.run(command, options.timeout)
    entry["bare"] = "timeout" if status is None else piglit.result(out + err)
    if entry["bare"] not in ("skip", "timeout"):
        stage = [] if options.stage == "all" else ["--stage", options.stage]
        verify = [str(options.shadestep), "verify", "--json", "--continue", "--quiet", *stage,
                  "--budget", str(options.budget), "--timeout", str(int(options.timeout)), "--", *command]
        status, out, err = piglit.run(verify, options.timeout + 20)
        entry["verified"] = "timeout" if status is None else piglit.result(err)
        entry["status"] = status
        try:
            entry["report"] = json.loads(out)
        except json.JSONDecodeError:
            entry["report"] = None
            entry["message"] = err.strip().splitlines()[-1:]
    entry["seconds"] = round(time.monotonic() - start, 2)
    entry["repeat"] = " ".join(["PIGLIT_PLATFORM=surfaceless_egl", "shadestep", "verify", *([] if options.stage == "all" else ["--stage", options.stage]), "--", *command])
    return entry


class Excuses:
    """Why two compilations of a test's shader may draw different things (undefined.txt, proofs/)."""

    def __init__(self, root: Path, seconds: float) -> None:
        lines = (FOLDER / "undefined.txt").read_text().splitlines()
        self.entries = [line.split(None, 2) for line in lines if line and not line.startswith("#")]
        self.root = root
        self.seconds = seconds
        self.proved: dict[str, bool] = {"GLSL": True}

    def holds(self, proof: str) -> bool:
        """Whether the driver, here and now, gives two tests of the same meaning two verdicts."""
        if proof not in self.proved:
            verdicts = set()
            for path in sorted((FOLDER / "proofs").glob(f"{proof}.*.shader_test")):
                _, out, err = piglit.run(piglit.command(self.root, path), self.seconds)
                verdicts.add(piglit.result(out + err))
            self.proved[proof] = verdicts == {"pass", "fail"}
        return self.proved[proof]

    def find(self, entry: dict) -> str | None:
        if entry["bare"] == "fail":
            return "the driver fails the test without shadestep"
        return next((why for pattern, proof, why in self.entries
                     if fnmatch.fnmatch(entry["test"], pattern) and self.holds(proof)), None)


def verdict_changed(entry: dict) -> bool:
    """A test that ran out of its time says nothing: verify ends it."""
    out_of_time = (entry.get("report") or {}).get("timeouts", 0)
    return "verified" in entry and entry["verified"] != entry["bare"] and not out_of_time


def problems(entry: dict) -> list[str]:
    """What is wrong with this test's run, in words."""
    if "verified" not in entry:
        return []
    found = []
    if verdict_changed(entry):
        found.append(f"the test says '{entry['verified']}' under shadestep and '{entry['bare']}' without")
    report = entry["report"]
    if report is None:
        # A test that never draws ends before there is anything to select.
        if entry["status"] not in (3, 5):
            found.append(f"verify ended with status {entry['status']}: {entry['message']}")
        return found
    excused = ("output_mismatch", "value_mismatch") if entry["undefined"] else ()
    found += [f"{name} {report[name]}" for name in FAILURES if report[name] and name not in excused]
    return found


def table(entries: list[dict]) -> str:
    """A row a directory, as Markdown."""
    header = ["directory", "tests", "driver skips", "draws", "shaders", "analysable", "sites", "values compared",
              "compile failures", "output mismatches", "value mismatches", "state leaks", "crashes",
              "unsteady", "out of time", "verdict changed", "the driver's own", "s"]
    rows: dict[str, collections.Counter] = collections.defaultdict(collections.Counter)
    for entry in entries:
        for name in (entry["directory"], "all"):
            row = rows[name]
            row["tests"] += 1
            row["driver skips"] += entry["bare"] == "skip"
            row["s"] += entry["seconds"]
            row["verdict changed"] += verdict_changed(entry)
            report = entry.get("report")
            if report is None:
                continue
            row["draws"] += report["draws"]
            row["shaders"] += report["shaders"]
            row["refused"] += report["analysis_failed"]
            row["sites"] += report["sites"]
            row["values compared"] += report["values_compared"]
            for column, key in zip(header[8:15], FAILURES):
                excused = entry["undefined"] and key in ("output_mismatch", "value_mismatch")
                row["the driver's own" if excused else column] += report[key]
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    for name in sorted(rows, key=lambda one: (one == "all", one)):
        row = rows[name]
        seen = row["shaders"] + row["refused"]
        cells = [name]
        for column in header[1:]:
            if column == "analysable":
                cells.append(f"{100 * row['shaders'] / seen:.1f} %" if seen else "-")
            else:
                cells.append(f"{row[column]:.0f}")
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def table_of_stages(entries: list[dict]) -> str:
    """A row a stage and directory, as Markdown. A test counts where it has a shader of the stage."""
    header = ["stage", "directory", "tests", "shaders", "analysable", "sites", "values compared", "compile failures",
              "output mismatches", "value mismatches", "state leaks", "the driver's own"]
    rows: dict[tuple[str, str], collections.Counter] = collections.defaultdict(collections.Counter)
    for entry in entries:
        for stage, counts in ((entry.get("report") or {}).get("stages") or {}).items():
            if counts["shaders"] + counts["analysis_failed"] == 0:
                continue
            for name in (entry["directory"], "all"):
                row = rows[stage, name]
                row["tests"] += 1
                row["shaders"] += counts["shaders"]
                row["refused"] += counts["analysis_failed"]
                row["sites"] += counts["sites"]
                row["values compared"] += counts["values_compared"]
                for column, key in zip(header[7:11], FAILURES):
                    excused = entry["undefined"] and key in ("output_mismatch", "value_mismatch")
                    row["the driver's own" if excused else column] += counts[key]
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    for stage, name in sorted(rows, key=lambda one: (one[0], one[1] == "all", one[1])):
        row = rows[stage, name]
        share = f"{100 * row['shaders'] / (row['shaders'] + row['refused']):.1f} %"
        cells = [share if column == "analysable" else str(row[column]) for column in header[2:]]
        lines.append("| " + " | ".join([stage, name, *cells]) + " |")
    return "\n".join(lines) + "\n"


def skipped(entries: list[dict]) -> str:
    """Why draws, plans and values were left out, as Markdown."""
    reasons: collections.Counter = collections.Counter()
    for entry in entries:
        for one in (entry.get("report") or {}).get("skipped", []):
            reasons[f"{one['stage']}: {one['reason'].splitlines()[0][:160]}"] += one["count"]
    return "\n".join(["| skipped | reason |", "|---|---|"] + [f"| {n} | {why} |" for why, n in reasons.most_common()]) + "\n"


def has_stage(path: Path, stage: str) -> bool:
    """Whether a test draws or dispatches with a shader of this stage."""
    text = path.read_text(errors="replace")
    return all(re.search(line, text, re.MULTILINE)
               for line in (rf"^\[{SECTIONS[stage]} shader\]", r"^(draw|compute) "))


def select(root: Path, options: argparse.Namespace) -> list[str]:
    if options.tests:
        found = [path for pattern in options.tests for path in sorted(root.glob(pattern))]
        files = [file for path in found for file in (sorted(path.rglob("*.shader_test")) if path.is_dir() else [path])]
        tests = list(dict.fromkeys(str(file.relative_to(root)) for file in files if file.suffix == ".shader_test"))
        if options.stage in SECTIONS:
            tests = [test for test in tests if has_stage(root / test, options.stage)]
    else:
        tests = [line for line in options.list.read_text().split("\n") if line and not line.startswith("#")]
    if options.sample and options.sample < len(tests):
        tests = sorted(random.Random(options.seed).sample(tests, options.sample))
    if options.minutes:
        random.Random(options.seed).shuffle(tests)
    return tests


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tests", nargs="*", metavar="TEST")
    parser.add_argument("--stage", default="fragment", metavar="S")
    parser.add_argument("--list", type=Path, default=FOLDER / "list-300.txt")
    parser.add_argument("--sample", type=int, help="only N of them, chosen by --seed")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, help="in an order chosen by --seed, and begin no test after this time")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--timeout", type=float, default=60, help="seconds for one run of one test")
    parser.add_argument("--budget", type=float, default=10, help="seconds for one draw")
    parser.add_argument("--shadestep", type=Path, default=REPOSITORY / "build" / "release" / "bin" / "shadestep")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / "corpus")
    options = parser.parse_args()

    root = piglit.root()
    if root is None:
        print(f"corpus: skipped: {piglit.HOW_TO_GET_IT}", file=sys.stderr)
        return 77
    if not options.shadestep.exists():
        print(f"corpus: no {options.shadestep}; build first (scripts/build)", file=sys.stderr)
        return 2
    tests = select(root, options)
    if not tests:
        print("corpus: no test matches", file=sys.stderr)
        return 2

    start = time.monotonic()
    options.out.mkdir(parents=True, exist_ok=True)
    excuses = Excuses(root, options.timeout)
    entries = []
    bad = 0
    with open(options.out / "results.jsonl", "w") as results:
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            def begin(test: str) -> dict | None:
                late = options.minutes and time.monotonic() - start > 60 * options.minutes
                return None if late else check(test, root, options)
            for entry in filter(None, pool.map(begin, tests)):
                entry["undefined"] = excuses.find(entry)
                entry["problems"] = problems(entry)
                results.write(json.dumps(entry) + "\n")
                results.flush()
                entries.append(entry)
                bad += bool(entry["problems"])
                for problem in entry["problems"]:
                    print(f"corpus: {entry['test']}: {problem}", file=sys.stderr)
                if sys.stderr.isatty():
                    print(f"{len(entries)} of {len(tests)}, {bad} with problems", end="\r", file=sys.stderr)
    minutes = (time.monotonic() - start) / 60
    version = subprocess.run([options.shadestep, "--version"], capture_output=True, text=True).stdout.strip()
    summary = (f"{version}; {len(entries)} tests, {bad} with problems, {minutes:.1f} minutes with {options.jobs} jobs.\n\n"
               + table(entries) + "\n" + ("" if options.stage == "fragment" else table_of_stages(entries) + "\n")
               + skipped(entries))
    (options.out / "table.md").write_text(summary)
    print(summary)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
