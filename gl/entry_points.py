#!/usr/bin/env python3
"""Writes core/entry_points.cpp: a function for each command of OpenGL 1.5 and OpenGL ES-CM 1.1, and their other names;
and core/entry_names.inc: the names of OpenGL 1.5.

    gl/entry_points.py [--check] [gl.xml]

The signatures are those of Khronos' gl.xml (Debian: khronos-api), the commands those of core/commands.hpp. What an entry
point does follows from its name by the rules below. --check compares and writes nothing; status 1: the file is out of date.
"""
import pathlib
import re
import sys
import textwrap
import xml.etree.ElementTree

DESKTOP = [f"GL_VERSION_1_{minor}" for minor in range(6)]
EMBEDDED = ["GL_VERSION_ES_CM_1_0"]
CORE = pathlib.Path(__file__).parent / "core"

def snake(name):
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()


# Name without "gl", count, type and v -> command, argument before the components, how integers are read.
COMPONENTS = {
    "Vertex": ("vertex", "", "real"),
    "Normal": ("normal", "", "norm"),
    "Color": ("color", "", "norm"),
    "SecondaryColor": ("secondary_color", "", "norm"),
    "Index": ("index", "", "real"),
    "TexCoord": ("tex_coord", "GLenum{GL_TEXTURE0}", "real"),
    "MultiTexCoord": ("tex_coord", "$1", "real"),
    "FogCoord": ("fog_coord", "", "real"),
    "EvalCoord1": ("eval_coord1", "", "real"),
    "EvalCoord2": ("eval_coord2", "", "real"),
    "RasterPos": ("raster_pos", "", "real"),
    "WindowPos": ("window_pos", "", "real"),
    "DrawTex": ("draw_tex", "", "real"),
}
FILL = {"y": "0.0", "z": "0.0", "w": "1.0", "t": "0.0", "r": "0.0", "q": "1.0", "a": "1.0"}  # components not given
COUNTS = {"Index": 1, "FogCoord": 1, "EvalCoord1": 1, "EvalCoord2": 2, "DrawTex": 5}

# With values by Params.
PARAMS = ["Light", "Material", "LightModel", "Fog", "TexParameter", "TexEnv", "TexGen", "PointParameter"]
# With results by Values.
GETS = ["Light", "Material", "TexEnv", "TexGen", "TexParameter", "TexLevelParameter", "Map", "PixelMap"]

# Commands outside display lists that return a value and do not begin with gen_, delete_ or get_.
AT_ONCE = re.compile(
    r"(\w+_pointer|interleaved_arrays|client_\w+|\w+_client_attrib|draw_(arrays|elements|range_elements)|multi_draw_\w+"
    r"|array_element|bind_buffer|buffer_(sub_)?data|begin_query|end_query|finish|flush|read_pixels|pixel_store|new_list"
    r"|end_list|select_buffer|feedback_buffer)$")
# Draws are refused there by themselves, when they are carried out: a list may hold them within glBegin and glEnd.
INSIDE_BEGIN = re.compile(
    r"(begin|end|vertex|normal|color|secondary_color|index|tex_coord|fog_coord|edge_flag|material|eval_coord.|eval_point."
    r"|array_element|draw_(arrays|elements|range_elements)|multi_draw_\w+|call_list)$")

# Entry points that follow no rule: the body; $1 is the first argument, $* all.
BODIES = {
    "Enable": "listed<&enable>($1, true)",
    "Disable": "listed<&enable>($1, false)",
    "EnableClientState": "now<&client_state>($1, true)",
    "DisableClientState": "now<&client_state>($1, false)",
    "BlendFunc": "listed<&blend_func_separate>($1, $2, $1, $2)",
    "EdgeFlagv": "listed_inside<&edge_flag>(*$1)",
    "ClipPlane": "listed<&clip_plane>($1, vec4($2))",
    "ClipPlanef": "listed<&clip_plane>($1, vec4($2))",
    "ClipPlanex": "listed<&clip_plane>($1, vec4_fixed($2))",
    "RenderMode": "now<&set_render_mode>($1)",
    "DrawPixels": "with_context([&](Context& c) { enter_draw_pixels(c, $*); })",
    "Bitmap": "with_context([&](Context& c) { enter_bitmap(c, $*); })",
    "PolygonStipple": "with_context([&](Context& c) { enter_polygon_stipple(c, $1); })",
    "TexImage1D": "with_context([&](Context& c) { enter_tex_image(c, 1, $1, $2, $3, $4, 1, 1, $5, $6, $7, $8); })",
    "TexImage2D": "with_context([&](Context& c) { enter_tex_image(c, 2, $1, $2, $3, $4, $5, 1, $6, $7, $8, $9); })",
    "TexImage3D": "with_context([&](Context& c) { enter_tex_image(c, 3, $*); })",
    "TexSubImage1D":
        "with_context([&](Context& c) { enter_tex_sub_image(c, 1, $1, $2, $3, 0, 0, $4, 1, 1, $5, $6, $7); })",
    "TexSubImage2D":
        "with_context([&](Context& c) { enter_tex_sub_image(c, 2, $1, $2, $3, $4, 0, $5, $6, 1, $7, $8, $9); })",
    "TexSubImage3D": "with_context([&](Context& c) { enter_tex_sub_image(c, 3, $*); })",
    "CopyTexImage1D": "listed<&copy_tex_image>(1, $1, $2, $3, $4, $5, $6, 1, $7)",
    "CopyTexImage2D": "listed<&copy_tex_image>(2, $*)",
    "CopyTexSubImage1D": "listed<&copy_tex_sub_image>(1, $1, $2, $3, 0, 0, $4, $5, $6, 1)",
    "CopyTexSubImage2D": "listed<&copy_tex_sub_image>(2, $1, $2, $3, $4, 0, $5, $6, $7, $8)",
    "CopyTexSubImage3D": "listed<&copy_tex_sub_image>(3, $*)",
    "GetCompressedTexImage": "now<&enter_get_compressed_image>($1, $2)",
    "CallLists": "with_context([&](Context& c) { enter_call_lists(c, $*); })",
    "PrioritizeTextures": "with_context([&](Context& c) { enter_prioritize_textures(c, $*); })",
    "DeleteTextures": "now<&enter_delete_textures>($*)",
    "GetClipPlane": "outside_begin([&](Context& c) { store_clip_plane(c, $1, $2); })",
    "GetClipPlanef": "outside_begin([&](Context& c) { store_clip_plane(c, $1, $2); })",
    "GetClipPlanex": "outside_begin([&](Context& c) { store_clip_plane(c, $1, $2); })",
    "GetFixedv": "outside_begin([&](Context& c) { store_state_fixed(get(c, $1), $2); })",
    "GetQueryiv": "now<&get_query>($*)",
    "GetQueryObjectiv": "now<&get_query_object>($*)",
    "GetQueryObjectuiv": "now<&get_query_object>($1, $2, reinterpret_cast<GLint*>($3))",
    "GetBufferParameteriv": "now<&get_buffer_parameter>($*)",
    "GetBufferPointerv": "now<&get_buffer_pointer>($*)",
    "GetPointerv": "now<&get_pointer>($*)",
    "CompressedTexImage2D": "with_context([&](Context& c) { enter_compressed_image(c, $*); })",
}
for rule, size in {"Vertex": "", "Color": "", "SecondaryColor": "", "TexCoord": "", "Normal": "3, ", "Index": "1, ",
                   "FogCoord": "1, ", "PointSize": "1, ", "EdgeFlag": "1, GLenum{GL_UNSIGNED_BYTE}, "}.items():
    BODIES[rule + "Pointer"] = f"now<&array_pointer>(Array::{snake(rule)}, {size}$*)"
for rule in ("Map1", "Map2", "PixelMap"):
    for letters in ("f", "d", "fv", "uiv", "usv"):
        command = "pixel_map" if rule == "PixelMap" else rule.lower()
        BODIES[rule + letters] = f"with_context([&](Context& c) {{ enter_{command}(c, $*); }})"
for rule in ("Boolean", "Integer", "Float", "Double"):
    BODIES[f"Get{rule}v"] = "outside_begin([&](Context& c) { store(get(c, $1), $2); })"

# Names of extensions that gl.xml gives no alias: the name without EXT, and arrays with a count that is not used.
SAME_WITHOUT_EXT = ["glGenTexturesEXT", "glDeleteTexturesEXT", "glIsTextureEXT", "glAreTexturesResidentEXT"]
COUNTED = [f"gl{array}PointerEXT" for array in ("Vertex", "Normal", "Color", "Index", "TexCoord", "EdgeFlag")]
NOTHING = ["glLockArraysEXT", "glUnlockArraysEXT"]
OES = [f"glDrawTex{letters}OES" for letters in ("s", "i", "f", "x", "sv", "iv", "fv", "xv")] + ["glPointSizePointerOES"]


def read_registry(path):
    """The commands as name -> (result, [(type, parameter)], alias), and the names that features have."""
    root = xml.etree.ElementTree.parse(path).getroot()
    commands = {}
    for command in root.find("commands"):
        def declared(node):
            name = node.find("name").text
            kind = "".join(node.itertext()).strip().removesuffix(name).strip()
            return re.sub(r"\s*\*", "*", kind).replace("GLclampx", "GLfixed"), name
        result, name = declared(command.find("proto"))
        alias = command.find("alias")
        commands[name] = (result, [declared(p) for p in command.findall("param")],
                          None if alias is None else alias.get("name"))
    def names_of(features):
        return {command.get("name") for feature in root.findall("feature") if feature.get("name") in features
                for command in feature.findall("require/command")}
    return commands, names_of(DESKTOP), names_of(EMBEDDED)


def read_commands():
    """Of commands.hpp: name -> types and names of the parameters behind Context&."""
    text = re.sub(r"//.*", "", (CORE / "commands.hpp").read_text())
    found = {}
    for name, parameters in re.findall(r"\b(\w+)\(Context&(?:, )?([^;{]*)\);", text):
        parts = [part.split() for part in re.split(r",\s*(?![^<]*>)", parameters) if part.strip()]
        found[name] = [(" ".join(part[:-1]), part[-1]) for part in parts]
    return found


def issued(command):
    """How a command is issued: the name of a function of entry_conversions.hpp."""
    inside = "_inside" if INSIDE_BEGIN.match(command) else ""
    at_once = AT_ONCE.match(command) or re.match(r"(gen|delete|get|is|are|map_b|unmap)_?", command)
    return ("now" if at_once else "listed") + inside


def body_of(name, parameters, commands):
    """The body of an entry point; None where no rule holds."""
    stem = name.removeprefix("gl").removesuffix("OES")
    names = [parameter for _, parameter in parameters]
    if stem in BODIES:
        body = BODIES[stem].replace("$*", ", ".join(names))
        return re.sub(r"\$(\d)", lambda match: names[int(match[1]) - 1], body)
    if stem.startswith("Compressed"):
        return "listed<&compressed_image>()"

    if found := re.fullmatch(r"([A-Za-z]+?)([1-4]?)(b|s|i|f|d|ub|us|ui|x)(v?)", stem):
        base, count, letters, is_vector = found.groups()
        for family in (base, base + count):
            if family in COMPONENTS:
                return components(family, COUNTS.get(family) or int(count), letters == "x", is_vector, names, commands)
        if base in PARAMS:
            convert = ("vector" if is_vector else "scalar") + ("_fixed" if letters == "x" else "")
            first = "".join(f"{n}, " for n in names[:-1])
            return f"{issued(snake(base))}<&{snake(base)}>({first}{convert}({names[-2]}, {names[-1]}))"
        if base.startswith("Get") and base[3:] in GETS:
            store = "store_fixed" if letters == "x" else "store"
            return (f"outside_begin([&](Context& c) {{ {store}({snake(base)}(c, {', '.join(names[:-1])}), "
                    f"{names[-1]}); }})")
        if re.fullmatch(r"(Load|Mult)(Transpose)?Matrix", base):
            convert = "matrix_fixed" if letters == "x" else "matrix"
            return f"listed<&{snake(base)}>({convert}({names[0]}))"
        if base == "Rect" and is_vector:
            return f"listed<&rect>({', '.join(f'real({n}[{i}])' for n in names for i in range(2))})"

    for command in (snake(stem), snake(re.sub(r"[fdisx]$", "", stem))):
        if command in commands:
            return f"{issued(command)}<&{command}>({', '.join(arguments(parameters, commands[command]))})"
    return None


def components(base, count, is_fixed, is_vector, names, commands):
    command, first, read = COMPONENTS[base]
    if is_fixed:
        read = "fixed"
    given = [f"{names[-1]}[{i}]" for i in range(count)] if is_vector else names[-count:]
    values = [f"{read}({value})" for value in given]
    wanted = [parameter for kind, parameter in commands[command] if kind == "double"]
    first = first.replace("$1", names[0])
    values += [FILL[parameter] for parameter in wanted[count:]]
    return f"{issued(command)}<&{command}>({', '.join(([first] if first else []) + values)})"


TYPES = {"b": "GLbyte", "d": "GLdouble", "f": "GLfloat", "i": "GLint", "s": "GLshort", "ub": "GLubyte", "ui": "GLuint",
         "us": "GLushort"}


def families(rows):
    """Takes out the rows of commands that differ in the type of their components alone, each with its v: the calls of
    add_variants() in their place."""
    found = {}
    for name in rows:
        if parts := re.fullmatch(r"gl([A-Za-z]+)([1-4]?)(b|s|i|f|d|ub|us|ui)", name):
            base, count, letters = parts.groups()
            family = next((key for key in (base, base + count) if key in COMPONENTS), None)
            if family and name + "v" in rows:
                found.setdefault((family, base + count), []).append(letters)
    calls = []
    for (family, stem), letters in sorted(found.items(), key=lambda item: item[0][1]):
        for one in letters:
            del rows[f"gl{stem}{one}"], rows[f"gl{stem}{one}v"]
        command, first, read = COMPONENTS[family]
        inside = "allowed" if issued(command).endswith("_inside") else "refused"
        before = {"": "nothing", "$1": "given"}.get(first, "first_unit")
        count = COUNTS.get(family) or int(stem[-1])
        calls.append(f"add_variants<&{command}, InsideBegin::{inside}, Components::"
                     f"{'normalized' if read == 'norm' else 'real'}, Before::{before}, {count}, "
                     f"{', '.join(TYPES[one] for one in letters)}>(to, \"gl{stem}\");")
    return calls


def arguments(given, wanted):
    """An argument where the command has a double is read as one; the rest has the type of the command already."""
    assert len(given) == len(wanted), (given, wanted)
    for (kind, name), (target, _) in zip(given, wanted):
        yield name if target != "double" else f"fixed({name})" if kind == "GLfixed" else f"real({name})"


def entry(name, parameters, body):
    """A row of the table."""
    listed = ", ".join(kind + (f" {parameter}" if re.search(rf"\b{parameter}\b", body) else "")
                       for kind, parameter in parameters)
    statement = f" return {body}; " if body else ""
    return f'{{"{name}", function([]({listed}) {{{statement}}})}},'


def generate(path):
    """The files: name -> text."""
    registry, desktop, embedded = read_registry(path)
    commands = read_commands()
    rows, missing = {}, []
    for name in sorted(desktop | embedded) + OES:
        parameters = [(kind, parameter + "_" * (parameter in commands)) for kind, parameter in registry[name][1]]
        body = body_of(name, parameters, commands)
        rows[name] = entry(name, parameters, body or "")
        if body is None:
            missing.append(name)
    if missing:
        sys.exit(f"no rule for {', '.join(missing)}")
    for name in COUNTED:
        parameters = registry[name][1]
        plain = registry[name.removesuffix("EXT")][1]
        rows[name] = entry(name, parameters,
                           body_of(name.removesuffix("EXT"), [(k, p) for k, p in parameters if p != "count"], commands))
        assert len(plain) + 1 == len(parameters)
    for name in NOTHING:
        rows[name] = entry(name, registry[name][1], "")
    aliases = {name: alias for name, (_, parameters, alias) in registry.items()
               if name not in rows and alias in rows and len(parameters) == len(registry[alias][1])}
    aliases.update((name, name.removesuffix("EXT")) for name in SAME_WITHOUT_EXT)

    calls = families(rows)
    by_suffix, others = {}, {}
    for name, of in sorted(aliases.items()):
        suffix = name.removeprefix(of)
        if name == of + suffix and re.fullmatch("[A-Z]+", suffix):
            by_suffix.setdefault(suffix, []).append(of.removeprefix("gl"))
        else:
            others[name] = of
    assert not others, others

    lines = ["// Written by gl/entry_points.py from Khronos' gl.xml and core/commands.hpp: change that, not this.",
             "// clang-format off", '#include "entry_points.hpp"', "", "#include <array>", "",
             '#include "embedded.hpp"', '#include "entry_variants.hpp"', "", "namespace halfplane::gl {", "namespace {",
             "",
             "void add_families(EntryPoints& to) {"]
    lines += ["  " + call for call in calls]
    lines += ["}", "", "void add_others(EntryPoints& to) {", "  to.insert({"]
    lines += ["    " + rows[name] for name in sorted(rows)]
    lines += ["  });", "}", "", "// Names of extensions: those of commands with a suffix.",
              "struct Suffixed {", "  std::string_view suffix, names;", "};", "constexpr std::array kSuffixed{"]
    for suffix, stems in by_suffix.items():
        wrapped = textwrap.wrap(" ".join(stems), 110)
        lines += [f'  Suffixed{{"{suffix}",'] + [f'    "{line} "' for line in wrapped]
        lines[-1] += "},"
    lines += ["};", "", "EntryPoints all_entry_points() {", "  EntryPoints all;", "  add_families(all);",
              "  add_others(all);",
              "  for (auto [suffix, names] : kSuffixed)",
              "    for (; !names.empty(); names.remove_prefix(names.find(' ') + 1)) {",
              '      const std::string name = "gl" + std::string(names.substr(0, names.find(\' \')));',
              "      all.emplace(name + std::string(suffix), all.at(name));", "    }", "  return all;", "}", "",
              "}  // namespace", "", "const void* entry_point(std::string_view name) {",
              "  static const EntryPoints all = all_entry_points();", "  const auto found = all.find(name);",
              "  return found != all.end() ? found->second : nullptr;", "}", "", "}  // namespace halfplane::gl", ""]
    names = ["// Written by gl/entry_points.py: the commands of OpenGL 1.5."]
    names += [f"HALFPLANE_ENTRY({name})" for name in sorted(desktop)]
    return {"entry_points.cpp": "\n".join(lines), "entry_names.inc": "\n".join(names) + "\n"}


def main():
    arguments_ = [argument for argument in sys.argv[1:] if argument != "--check"]
    for name, text in generate(arguments_[0] if arguments_ else "/usr/share/khronos-api/gl.xml").items():
        file = CORE / name
        if "--check" not in sys.argv:
            file.write_text(text)
        elif file.read_text() != text:
            sys.exit(f"{file} is out of date: run {__file__}")


if __name__ == "__main__":
    main()
