"""Speed against accuracy of the profiler's methods: docs/charts/profiler.csv and profiler.svg.

Usage: scripts/charts profiler [--size N] [--rounds N] [--draw | --figures]
Build first: scripts/build shadestep shadestep-gl raycaster program-shader-file

For each shader a reference is measured: every pixel by `isolate`, with many repeats. Then each method with several
settings, in turn, --rounds times; of the rounds the median counts. Errors are against the reference, after scaling to
the same mean (clock and count have units of their own).

--figures: how near each figure of the ray caster comes to the best that can be seen here, docs/charts/profiler-figures.csv. A
full measurement made twice shows how well anything can be known; sampled ones are measured in turns with them.
"""

import argparse
import base64
import csv
import json
import math
import pathlib
import re
import statistics
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
BIN = ROOT / "build/release/bin"
OUT = ROOT / "docs/charts"
ROUNDS = 3

SETTINGS = (
    [("count", "", [])]
    + [("clock", f"{n} passes", ["--passes", str(n)]) for n in (2, 6, 15)]
    + [("isolate", f"share 1/{n}", ["--share", str(1 / n)]) for n in (256, 64, 16, 4)]
    + [("isolate", f"share 1/16, {n} repeats", ["--share", str(1 / 16), "--repeats", str(n)]) for n in (2, 15)]
    + [("isolate", f"share 1/16, {n} x {n} fragments", ["--share", str(1 / 16), "--fragments", str(n)])
       for n in (8, 32)]
    + [("isolate", f"error {p}%", ["--error", f"{p}%", "--budget", "20"]) for p in (10, 5)]
)
REFERENCE = ["--share", "1", "--repeats", "15", "--budget", "300"]


def subjects(size):
    shader = lambda name: [BIN / "programs/shader-file", ROOT / f"examples/shaders/{name}.frag", size]
    return {"ray caster": [BIN / "raycaster", "--size", size], "mandelbrot": shader("mandelbrot"),
            "spheres": shader("spheres"), "noise": shader("noise")}


class Map:
    """Costs of all covered pixels, seconds, and what the profile says of itself."""

    def __init__(self, program, method, options):
        with tempfile.TemporaryDirectory() as directory:
            command = [BIN / "shadestep", "profile", "--quiet", "--no-lines", "--method", method, *options, "--out",
                       directory, "--", *program]
            done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                  text=True)
            if done.returncode != 0:
                sys.exit(f"charts: '{' '.join(map(str, command))}' ended with status {done.returncode}: {done.stderr}")
            page = (pathlib.Path(directory) / "report.html").read_text()
        data = json.loads(re.search(r'id="data">(.*?)</script>', page, re.S).group(1))
        self.profile = data["profile"]
        state = base64.b64decode(data["state"])
        raw = base64.b64decode(data["layers"][0]["values"])
        values = struct.unpack(f"<{len(raw) // 4}f", raw)
        self.costs = {i: values[i] for i in range(len(values)) if state[i]}
        self.seconds = self.profile["seconds"]


def ranks(values):
    order = sorted(range(len(values)), key=values.__getitem__)
    result = [0.0] * len(values)
    first = 0
    while first < len(order):
        end = first
        while end < len(order) and values[order[end]] == values[order[first]]:
            end += 1
        for i in range(first, end):
            result[order[i]] = (first + end - 1) / 2
        first = end
    return result


def correlation(a, b):
    mean_a, mean_b = statistics.fmean(a), statistics.fmean(b)
    ab = sum((x - mean_a) * (y - mean_b) for x, y in zip(a, b))
    aa, bb = sum((x - mean_a) ** 2 for x in a), sum((y - mean_b) ** 2 for y in b)
    return ab / math.sqrt(aa * bb) if aa > 0 and bb > 0 else math.nan


def compare(measured, reference):
    pixels = sorted(measured.costs.keys() & reference.costs.keys())
    a = [measured.costs[i] for i in pixels]
    b = [reference.costs[i] for i in pixels]
    scale = sum(b) / sum(a) if any(a) else 0  # forced settings may show nothing at all
    rmse = math.sqrt(statistics.fmean((scale * x - y) ** 2 for x, y in zip(a, b))) / statistics.fmean(b)
    return rmse, correlation(ranks(a), ranks(b)), sum(a) / sum(b) - 1


def measure(size, rounds):
    rows = []
    for name, program in subjects(size).items():
        print(f"{name}: reference", flush=True)
        reference = Map(program, "isolate", REFERENCE)
        again = Map(program, "isolate", REFERENCE)
        results = {("isolate", "all, 15 repeats (again)"): [(again.seconds, *compare(again, reference), again)]}
        for round_number in range(rounds):
            print(f"{name}: round {round_number + 1} of {rounds}", flush=True)
            for method, setting, options in SETTINGS:
                measured = Map(program, method, options)
                results.setdefault((method, setting), []).append(
                    (measured.seconds, *compare(measured, reference), measured))
        for (method, setting), runs in results.items():
            middle = lambda i: statistics.median(run[i] for run in runs)
            profile = runs[-1][4].profile
            rows.append({"shader": name, "method": method, "setting": setting, "seconds": f"{middle(0):.3f}",
                         "reference_seconds": f"{reference.seconds:.3f}", "rmse": f"{middle(1):.4f}",
                         "rank_correlation": f"{middle(2):.4f}", "total_difference": f"{middle(3):.4f}",
                         "measured": profile["measured"], "covered": profile["covered"],
                         "spread": f"{statistics.median(run[4].profile['spread'] for run in runs):.4f}"})
    return rows


def neighbours(program, budget):
    with tempfile.TemporaryDirectory() as directory:
        command = [BIN / "shadestep", "profile", "--quiet", "--json", "--neighbours", "--budget", budget, "--out", directory,
                   "--", *program]
        done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(done.stdout)


def figures(size, rounds):
    program = [BIN / "raycaster", "--size", size]
    rows = []
    row = lambda figure, value, best, remark: rows.append(
        {"figure": figure, "value": f"{value:.4f}", "best": best if isinstance(best, str) else f"{best:.4f}", "remark": remark})
    spreads = [Map(program, "clock", ["--passes", "6"]).profile["spread"] for _ in range(3 * rounds)]
    many = [Map(program, "clock", ["--passes", "21"]).profile["spread"] for _ in range(rounds)]
    row("clock: spread of 6 draws", statistics.median(spreads), statistics.median(many), "best: 21 draws")
    paid = [neighbours(program, 20)["neighbours"] for _ in range(rounds)]
    for which, name in (("agreement_all", "by the dearest thread"), ("agreement", "without divergence")):
        for pair in paid[0][which]:
            middle = lambda key: statistics.median(one[which][pair][key] for one in paid)
            row(f"ranks, {name}: {pair}", middle("rho"), middle("most"), f"{paid[0][which][pair]['groups']} groups")
    full = ["--share", "1", "--repeats", "5", "--budget", "900"]
    runs = []
    for number in range(rounds):
        print(f"round {number + 1} of {rounds}", flush=True)
        runs.append([Map(program, "isolate", full)] +
                    [Map(program, "isolate", ["--share", str(1 / 64)]) for _ in range(3)] + [Map(program, "isolate", full)])
    against = lambda which: [compare(run[i], run[0]) for run in runs for i in which]
    middle = lambda values: statistics.median(abs(value) for value in values)
    sampled, again = against((1, 2, 3)), against((4,))
    row("isolate, 1/64: RMSE", middle(one[0] for one in sampled), middle(one[0] for one in again), "best: all pixels again")
    row("isolate, 1/64: total", middle(one[2] for one in sampled), middle(one[2] for one in again), "best: all pixels again")
    row("isolate, 1/64: share of the time",
        middle(run[i].seconds / run[0].seconds for run in runs for i in (1, 2, 3)), "", f"of {runs[0][0].seconds:.0f} s")
    for one in rows:
        print("  ".join(one.values()))
    with (OUT / "profiler-figures.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


# ---- drawing -------------------------------------------------------------------------------------------

COLORS = {"count": "#6b7280", "clock": "#c2410c", "isolate": "#2f5fb3"}
WIDTH, HEIGHT, LEFT, TOP, GAP = 250, 170, 70, 60, 26


def panel(rows, x0, y0, key, low, high, log, left_most):
    span = lambda v: (math.log10(max(v, low)) - math.log10(low)) / (math.log10(high) - math.log10(low)) if log else (
        v - low) / (high - low)
    at_y = lambda v: y0 + HEIGHT - max(0, min(1, span(v))) * HEIGHT
    at_x = lambda s: x0 + max(0, min(1, (math.log10(s) + 1) / 3)) * WIDTH  # 0.1 to 100 s
    out = [f'<rect x="{x0}" y="{y0}" width="{WIDTH}" height="{HEIGHT}" fill="#fff" stroke="#d1d5db"/>']
    for seconds in (0.1, 1, 10, 100):
        out.append(f'<text x="{at_x(seconds):.1f}" y="{y0 + HEIGHT + 14}" text-anchor="middle">{seconds:g}</text>')
    for tick in ((0.01, 0.03, 0.1, 0.3, 1) if log else (0, 0.25, 0.5, 0.75, 0.95, 1)):
        out.append(f'<line x1="{x0}" x2="{x0 + WIDTH}" y1="{at_y(tick):.1f}" y2="{at_y(tick):.1f}" stroke="#eef0f3"/>')
        if left_most:
            label = f"{100 * tick:g} %" if log else f"{tick:g}"
            out.append(f'<text x="{x0 - 6}" y="{at_y(tick) + 4:.1f}" text-anchor="end">{label}</text>')
    for row in rows:
        value = float(row[key])
        if math.isnan(value):
            continue
        title = f"{row['method']} {row['setting']}: {row['seconds']} s, {value:g}"
        out.append(f'<circle cx="{at_x(float(row["seconds"])):.1f}" cy="{at_y(value):.1f}" r="4.5" '
                   f'fill="{COLORS[row["method"]]}" fill-opacity="0.75"><title>{title}</title></circle>')
    return out


def draw(rows, size):
    names = list(dict.fromkeys(row["shader"] for row in rows))
    width = LEFT + len(names) * (WIDTH + GAP) + 10
    height = TOP + 2 * (HEIGHT + 46) + 20
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="DejaVu Sans, sans-serif" '
           'font-size="11" fill="#374151">', f'<rect width="{width}" height="{height}" fill="#fafafa"/>',
           f'<text x="{LEFT}" y="20" font-size="15" font-weight="bold">Speed against accuracy, {size} x {size} pixels: '
           'against every pixel measured by isolate with 15 repeats</text>']
    for i, method in enumerate(COLORS):
        out.append(f'<circle cx="{LEFT + 6 + 90 * i}" cy="36" r="4.5" fill="{COLORS[method]}"/>'
                   f'<text x="{LEFT + 16 + 90 * i}" y="40">{method}</text>')
    for i, name in enumerate(names):
        x0 = LEFT + i * (WIDTH + GAP)
        mine = [row for row in rows if row["shader"] == name]
        out.append(f'<text x="{x0 + WIDTH / 2}" y="{TOP - 6}" text-anchor="middle" font-weight="bold">{name}</text>')
        out += panel(mine, x0, TOP, "rmse", 0.01, 1, True, i == 0)
        out += panel(mine, x0, TOP + HEIGHT + 46, "rank_correlation", 0, 1, False, i == 0)
        out.append(f'<text x="{x0 + WIDTH / 2}" y="{height - 8}" text-anchor="middle">seconds</text>')
    for text, y in (("RMSE / mean", TOP + HEIGHT / 2), ("rank correlation", TOP + HEIGHT * 1.5 + 46)):
        out.append(f'<text transform="translate(14 {y}) rotate(-90)" text-anchor="middle">{text}</text>')
    return "\n".join(out + ["</svg>", ""])


def main():
    parser = argparse.ArgumentParser(prog="scripts/charts profiler")
    parser.add_argument("--size", type=int, default=128)
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    parser.add_argument("--draw", action="store_true", help="only draw again what profiler.csv holds")
    parser.add_argument("--figures", action="store_true", help="the ray caster's figures and the best that can be seen")
    arguments = parser.parse_args()
    OUT.mkdir(parents=True, exist_ok=True)
    table = OUT / "profiler.csv"
    if arguments.figures:
        return figures(arguments.size, arguments.rounds)
    if arguments.draw:
        rows = list(csv.DictReader(table.open()))
    else:
        rows = measure(arguments.size, arguments.rounds)
        with table.open("w", newline="") as file:
            writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    (OUT / "profiler.svg").write_text(draw(rows, arguments.size))


if __name__ == "__main__":
    main()
