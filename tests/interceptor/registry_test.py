"""The generator against the XML itself, the headers, and the built library.

    registry_test.py SOURCE_FOLDER GENERATED_FOLDER LIBRARY GL_XML GLX_XML
"""

import re
import subprocess
import sys
import tempfile
import tomllib
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

SOURCE, GENERATED, LIBRARY, GL_XML, GLX_XML = (Path(a) for a in sys.argv[1:6])
sys.path.insert(0, str(SOURCE))

import generate  # noqa: E402
import model  # noqa: E402


def squeezed(text: str) -> str:
    """Without white space: what is left must be equal."""
    return "".join(text.split())


def declarations(xml: Path) -> dict[str, str]:
    """Name -> squeezed C declaration, straight from the XML."""
    found = {}
    for command in ElementTree.parse(xml).getroot().iter("command"):
        prototype = command.find("proto")
        if prototype is None:
            continue  # a reference to a command
        parameters = ",".join("".join(p.itertext()) for p in command.findall("param"))
        found[prototype.find("name").text] = squeezed("".join(prototype.itertext()) + "(" + parameters + ")")
    return found


class Generated(unittest.TestCase):
    def test_every_command_has_one_wrapper_of_its_type(self):
        for xml, pattern in ((GL_XML, "gl_wrappers_*.cpp"), (GLX_XML, "glx_wrappers.cpp")):
            text = "".join(p.read_text() for p in sorted(GENERATED.glob(pattern)))
            exported = "".join(re.findall(r'extern "C" \{(.*?)\}  // extern "C"', text, re.S))
            wrappers = re.findall(r"^(\w[^\n;{}]*\)) \{$", exported, re.M)
            expected = declarations(xml)
            self.assertEqual(len(expected), xml.read_text().count("<proto"))
            self.assertCountEqual([squeezed(w) for w in wrappers], expected.values())

    def test_every_result_is_returned(self):
        for path in GENERATED.glob("*_wrappers*.cpp"):
            exported = re.findall(r'extern "C" \{(.*?)\}  // extern "C"', path.read_text(), re.S)
            for result, body in re.findall(r"^(\w[^\n;{}]*?)\w+\([^\n]*\) \{\n(.*?)^\}", "".join(exported), re.M | re.S):
                if result.strip() != "void":
                    self.assertRegex(body, r"  return [^;]+;\n$", f"{path.name}: {result} {body}")

    def test_the_tables_are_in_the_order_of_their_names(self):
        for api in model.read_all(GL_XML, GLX_XML, SOURCE):
            text = (GENERATED / f"{api.name}_table.h").read_text()
            members = re.findall(r"^  .*?\(\*(\w+)\)\(", text, re.M)
            names = re.findall(r'^    "(\w+)",$', (GENERATED / f"{api.name}_table.cpp").read_text(), re.M)
            self.assertEqual(names, sorted(names))
            self.assertEqual([api.prefix + m for m in members], names)

    def test_files_that_stay_the_same_are_left_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            arguments = ["--gl-xml", str(GL_XML), "--glx-xml", str(GLX_XML), "--out", folder]
            self.assertEqual(generate.main(arguments), 0)
            before = {p.name: p.stat().st_mtime_ns for p in Path(folder).iterdir()}
            self.assertEqual(generate.main(arguments), 0)
            self.assertEqual(before, {p.name: p.stat().st_mtime_ns for p in Path(folder).iterdir()})


class Library(unittest.TestCase):
    def test_exports_the_commands_and_the_hooked_libc_names_and_nothing_else(self):
        lines = subprocess.run(["nm", "-D", "--defined-only", LIBRARY], capture_output=True, text=True, check=True)
        exported = {line.split()[-1] for line in lines.stdout.splitlines()}
        signatures = tomllib.loads((SOURCE / "signatures.toml").read_text())
        expected = {"dlsym", "dlopen", *declarations(GL_XML), *declarations(GLX_XML), *signatures["egl"], *signatures["osmesa"]}
        self.assertEqual(exported, expected)

    def test_needs_libc_and_nothing_else(self):
        dynamic = subprocess.run(["readelf", "-d", LIBRARY], capture_output=True, text=True, check=True).stdout
        needed = set(re.findall(r"NEEDED.*\[(.*)\]", dynamic))
        self.assertLessEqual({n.split(".so")[0] for n in needed}, {"libc", "libm", "ld-linux-x86-64", "ld-linux-aarch64"})


class Signatures(unittest.TestCase):
    def test_name_what_the_headers_name(self):
        source = "#define EGL_NO_X11\n#define EGL_EGLEXT_PROTOTYPES\n"
        source += "#include <EGL/egl.h>\n#include <EGL/eglext.h>\n#include <GL/osmesa.h>\n"
        text = subprocess.run(["cc", "-E", "-P", "-"], input=source, capture_output=True, text=True, check=True).stdout
        signatures = tomllib.loads((SOURCE / "signatures.toml").read_text())
        self.assertEqual(set(re.findall(r"\b(egl[A-Z]\w*) ?\(", text)), set(signatures["egl"]))
        self.assertEqual(set(re.findall(r"\b(OSMesa[A-Z]\w*) ?\(", text)), set(signatures["osmesa"]))


class Model(unittest.TestCase):
    def setUp(self):
        self.apis = model.read_all(GL_XML, GLX_XML, SOURCE)

    def command(self, name):
        return next(c for api in self.apis for c in api.commands if c.name == name)

    def test_keeps_pointers_and_consts(self):
        for name, text in {
            "glShaderSource": "GLuint shader, GLsizei count, const GLchar *const*string, const GLint *length",
            "glXGetProcAddress": "const GLubyte *procName",
            "OSMesaGetColorBuffer": "OSMesaContext c, GLint *width, GLint *height, GLint *format, void **buffer",
            "glFinish": "",
        }.items():
            self.assertEqual(self.command(name).parameter_list, text)
        self.assertEqual(self.command("glGetString").result, "const GLubyte *")
        self.assertEqual(self.command("eglQueryString").result, "const char *")

    def test_every_command_that_sounds_like_drawing_is_placed(self):
        overlay = tomllib.loads((SOURCE / "overlay.toml").read_text())
        not_draws = {n for names in overlay["not_draws"].values() for n in names}
        for command in self.apis[0].commands:
            if re.search(r"Draw|Rect", command.name) and not command.draw:
                named = {command.name, command.alias}
                self.assertTrue(named & not_draws, f"{command.name}: a draw or not? Say so in overlay.toml")

    def test_aliases_share_roles_by_position(self):
        draw = self.command("glDrawArraysInstancedARB").draw
        self.assertEqual(draw, model.Draw(mode="mode", count="count", instances="primcount"))
        self.assertEqual(self.command("glShaderSourceARB").hook_name, "glShaderSource")

    def overlay_fails(self, text, message):
        sections = {"draws": "", "not_draws": "", "present": "commands = []", "lists": "", "hooks": ""} | text
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "overlay.toml"
            path.write_text("\n".join(f"[{name}]\n{body}" for name, body in sections.items()))
            with self.assertRaisesRegex(model.RegistryError, message):
                model.apply_overlay(path, self.apis)

    def test_mistakes_in_the_overlay_are_said(self):
        self.overlay_fails({"draws": "glDrawNothing = {}"}, "no registry has a command glDrawNothing")
        self.overlay_fails({"draws": 'glDrawArrays = { mode = "kind" }'}, "glDrawArrays has no parameter kind")
        self.overlay_fails({"hooks": 'glFinish = ["instead"]'}, "hooks are before and after, or replace")
        self.overlay_fails({"hooks": 'glFinish = ["after", "replace"]'}, "hooks are before and after, or replace")
        self.overlay_fails({"draws": "glBegin = {}", "not_draws": 'why = ["glBegin"]'}, "both draws and does not")
        self.overlay_fails({"lists": '"clears" = ["glClearNothing*"]'}, "no registry has a command glClearNothing")
        self.overlay_fails({"extra": ""}, "unknown section")

    def test_mistakes_in_the_xml_are_said(self):
        for body, message in (
            ("<proto>void <name>glX</name></proto><param>GLint <name>a</name>[3]</param>", "text after the name"),
            ("<proto>void </proto>", "without a <name>"),
            ("<proto>void <name>fooX</name></proto>", "does not begin with gl"),
        ):
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / "gl.xml"
                path.write_text(f"<registry><commands><command>{body}</command></commands></registry>")
                with self.assertRaisesRegex(model.RegistryError, message):
                    model.read_xml(path, "gl", "gl")

    def test_types_are_spelt_one_way(self):
        self.assertEqual(model.normalised_type("const  void *const *"), "const void *const*")
        self.assertEqual(model.normalised_type("GLint"), "GLint")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
