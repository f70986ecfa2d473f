"""The charts of docs/raycaster.md: measures (raycaster-measure), writes docs/charts/raycaster-*.csv and .svg.

Arguments: names of charts (default: all); --draw-only draws again from the CSV files that are there.
"""
import csv
import math
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
OUT = ROOT / "docs/charts"
COLOURS = ["#1b6ca8", "#d1495b", "#2e8b57", "#b8860b", "#7b4fa6", "#444444", "#00a0a0", "#c06000", "#999999"]
DASHES = {"32 bit": "", "16 bit": "6 3", "8 bit": "2 3", "plan": "", "best fixed": "6 3"}


class Panel:
    """Axes with lines. Values that a logarithm cannot show are put on the axis."""

    def __init__(self, x, y, width, height, title, labels, logs, values):
        self.x, self.y, self.width, self.height = x, y, width, height
        self.title, self.labels, self.logs = title, labels, logs
        self.limits = [self.limit(axis, values[axis]) for axis in (0, 1)]

    def limit(self, axis, values):
        if self.logs[axis]:
            values = [math.log10(value) for value in values if value > 0] or [0]
            low, high = math.floor(min(values) * 5) / 5, math.ceil(max(values) * 5) / 5
        else:
            low, high = min(0, min(values)), max(values)
        return (low, high if high > low else low + 1)

    def place(self, axis, value):
        low, high = self.limits[axis]
        if self.logs[axis]:
            value = math.log10(value) if value > 0 else low
        share = min(1, max(0, (value - low) / (high - low)))
        return self.x + share * self.width if axis == 0 else self.y + self.height - share * self.height

    def ticks(self, axis):
        low, high = self.limits[axis]
        if self.logs[axis]:
            if high - low < 1.5:
                decades = range(math.floor(low), math.ceil(high) + 1)
                every = [base * 10.0 ** decade for decade in decades for base in (1, 2, 5)]
                return [value for value in every if low - 1e-9 <= math.log10(value) <= high + 1e-9]
            return [10.0 ** decade for decade in range(math.ceil(low), math.floor(high) + 1)]
        step = 10 ** math.floor(math.log10((high - low) / 2))
        step = next(step * factor for factor in (1, 2, 5, 10) if (high - low) / (step * factor) <= 6)
        return [round(i * step, 10) for i in range(math.ceil(low / step), math.floor(high / step) + 1)]

    def svg(self):
        x, y, w, h = self.x, self.y, self.width, self.height
        parts = [f'<rect x="{x}" y="{y}" width="{w}" height="{h}" fill="none" stroke="#888"/>',
                 f'<text x="{x + w / 2}" y="{y - 8}" text-anchor="middle" font-weight="bold">{self.title}</text>',
                 f'<text x="{x + w / 2}" y="{y + h + 34}" text-anchor="middle">{self.labels[0]}</text>',
                 f'<text transform="translate({x - 50},{y + h / 2}) rotate(-90)" text-anchor="middle">'
                 f'{self.labels[1]}</text>']
        for value in self.ticks(0):
            at = self.place(0, value)
            parts.append(f'<line x1="{at:.1f}" y1="{y}" x2="{at:.1f}" y2="{y + h}" stroke="#e4e4e4"/>'
                         f'<text x="{at:.1f}" y="{y + h + 16}" text-anchor="middle">{value:g}</text>')
        for value in self.ticks(1):
            at = self.place(1, value)
            parts.append(f'<line x1="{x}" y1="{at:.1f}" x2="{x + w}" y2="{at:.1f}" stroke="#e4e4e4"/>'
                         f'<text x="{x - 6}" y="{at + 4:.1f}" text-anchor="end">{value:g}</text>')
        return parts

    def line(self, points, colour, dash, marks=True):
        places = [(self.place(0, a), self.place(1, b)) for a, b in points]
        path = " ".join(f"{a:.1f},{b:.1f}" for a, b in places)
        parts = [f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="1.8" '
                 f'stroke-dasharray="{dash}"/>']
        if marks:
            parts += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="2.6" fill="{colour}"/>' for a, b in places]
        return parts


def read(name):
    with open(OUT / f"raycaster-{name}.csv", newline="") as file:
        rows = [{key: value if key == "series" else float(value) for key, value in row.items()}
                for row in csv.DictReader(file)]
    series = {}
    for row in rows:
        series.setdefault(row["series"], []).append(row)
    for points in series.values():
        points.sort(key=lambda row: row["x"])
    return series


def style(names):
    """One colour for each first part of a name, one dash for its last (bits, or how it was chosen)."""
    heads = []
    for name in names:
        head = next((name[:-len(bits) - 1] for bits in DASHES if name.endswith(" " + bits)), name)
        if head not in heads:
            heads.append(head)
    result = {}
    for name in names:
        bits = next((bits for bits in DASHES if name.endswith(" " + bits)), "32 bit")
        head = name[:-len(bits) - 1] if name.endswith(" " + bits) else name
        result[name] = (COLOURS[heads.index(head) % len(COLOURS)], DASHES[bits])
    return result


def chart(name, heading, panels, **computed):
    """panels: (title, x key, y key, x label, y label, log x, log y, extra lines); computed: more keys of a row."""
    series = read(name)
    for points in series.values():
        for row in points:
            row.update({key: value(row) for key, value in computed.items()})
    styles = style(series)
    width, gap, height = 330, 90, 250
    total = 70 + len(panels) * (width + gap)
    bottom = 70 + height + 55
    rows = (len(series) + 2) // 3
    parts = [f'<text x="20" y="24" font-size="15" font-weight="bold">{heading}</text>']
    for number, (title, x, y, x_label, y_label, log_x, log_y, *extra) in enumerate(panels):
        lines = {label: [(row[x], row[y]) for row in rows_] for label, rows_ in series.items()}
        values = [[point[axis] for points in lines.values() for point in points] for axis in (0, 1)]
        panel = Panel(75 + number * (width + gap), 60, width, height, title, (x_label, y_label), (log_x, log_y),
                      values)
        parts += panel.svg()
        for label, points in lines.items():
            parts += panel.line(points, *styles[label])
        for function in extra:
            xs = sorted({point[0] for points in lines.values() for point in points})
            parts += panel.line([(at, function(at)) for at in xs], "#000", "1 3", False)
    for number, label in enumerate(series):
        colour, dash = styles[label]
        at_x, at_y = 75 + (number % 3) * 250, bottom + 18 * (number // 3)
        parts.append(f'<line x1="{at_x}" y1="{at_y}" x2="{at_x + 32}" y2="{at_y}" stroke="{colour}" '
                     f'stroke-width="2" stroke-dasharray="{dash}"/><text x="{at_x + 38}" y="{at_y + 4}">{label}</text>')
    text = (f'<svg xmlns="http://www.w3.org/2000/svg" width="{max(total, 840)}" height="{bottom + 18 * rows + 8}" '
            f'font-family="DejaVu Sans, sans-serif" font-size="11.5"><rect width="100%" height="100%" fill="#fff"/>'
            + "\n".join(parts) + "</svg>\n")
    (OUT / f"raycaster-{name}.svg").write_text(text)


def draw(name):
    error, most, fetches = "RMSE", "largest error", "fetches a ray"
    by_fetches = ("error against fetches", "fetches", "rms", fetches, error, True, True)
    largest = ("largest error", "fetches", "max", fetches, most, True, True)
    time = ("error against time", "milliseconds", "rms", "processor milliseconds a frame", error, True, True)
    if name == "step":
        chart(name, "Step and precision (C60, spike; step 1/16 to 1/1024)", [by_fetches, largest, time])
    elif name == "table":
        chart(name, "Size of the classification table (C60, shells, step 1/256)",
              [("error against size", "x", "rms", "entries along an edge", error, True, True),
               ("largest error", "x", "max", "entries along an edge", most, True, True)])
    elif name == "termination":
        never = 5e-4
        chart(name, "Early ray termination (C60, step 1/256; dotted: what is cut off at most)",
              [("what it saves", "residual", "fetches", "residual transparency (left end: off)", fetches, True, False),
               ("what it costs", "residual", "max", "residual transparency (left end: off)", most, True, True,
                lambda residual: residual),
               time], residual=lambda row: max(1 - row["x"], never))
    elif name == "leaping":
        chart(name, "Empty-space leaping (C60, step 1/512, limit 0.95, 192 x 192)",
              [("fetches", "x", "fetches", "degrees from frame to frame", fetches, False, True),
               ("misses", "x", "rms", "degrees from frame to frame", "share of pixels that differ", False, False)])
    elif name == "wavelengths":
        chart(name, "Wavelengths (C60, step 1/256; against 80 wavelengths)",
              [("colour error", "x", "rms", "wavelengths", "RMSE of linear RGB", True, True),
               ("largest", "x", "max", "wavelengths", most, True, True),
               ("time", "milliseconds", "rms", "processor milliseconds a frame", "RMSE of linear RGB", True, True)])
    elif name == "storage":
        chart(name, "What a Kubelka-Munk table holds (C60, milk)", [by_fetches, largest])
    elif name == "adaptive":
        chart(name, "Adaptive sampling (C60 128, limit 0.999; step 1/64 to 1/1024)", [by_fetches, largest])
    elif name == "plan":
        chart(name, "Plans for a budget against the best of 810 fixed settings (C60; dotted: the budget)",
              [("error against budget", "x", "rms", "budget", error, True, True, lambda budget: budget), by_fetches, time])


NAMES = ["step", "table", "termination", "leaping", "wavelengths", "storage", "adaptive", "plan"]


def main():
    arguments = sys.argv[1:]
    draw_only = "--draw-only" in arguments
    names = [name for name in arguments if name != "--draw-only"] or NAMES
    unknown = [name for name in names if name not in NAMES]
    if unknown:
        sys.exit(f"charts: there is no chart '{unknown[0]}'; there are {', '.join(NAMES)}")
    OUT.mkdir(parents=True, exist_ok=True)
    if not draw_only:
        subprocess.run([ROOT / "scripts/build", "raycaster-measure"], check=True)
    for name in names:
        if not draw_only:
            done = subprocess.run([ROOT / "build/release/bin/raycaster-measure", name], check=True, text=True,
                                  stdout=subprocess.PIPE)
            (OUT / f"raycaster-{name}.csv").write_text(done.stdout)
        draw(name)
        print(f"docs/charts/raycaster-{name}.svg")


main()
