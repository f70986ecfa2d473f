"""The demo's steps: each is one command that a user could type; what it found is shown in a table at the end."""

import filecmp
import json
import pathlib
import shlex
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
BIN = ROOT / "build/release/bin"
OUT = ROOT / "build/demo"

PIXEL = "256,256"
ITERATION = "120"


class Failed(Exception):
    """A sentence for the user."""


def shown(command):
    return shlex.join(str(part).replace(f"{ROOT}/", "") for part in command)


def run(command, stdout=None):
    """Runs a command, its stdout into a file of build/demo or returned; its seconds and its output."""
    print(f"  {shown(command)}" + (f" > build/demo/{stdout}" if stdout else ""), flush=True)
    begin = time.monotonic()
    done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    seconds = time.monotonic() - begin
    if done.returncode != 0:
        raise Failed(f"this command ended with status {done.returncode}:\n  {shown(command)}\n{done.stderr.strip()}")
    if stdout:
        (OUT / stdout).write_text(done.stdout)
    return seconds, done.stdout


class Demo:
    def __init__(self, arguments):
        self.arguments = arguments
        self.rows = []
        self.at = ""  # the line at which values are shown

    def raycaster(self, *more):
        return [BIN / "raycaster", *more, *self.arguments]

    def shadestep(self, command, *options, program=None):
        return [BIN / "shadestep", command, *options, "--", *(program or self.raycaster())]

    def step(self, files, found, seconds):
        for name in files:
            if not (OUT / name).is_file():
                raise Failed(f"build/demo/{name} was not written")
        self.rows.append((" ".join(files), found, f"{seconds:.1f} s"))

    def line(self, text):
        """The number, as shadestep counts, of the first line of the selected shader that contains a text."""
        _, output = run(self.shadestep("source", "--json"))
        for number, line in enumerate(json.loads(output)["lines"], start=1):
            if text in line:
                return number
        raise Failed(f"the shader has no line with '{text}'")

    def image(self):
        seconds, _ = run(self.raycaster("--out", OUT / "image.png"))
        self.step(["image.png"], "the program on its own", seconds)

    def pixel(self):
        program = self.raycaster("--out", OUT / "debugged.png")
        seconds, text = run(self.shadestep("debug", "--pixel", PIXEL, "--continue", program=program), "pixel.txt")
        same = filecmp.cmp(OUT / "image.png", OUT / "debugged.png", shallow=False)
        (OUT / "debugged.png").unlink()
        if not same:
            raise Failed("the program's picture under the debugger differs from its picture alone")
        steps = next(line for line in text.splitlines() if " steps, " in line)
        self.step(["pixel.txt"], f"pixel {PIXEL}: {steps}; the program's picture is untouched", seconds)

    def value(self):
        self.at = str(self.line("src = classify("))
        seconds, output = run(self.shadestep(
            "debug", "--json", "--at", self.at, "--iteration", ITERATION, "--print", "dst",
            "--image", f"{OUT}/value.png,{OUT}/value.exr"))
        threads = json.loads(output)["threads"]
        self.step(["value.png", "value.exr"],
                  f"dst before line {self.at}, iteration {ITERATION}: {threads['reached']:,} of "
                  f"{threads['launched']:,} threads", seconds)

    def loops(self):
        # An opaque transfer function: early ray termination lives on it.
        always = ["--transfer", "opaque"]
        before, full = run(self.shadestep("loops", "--json", program=self.raycaster(*always, "--ert", "0")),
                           "loops-without.json")
        seconds, early = run(self.shadestep(
            "loops", "--json", "--compare", OUT / "loops-without.json", "--label", "early ray termination",
            "--compare-label", "every ray to its end", "--image", OUT / "loops.png", "--csv", OUT / "loops.csv",
            program=self.raycaster(*always, "--ert", "0.95")))
        (OUT / "loops-without.json").unlink()
        iterations = [sum(json.loads(text)["loops"][0]["active"]) for text in (full, early)]
        saved = 1 - iterations[1] / iterations[0]
        self.step(["loops.png", "loops.csv"],
                  f"{iterations[0]:,} iterations; {saved:.1%} fewer with early ray termination", before + seconds)

    def heat(self):
        seconds, _ = run(self.shadestep("profile", "--out", OUT))
        profile = json.loads((OUT / "profile.json").read_text())
        self.step(["report.html", "heat.png", "heat.exr", "height.png", "profile.json"],
                  f"method {profile['method']}: median {profile['median']:,.0f} {profile['unit']} a pixel, "
                  f"95% below {profile['p95']:,.0f}", seconds)

    def table(self):
        widths = [max(len(row[column]) for row in self.rows) for column in range(3)]
        print("\nIn build/demo/:\n")
        for files, found, seconds in self.rows:
            print(f"  {files:<{widths[0]}}  {found:<{widths[1]}}  {seconds:>{widths[2]}}")
        print("\nTry next:\n")
        program = shown(self.raycaster())
        tool = shown([BIN / "shadestep"])
        print(f"  {tool} debug --pixel 200,300 -- {program} | less -S")
        print(f"  {tool} debug --at {self.at} --iteration 60 --print scalarOld,dst.a --image scalar.png -- {program}")
        print(f"  {tool} profile --method count --out cost -- {program} --ert 0")


def main():
    OUT.mkdir(parents=True, exist_ok=True)
    for old in OUT.iterdir():
        old.unlink()
    demo = Demo(sys.argv[1:])
    try:
        for step in (demo.image, demo.pixel, demo.value, demo.loops, demo.heat):
            step()
    except Failed as failure:
        print(f"demo: {failure}", file=sys.stderr)
        return 1
    demo.table()
    return 0


if __name__ == "__main__":
    sys.exit(main())
