"""How arguments and results of calls are shown: the kind of each, and the names of enumerants by the registry's groups."""

from __future__ import annotations

import re

import model

# C types by what they hold; everything else is shown as an address or a number of its size.
ELEMENTS = {
    "GLenum": "enumerant", "GLbitfield": "bitmask", "GLboolean": "boolean",
    "GLbyte": "int8", "GLshort": "int16", "GLint": "int32", "GLsizei": "int32", "GLfixed": "int32", "GLclampx": "int32",
    "GLint64": "int64", "GLint64EXT": "int64", "GLintptr": "int64", "GLsizeiptr": "int64", "GLintptrARB": "int64",
    "GLsizeiptrARB": "int64", "GLubyte": "uint8", "GLushort": "uint16", "GLuint": "uint32", "GLhandleARB": "uint32",
    "GLuint64": "uint64", "GLuint64EXT": "uint64", "GLhalfNV": "uint16", "GLfloat": "float32", "GLclampf": "float32",
    "GLdouble": "float64", "GLclampd": "float64", "GLchar": "text", "GLcharARB": "text", "char": "text",
    "int": "int32", "unsigned int": "uint32", "unsigned long": "uint64", "Bool": "int32", "float": "float32",
    "int32_t": "int32", "int64_t": "int64", "GLXContextID": "uint64", "GLXDrawable": "uint64", "GLXPixmap": "uint64",
    "GLXPbuffer": "uint64", "GLXWindow": "uint64", "Window": "uint64", "Pixmap": "uint64", "Font": "uint64",
    "Colormap": "uint64", "EGLint": "int32", "EGLenum": "hexadecimal", "EGLBoolean": "int32", "EGLAttrib": "int64",
    "EGLTime": "uint64", "EGLTimeKHR": "uint64", "EGLuint64KHR": "uint64", "GLboolean8": "boolean", "void": "nothing",
}  # fmt: skip


class Names:
    """What the template call_descriptions.cpp asks for."""

    def __init__(self, apis: list[model.Api]) -> None:
        self._enums = {name: int(value.rstrip("ul"), 0) for name, value in apis[0].enums.items()}
        groups = apis[0].groups
        used = {p.group for api in apis for c in api.commands for p in c.parameters if p.group}
        used |= {c.result_group for api in apis for c in api.commands if c.result_group}
        self._indices = {name: i + 1 for i, name in enumerate(sorted(used & set(groups)))}
        self.groups = [self._all()] + [self._group(groups[name]) for name in self._indices]

    def _all(self) -> list[tuple[int, str]]:
        """Every value's plainest name: one without a vendor's suffix where there is one."""
        best: dict[int, str] = {}
        for name, value in self._enums.items():
            if value >= 1 << 32 or "_BIT" in name or name.endswith("_MASK"):
                continue
            known = best.get(value)
            if known is None or (_vendor(known) and not _vendor(name)):
                best[value] = name
        return sorted((value, name) for value, name in best.items() if value > 1)

    def _group(self, names: list[str]) -> list[tuple[int, str]]:
        return sorted({self._enums[name]: name for name in names if self._enums[name] < 1 << 32}.items())

    def group(self, name: str | None) -> int:
        return self._indices.get(name or "", 0)

    def value(self, type_: str, group: str | None) -> str:
        """The C++ of a ValueKind's first members: element, pointers, constant."""
        pointers = type_.count("*")
        base = type_.replace("const", " ").replace("*", " ").replace("struct", " ")
        base = " ".join(base.split())
        element = ELEMENTS.get(base, "address" if pointers == 0 else "nothing")
        if group == "String" and pointers == 1:
            element = "text"
        if pointers > 1 and element != "text":
            element = "nothing"
        return f"Element::{element}, {pointers}, {'true' if type_.startswith('const') else 'false'}"

    def length(self, command: model.Command, parameter: model.Parameter) -> str:
        """Length{parameter, factor}: arguments[parameter] * factor elements; parameter -1: factor; factor 0: unknown."""
        text = (parameter.length or "").replace(" ", "")
        if re.fullmatch(r"\d+", text):
            return f"-1, {text}"
        match = re.fullmatch(r"(\w+)(?:\*(\d+))?", text)
        names = [p.name for p in command.parameters]
        if match and match[1] in names and "*" not in command.parameters[names.index(match[1])].type:
            return f"{names.index(match[1])}, {match[2] or 1}"
        return "-1, 0"


def _vendor(name: str) -> bool:
    return bool(re.search(r"_(ARB|EXT|OES|KHR|NV|AMD|ATI|APPLE|INTEL|SGIX|SGIS|SGI|IBM|SUN|HP|IMG|QCOM|NVX|PGI|ANGLE|"
                          r"3DFX|MESA|MESAX|OVR|WIN|INGR|REND|S3|SUNX|OML|ARM|VIV|FJ|DMP|APPLE|GREMEDY)$", name))
