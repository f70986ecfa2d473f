"""Finds piglit's shader tests and runs one of them, as piglit itself would."""

from __future__ import annotations

import glob
import json
import os
import re
import subprocess
from pathlib import Path

HOW_TO_GET_IT = "piglit is not installed; get it with 'apt-get install piglit' (2 GB installed)"


def root() -> Path | None:
    """The directory that holds piglit's bin/, tests/ and generated_tests/. PIGLIT_DIR names another one."""
    for place in [os.environ.get("PIGLIT_DIR", ""), *glob.glob("/usr/lib/*/piglit"), "/usr/lib64/piglit"]:
        if place and (Path(place) / "bin" / "shader_runner").exists():
            return Path(place)
    return None


def directory(test: str) -> str:
    """glsl-1.30 of tests/spec/glsl-1.30/execution/a.shader_test: the row of the table that a test belongs to."""
    parts = Path(test).parts
    return parts[parts.index("spec") + 1] if "spec" in parts[:-1] else str(Path(test).parent)


def command(piglit: Path, test: str) -> list[str]:
    """The runner that takes the test: there is one for OpenGL and one for each OpenGL ES."""
    text = (piglit / test).read_text(errors="replace")
    es = re.search(r"^\s*(?:GLSL ES|GL ES)\s*>?=\s*(\d)", text, re.MULTILINE)
    runner = "shader_runner" if not es else "shader_runner_gles3" if es.group(1) >= "3" else "shader_runner_gles2"
    return [str(piglit / "bin" / runner), str(piglit / test), "-auto", "-fbo"]


def environment() -> dict[str, str]:
    """Without an X server."""
    return os.environ | {"PIGLIT_PLATFORM": "surfaceless_egl"}


def result(output: str) -> str:
    """pass, fail, skip or warn, as the test's own last word says; "crash" if it has none."""
    found = re.findall(r'PIGLIT: (\{.*"result".*\})', output)
    return json.loads(found[-1])["result"] if found else "crash"


def run(arguments: list[str], seconds: float) -> tuple[int | None, str, str]:
    """Exit status (None: out of time, and ended with all that it started), stdout, stderr."""
    with subprocess.Popen(arguments, env=environment(), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, errors="replace", start_new_session=True) as process:
        try:
            out, err = process.communicate(timeout=seconds)
            return process.returncode, out, err
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, 9)
            out, err = process.communicate()
            return None, out, err
