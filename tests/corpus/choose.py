#!/usr/bin/env python3
"""Writes a list of piglit shader tests to stdout, chosen without looking at how they fare:

    choose.py [--count 300] [--seed 1] > tests/corpus/list-300.txt

From every directory glsl-* (desktop and ES) of tests/spec and generated_tests/spec come tests that have a fragment
shader in the file and draw. Small directories give up to 20 tests; what is left is shared out in proportion to the
square root of the directories' sizes, so that the 9,000 generated tests of one feature do not crowd out the rest.
Inside a directory the tests are drawn in turn from its folders, in an order shuffled by the seed.
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


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    root = piglit.root()
    if root is None:
        print(f"choose.py: {piglit.HOW_TO_GET_IT}", file=sys.stderr)
        return 1
    found = candidates(root)
    share = shares({name: sum(map(len, folders.values())) for name, folders in found.items()}, options.count)
    for name in sorted(found):
        print("\n".join(draw(found[name], share[name], random.Random(f"{options.seed} {name}"))))
    return 0


if __name__ == "__main__":
    sys.exit(main())
