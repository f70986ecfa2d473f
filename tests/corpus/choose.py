#!/usr/bin/env python3
"""Writes a list of piglit shader tests to stdout, chosen without looking at how they fare:

    choose.py [--count 300] [--seed 1] > tests/corpus/list-300.txt
    choose.py --stages [--count 100] [--seed 1] > tests/corpus/list-stages.txt

From every directory glsl-* (desktop and ES) of tests/spec and generated_tests/spec come tests that have a fragment
shader in the file and draw. Small directories give up to 20 tests; what is left is shared out in proportion to the
square root of the directories' sizes, so that the 9,000 generated tests of one feature do not crowd out the rest.
Inside a directory the tests are drawn in turn from its folders, in an order shuffled by the seed.

With --stages come, of all directories, tests that have a shader of another stage and draw or dispatch: as many for each
stage, from directories drawn by the square root of their sizes. A vertex shader counts if it decides something or calls a
function of its own.
"""

from __future__ import annotations

import argparse
import collections
import math
import random
import re
import sys
from pathlib import Path

import piglit

AT_LEAST = 20
STAGES = ("vertex", "tessellation control", "tessellation evaluation", "geometry", "compute")


def candidates(root: Path) -> dict[str, dict[str, list[str]]]:
    """Directory -> folder -> tests, all sorted."""
    found: dict[str, dict[str, list[str]]] = collections.defaultdict(lambda: collections.defaultdict(list))
    for part in ("tests/spec", "generated_tests/spec"):
        for path in sorted((root / part).glob("glsl-*/**/*.shader_test")):
            text = path.read_text(errors="replace")
            if re.search(r"^\[fragment shader\]", text, re.MULTILINE) and re.search(r"^draw ", text, re.MULTILINE):
                test = str(path.relative_to(root))
                found[piglit.directory(test)][str(path.parent)].append(test)
    return found


def with_stage(root: Path) -> dict[str, dict[str, list[str]]]:
    """Stage -> directory -> tests, all sorted."""
    found: dict[str, dict[str, list[str]]] = {stage: collections.defaultdict(list) for stage in STAGES}
    for part in ("tests/spec", "generated_tests/spec"):
        for path in sorted((root / part).glob("**/*.shader_test")):
            text = path.read_text(errors="replace")
            if not re.search(r"^(draw|compute) ", text, re.MULTILINE):
                continue
            test = str(path.relative_to(root))
            for stage in STAGES:
                shader = re.search(rf"^\[{stage} shader\]$(.*?)^\[", text, re.MULTILINE | re.DOTALL)
                if shader and (stage != "vertex" or does_something(shader.group(1))):
                    found[stage][piglit.directory(test)].append(test)
    return found


def does_something(shader: str) -> bool:
    functions = len(re.findall(r"^\w+\s+\w+\s*\([^;]*$", shader, re.MULTILINE))
    return functions > 1 or re.search(r"\b(if|for|while|switch)\b|\?", shader) is not None


def shares(sizes: dict[str, int], count: int) -> dict[str, int]:
    share = {name: min(size, AT_LEAST) for name, size in sizes.items()}
    open_places = max(count - sum(share.values()), 0)
    weights = {name: math.sqrt(size) for name, size in sizes.items() if size > AT_LEAST}
    for name, weight in weights.items():
        extra = round(open_places * weight / sum(weights.values()))
        share[name] = min(sizes[name], share[name] + extra)
    return share


def draw(folders: dict[str, list[str]], count: int, generator: random.Random) -> list[str]:
    order = sorted(folders)
    generator.shuffle(order)
    decks = {folder: generator.sample(folders[folder], len(folders[folder])) for folder in order}
    chosen: list[str] = []
    while len(chosen) < count:
        for folder in order:
            if decks[folder] and len(chosen) < count:
                chosen.append(decks[folder].pop())
    return sorted(chosen)


def draw_by_size(directories: dict[str, list[str]], count: int, generator: random.Random) -> list[str]:
    names = sorted(directories)
    weights = [math.sqrt(len(directories[name])) for name in names]
    chosen: set[str] = set()
    while len(chosen) < min(count, sum(map(len, directories.values()))):
        chosen.add(generator.choice(directories[generator.choices(names, weights)[0]]))
    return sorted(chosen)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--stages", action="store_true")
    parser.add_argument("--count", type=int, help="300, or 100 with --stages")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    root = piglit.root()
    if root is None:
        print(f"choose.py: {piglit.HOW_TO_GET_IT}", file=sys.stderr)
        return 1
    if options.stages:
        chosen: set[str] = set()
        for stage, directories in with_stage(root).items():
            chosen.update(draw_by_size(directories, (options.count or 100) // len(STAGES),
                                       random.Random(f"{options.seed} {stage}")))
        print("\n".join(sorted(chosen)))
        return 0
    found = candidates(root)
    share = shares({name: sum(map(len, folders.values())) for name, folders in found.items()}, options.count or 300)
    for name in sorted(found):
        print("\n".join(draw(found[name], share[name], random.Random(f"{options.seed} {name}"))))
    return 0


if __name__ == "__main__":
    sys.exit(main())
