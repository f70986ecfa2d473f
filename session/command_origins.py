"""Writes a table of which version or extension each GL and GLX command came with, from the Khronos registry's XML."""

from __future__ import annotations

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

#What a version is called, by the registry's name of its API; earlier ones win: who calls glUniform1f needs OpenGL 2.0.
VERSIONS = {"gl": "OpenGL", "glx": "GLX", "gles2": "OpenGL ES", "gles1": "OpenGL ES", "glsc2": "OpenGL SC"}


def commands(element: ElementTree.Element) -> list[str]:
    return [c.get("name") for c in element.findall("require/command")]


def origins(root: ElementTree.Element) -> dict[str, str]:
    found: dict[str, str] = {}
    features = root.findall("feature")
    for api, version in VERSIONS.items():
        for feature in sorted((f for f in features if f.get("api") == api), key=lambda f: float(f.get("number"))):
            for name in commands(feature):
                found.setdefault(name, f"{version} {feature.get('number')}")
    for extension in root.findall("extensions/extension"):
        for name in commands(extension):
            found.setdefault(name, extension.get("name"))
    return found


def main(arguments: list[str]) -> int:
    *registries, out = arguments
    found: dict[str, str] = {}
    for path in registries:
        found |= origins(ElementTree.parse(path).getroot())
    rows = "".join(f'    {{"{name}", "{origin}"}},\n' for name, origin in sorted(found.items()))
    text = (
        "// Written by session/command_origins.py from Khronos' registry; not to be edited.\n"
        '#include "session/command_origins.h"\n\n'
        "namespace shadestep::session {\n\n"
        "const CommandOrigin kCommandOrigins[] = {\n" + rows + "};\n"
        f"const std::size_t kCommandOriginCount = {len(found)};\n\n"
        "}  // namespace shadestep::session\n"
    )
    Path(out).write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
