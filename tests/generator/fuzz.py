#!/usr/bin/env python3
"""Random shaders through the debugger, compared with the same shaders run on the CPU by GLSL's rules alone.

    scripts/fuzz [--stage S] [--seeds A..B] [--jobs 1] [--out DIR] [--no-reduce]

Each seed makes one shader of the stage (vertex, tess-control, tess-eval, geometry, fragment, compute; default: fragment),
versions 1.10 to 4.50 and ES 1.00 to 3.10 in turn, as far as they have the stage. It is drawn without the debugger, then under `verify`, then recorded in two threads (`debug`, step by step), looked at in one place for
all threads, and its loops are counted. What fails is made smaller and kept in --out (build/fuzz), and the command that repeats it is printed.
Exit status: 0 if nothing failed, 1 if something did.
"""

from __future__ import annotations

import argparse
import collections
import concurrent.futures
import shutil
import sys
import time
from pathlib import Path

import check
import scopes
from dialect import Dialect
from generate import Generator, dialect_of
from interpret import Undefined
from reduce import reduce
from stages import STAGES
from tree import Program

REPOSITORY = Path(__file__).resolve().parent.parent.parent


def make(seed: int, stage: str = "fragment") -> tuple[Program, Dialect]:
    """Programs that turn out to be undefined, or too long, are thrown away."""
    dialect = dialect_of(seed, stage)
    attempt = 0
    while True:
        program = Generator(f"{seed}.{attempt}", dialect, stage).generate()
        attempt += 1
        try:
            check.interpret(program, set())
            return program, dialect
        except (Undefined, scopes.Invalid):
            pass


def one(seed: int, options: argparse.Namespace) -> tuple[int, check.Outcome, Path]:
    tools = check.Tools(options.shadestep, options.draw)
    folder = options.out / f"{options.stage}-{seed}"
    program, dialect = make(seed, options.stage)
    outcome = check.Check(program, dialect, folder, tools, str(seed)).run()
    if not outcome.kind:
        shutil.rmtree(folder)
    elif options.reduce and outcome.kind not in ("compile", "driver"):
        outcome = reduce(program, dialect, folder, tools, str(seed), outcome)
    return seed, outcome, folder


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--stage", default="fragment", choices=STAGES)
    parser.add_argument("--seeds", default="0..99")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--no-reduce", dest="reduce", action="store_false")
    parser.add_argument("--seconds", type=float, help="begin no seed after this time")
    programs = REPOSITORY / "build" / "release" / "bin"
    parser.add_argument("--shadestep", type=Path, default=programs / "shadestep")
    parser.add_argument("--draw", type=Path, default=programs / "programs" / "generator-draw")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / "fuzz")
    options = parser.parse_args()
    first, _, last = options.seeds.partition("..")
    seeds = range(int(first), int(last or first) + 1)
    for program in (options.shadestep, options.draw):
        if not program.exists():
            print(f"fuzz: no {program}; build first (scripts/build)", file=sys.stderr)
            return 2

    start = time.monotonic()
    failed: dict[str, list[int]] = collections.defaultdict(list)
    done = steps = values = zero_signs = 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        def guarded(seed: int):
            if options.seconds and time.monotonic() - start > options.seconds:
                return None
            return one(seed, options)
        for result in pool.map(guarded, seeds):
            if result is None:
                continue
            seed, outcome, folder = result
            done, steps, values = done + 1, steps + outcome.steps, values + outcome.values
            zero_signs += outcome.zero_signs
            if outcome.kind:
                failed[outcome.kind].append(seed)
                print(f"fuzz: seed {seed}: {outcome.kind}\n  " + "\n  ".join(outcome.problems) +
                      f"\n  shader: {folder / STAGES[options.stage].file}\n  repeat: {' '.join(outcome.command)}", flush=True)
    print(f"{done} shaders, {steps} recorded steps and {values} values compared, "
          f"{sum(map(len, failed.values()))} failures" +
          (f" ({', '.join(f'{kind}: {seeds}' for kind, seeds in failed.items())})" if failed else "") +
          (f", {zero_signs} zeros of another sign" if zero_signs else "") +
          f", {time.monotonic() - start:.0f} s")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
