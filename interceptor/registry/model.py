"""The commands of GL, GLX, EGL and OSMesa as typed objects.

Read from the Khronos registry's XML, from signatures.toml (EGL and OSMesa, which Debian ships no XML of) and from
overlay.toml (what no registry says: which commands draw, present, or have hand-written hooks).
Everything unknown or contradictory is an error: nothing is lost silently.
"""

from __future__ import annotations

import dataclasses
import fnmatch
import re
import tomllib
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path


class RegistryError(Exception):
    """The data contradict themselves or each other; the text says where."""


@dataclass(frozen=True)
class Parameter:
    type: str  # "const void *const*"
    name: str  # "indices"
    group: str | None = None  # of an enumerant or a bitmask: "PrimitiveType"
    length: str | None = None  # of an array, in elements: "4", "count*2", "COMPSIZE(pname)"

    @property
    def declaration(self) -> str:
        return f"{self.type}{'' if self.type.endswith('*') else ' '}{self.name}"


@dataclass(frozen=True)
class Draw:
    """How a command's DrawCall is told from its arguments; strings are parameter names of this very command."""

    mode: str | None = None
    count: str | None = None
    parts: str | None = None  # `count` is an array of this many
    instances: str | None = None
    indirect: bool = False
    replay: bool = True
    within: str | None = None


@dataclass
class Command:
    name: str
    result: str  # "void", "const GLubyte *"
    parameters: list[Parameter]
    result_group: str | None = None
    alias: str | None = None  # the registry's own name for the same command
    draw: Draw | None = None
    presents: bool = False
    listed: str | None = None  # why a display list with this command cannot be replayed
    hooks: frozenset[str] = frozenset()
    hook_name: str = ""  # the command whose hooks are called: itself, or the one that it is an alias of

    @property
    def returns(self) -> bool:
        return self.result != "void"

    @property
    def parameter_list(self) -> str:
        return ", ".join(p.declaration for p in self.parameters)

    @property
    def type_list(self) -> str:
        return ", ".join(p.type for p in self.parameters)

    @property
    def argument_list(self) -> str:
        return ", ".join(p.name for p in self.parameters)

    def after_argument_list(self) -> str:
        return ", ".join((["result"] if self.returns else []) + [p.name for p in self.parameters])

    def after_parameter_list(self) -> str:
        result = [Parameter(self.result, "result").declaration] if self.returns else []
        return ", ".join(result + [p.declaration for p in self.parameters])


@dataclass
class Api:
    """One API: its commands sorted by name, which is also their order in its table."""

    name: str  # "gl"
    prefix: str  # of its commands: "gl"
    commands: list[Command]
    types: list[str] = field(default_factory=list)  # C text, in order
    enums: dict[str, str] = field(default_factory=dict)  # GL_POINTS -> 0x0000
    groups: dict[str, list[str]] = field(default_factory=dict)  # GetPName -> GL_CURRENT_COLOR, ...

    def __post_init__(self) -> None:
        self.commands.sort(key=lambda c: c.name)
        names = [c.name for c in self.commands]
        if len(set(names)) != len(names):
            raise RegistryError(f"{self.name}: a command is given twice")
        for command in self.commands:
            if not command.name.startswith(self.prefix):
                raise RegistryError(f"{self.name}: {command.name} does not begin with {self.prefix}")
            command.hook_name = command.name

    def member(self, command: Command) -> str:
        """The command's name in its table: glDrawArrays -> DrawArrays."""
        return command.name[len(self.prefix) :]

    def find(self, name: str) -> Command | None:
        return next((c for c in self.commands if c.name == name), None)


def read_xml(path: Path, name: str, prefix: str) -> Api:
    root = ElementTree.parse(path).getroot()
    commands = [_command(e, path) for e in root.findall("commands/command")]
    types = ["".join(e.itertext()).strip() for e in root.findall("types/type")]
    enums = {
        e.get("name"): e.get("value") + ("u" if e.get("type") == "u" else "ull" if e.get("type") == "ull" else "")
        for e in root.findall("enums/enum")
        if e.get("api") in (None, "gl")
    }
    return Api(name, prefix, commands, [t for t in types if t], enums, _groups(root, enums))


def _groups(root: ElementTree.Element, enums: dict[str, str]) -> dict[str, list[str]]:
    """The registry's groups of constants; of several names for one value the first."""
    groups: dict[str, dict[str, str]] = {}
    for element in root.findall("enums/enum"):
        name = element.get("name")
        for group in (element.get("group") or "").split(","):
            if group and name in enums:
                groups.setdefault(group, {}).setdefault(enums[name], name)
    return {group: list(names.values()) for group, names in groups.items()}


def _command(element: ElementTree.Element, path: Path) -> Command:
    prototype = element.find("proto")
    name = _spelt(prototype, "name", path)
    alias = element.find("alias")
    return Command(
        name=name,
        result=_type_before_name(prototype, path),
        parameters=[
            Parameter(_type_before_name(p, path), _spelt(p, "name", path), p.get("group"), p.get("len"))
            for p in element.findall("param")
        ],
        result_group=prototype.get("group"),
        alias=None if alias is None else alias.get("name"),
    )


def _spelt(element: ElementTree.Element, tag: str, path: Path) -> str:
    text = element.findtext(tag)
    if not text:
        raise RegistryError(f"{path.name}: a declaration without a <{tag}>: {''.join(element.itertext())!r}")
    return text.strip()


def _type_before_name(element: ElementTree.Element, path: Path) -> str:
    """All the text before <name>: the type as C spells it, pointers and consts included."""
    parts = [element.text or ""]
    for child in element:
        if child.tag == "name":
            if (child.tail or "").strip():
                raise RegistryError(f"{path.name}: text after the name in {''.join(element.itertext())!r}")
            return normalised_type("".join(parts))
        parts += [child.text or "", child.tail or ""]
    raise RegistryError(f"{path.name}: a declaration without a <name>: {''.join(element.itertext())!r}")


def normalised_type(text: str) -> str:
    """One space between words and before the first star: 'const void *const*'."""
    words = re.sub(r"\s+", " ", text).strip()
    return re.sub(r"\s*\*\s*", "*", words).replace("*", " *", 1).strip()


def read_signatures(path: Path, name: str, prefix: str) -> Api:
    """A section of signatures.toml: name = [result, parameters...]."""
    commands = []
    for command, (result, *parameters) in tomllib.loads(path.read_text())[name].items():
        commands.append(Command(command, normalised_type(result), [_parameter(p, command) for p in parameters]))
    return Api(name, prefix, commands)


def _parameter(text: str, command: str) -> Parameter:
    match = re.fullmatch(r"(.*[\s*])(\w+)", text)
    if not match:
        raise RegistryError(f"signatures.toml: {command}: '{text}' is not a type and a name")
    return Parameter(normalised_type(match[1]), match[2])


HOOKS = {"before", "after", "replace"}


def apply_overlay(path: Path, apis: list[Api]) -> None:
    """Adds the overlay's meaning to the commands that it names and to their aliases."""
    overlay = tomllib.loads(path.read_text())
    unknown = set(overlay) - {"draws", "not_draws", "present", "lists", "groups", "hooks"}
    if unknown:
        raise RegistryError(f"overlay: unknown section {sorted(unknown)}")
    commands = {c.name: c for api in apis for c in api.commands}

    def named(name: str) -> Command:
        if name not in commands:
            raise RegistryError(f"overlay: no registry has a command {name}")
        return commands[name]

    def aliases(name: str, section: dict) -> list[Command]:
        return [c for c in commands.values() if c.alias == name and c.name not in section]

    for name, entry in overlay["draws"].items():
        draw = Draw(**entry)
        base = named(name)
        base.draw = _checked(draw, base)
        for command in aliases(name, overlay["draws"]):
            command.draw = _checked(_translated(draw, base, command), command)
    for name in (n for names in overlay["not_draws"].values() for n in names):
        if named(name).draw:
            raise RegistryError(f"overlay: {name} both draws and does not")
    for name in overlay["present"]["commands"]:
        named(name).presents = True
    for reason, patterns in overlay["lists"].items():
        for pattern in patterns:
            matching = [c for c in commands.values() if fnmatch.fnmatchcase(c.name, pattern)]
            if not matching:
                raise RegistryError(f"overlay: no registry has a command {pattern}")
            for command in matching:
                command.listed = reason
    for group, parameters in overlay.get("groups", {}).items():
        for name, parameter in (text.split(".") for text in parameters):
            command = named(name)
            if parameter not in [p.name for p in command.parameters]:
                raise RegistryError(f"overlay: {name} has no parameter {parameter}")
            command.parameters = [
                dataclasses.replace(p, group=group) if p.name == parameter else p for p in command.parameters
            ]
    for name, kinds in overlay["hooks"].items():
        if not set(kinds) <= HOOKS or ("replace" in kinds and len(kinds) > 1):
            raise RegistryError(f"overlay: {name}: hooks are before and after, or replace, not {kinds}")
        for command in [named(name)] + aliases(name, overlay["hooks"]):
            if len(command.parameters) != len(named(name).parameters):
                raise RegistryError(f"overlay: {command.name} has other parameters than its alias {name}")
            command.hooks = frozenset(kinds)
            command.hook_name = name


def _translated(draw: Draw, base: Command, alias: Command) -> Draw:
    """The same roles by position, in the alias's parameter names."""
    if len(base.parameters) != len(alias.parameters):
        raise RegistryError(f"overlay: {alias.name} has other parameters than {base.name}: give it an entry of its own")
    names = {b.name: a.name for b, a in zip(base.parameters, alias.parameters)}

    def role(name: str | None) -> str | None:
        return names.get(name, name) if name else None

    return Draw(
        role(draw.mode),
        role(draw.count),
        role(draw.parts),
        role(draw.instances),
        draw.indirect,
        draw.replay,
        draw.within,
    )


def _checked(draw: Draw, command: Command) -> Draw:
    names = {p.name for p in command.parameters}
    for role in (draw.mode, draw.count, draw.parts, draw.instances):
        if role and role not in names:
            raise RegistryError(f"overlay: {command.name} has no parameter {role}")
    return draw


def read_all(gl_xml: Path, glx_xml: Path, folder: Path) -> list[Api]:
    signatures = folder / "signatures.toml"
    apis = [
        read_xml(gl_xml, "gl", "gl"),
        read_xml(glx_xml, "glx", "glX"),
        read_signatures(signatures, "egl", "egl"),
        read_signatures(signatures, "osmesa", "OSMesa"),
    ]
    apply_overlay(folder / "overlay.toml", apis)
    return apis
