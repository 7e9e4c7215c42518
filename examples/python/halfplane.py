"""Halfplane from Python, through ctypes: the C interface (halfplane.h) as classes. Needs the shared library alone.

The library is looked for at HALFPLANE_LIBRARY, then as libhalfplane_c where the system looks. Everything that fails raises
halfplane.Error with the library's one line. With cocotb, make a Stage in the test and give it what the bus carries.
"""

import ctypes
import ctypes.util
import os

ABI = 1


class Error(Exception):
    """What halfplane_last_error() says."""


def _load():
    path = os.environ.get("HALFPLANE_LIBRARY") or ctypes.util.find_library("halfplane_c")
    if not path:
        raise Error("libhalfplane_c is not found; set HALFPLANE_LIBRARY to its path")
    library = ctypes.CDLL(path)
    for name in ("last_error", "stage_port_name", "stage_field_name"):
        getattr(library, "halfplane_" + name).restype = ctypes.c_char_p
    for name in ("config_new", "scene_read", "scene_new", "render", "stage_new"):
        getattr(library, "halfplane_" + name).restype = ctypes.c_void_p
    for name in ("scene_vertices", "frame_plane", "frame_reals", "frame_counter"):
        getattr(library, "halfplane_" + name).restype = ctypes.c_int64
    if library.halfplane_abi() != ABI:
        raise Error(f"the library has ABI {library.halfplane_abi()}, this module speaks {ABI}")
    return library


_c = _load()


def _checked(result):
    """A handle or a number as it came, unless it says that something failed."""
    if result is None or result < 0:
        raise Error(_c.halfplane_last_error().decode(errors="replace"))
    return result


class _Handle:
    """Owns a handle. `kind`: the word in halfplane_KIND_free."""

    kind = ""

    def __init__(self, made):
        self._as_parameter_ = ctypes.c_void_p(_checked(made))

    def __del__(self):
        if hasattr(self, "_as_parameter_"):
            getattr(_c, f"halfplane_{self.kind}_free")(self)


class Config(_Handle):
    """A preset with settings: Config("tiny", **{"depth.bits": 20})."""

    kind = "config"

    def __init__(self, preset, **values):
        super().__init__(_c.halfplane_config_new(preset.encode()))
        for key, value in values.items():
            _checked(_c.halfplane_config_set(self, key.encode(), str(value).encode()))

    def __getitem__(self, key):
        value = ctypes.create_string_buffer(256)
        _checked(_c.halfplane_config_get(self, key.encode(), value, ctypes.c_size_t(len(value))))
        return value.value.decode()


class Scene(_Handle):
    """A capture (docs/capture.md), as text."""

    kind = "scene"

    def __init__(self, capture):
        text = capture.encode()
        super().__init__(_c.halfplane_scene_read(text, ctypes.c_size_t(len(text))))


class ArrayScene(_Handle):
    """A scene from arrays: vertices [x, y, z, w], [..., r, g, b, a] or [..., u, v], and draws of their indices."""

    kind = "scene"

    def __init__(self, width, height, lines=""):
        super().__init__(_c.halfplane_scene_new(width, height))
        self.say(lines)

    def say(self, lines):
        """Lines of a capture for the draws that follow: "space window", "state cull back"."""
        text = lines.encode()
        _checked(_c.halfplane_scene_say(self, text, ctypes.c_size_t(len(text))))

    def vertices(self, rows):
        """Adds vertices; returns the index of the first."""
        flat = [float(value) for row in rows for value in row]
        array = (ctypes.c_double * len(flat))(*flat)
        return _checked(_c.halfplane_scene_vertices(self, array, len(rows[0]), ctypes.c_size_t(len(rows))))

    def draw(self, indices, topology="triangles"):
        array = (ctypes.c_uint32 * len(indices))(*indices)
        _checked(_c.halfplane_scene_draw(self, topology.encode(), array, ctypes.c_size_t(len(indices))))


class Frame(_Handle):
    """A scene drawn by an engine: functional, scalar, cycle or golden."""

    kind = "frame"

    def __init__(self, scene, config, engine="functional"):
        super().__init__(_c.halfplane_render(scene, config, engine.encode()))
        self.width = _checked(_c.halfplane_frame_width(self))
        self.height = _checked(_c.halfplane_frame_height(self))

    def plane(self, name):
        """Codes, row by row from the top: "depth", "color" or "stencil"."""
        values = (ctypes.c_uint32 * (self.width * self.height))()
        _checked(_c.halfplane_frame_plane(self, name.encode(), values, ctypes.c_size_t(len(values))))
        return list(values)

    def counter(self, name):
        return _checked(_c.halfplane_frame_counter(self, name.encode()))


class Port:
    """One port of a stage: its packets as dictionaries of fields."""

    def __init__(self, stage, is_out, number):
        self.name = _c.halfplane_stage_port_name(stage, is_out, number).decode()
        self.bits = _checked(_c.halfplane_stage_port_bits(stage, is_out, number))
        self.fields = []  # (name, bits, is signed), the highest first
        for field in range(_checked(_c.halfplane_stage_fields(stage, is_out, number))):
            bits = _c.halfplane_stage_field_bits(stage, is_out, number, field)
            name = _c.halfplane_stage_field_name(stage, is_out, number, field).decode()
            self.fields.append((name, abs(bits), bits < 0))

    def words(self, packet):
        """`packet`: fields by name, those left out 0; or the whole packed struct as one number."""
        value = packet
        if not isinstance(packet, int):
            value, left = 0, dict(packet)
            for name, bits, _ in self.fields:
                value = value << bits | (left.pop(name, 0) & (1 << bits) - 1)
            if left:
                raise Error(f"{self.name} has no field {next(iter(left))}")
        count = (self.bits + 31) // 32
        return (ctypes.c_uint32 * count)(*(value >> 32 * i & 0xFFFFFFFF for i in range(count)))

    def packet(self, words):
        value, fields = sum(word << 32 * i for i, word in enumerate(words)), {}
        for name, bits, is_signed in reversed(self.fields):
            field = value & (1 << bits) - 1
            fields[name] = field - (1 << bits) if is_signed and field >> bits - 1 else field
            value >>= bits
        return fields


class Stage(_Handle):
    """The specification of one stage, from reset."""

    kind = "stage"

    def __init__(self, config, name):
        super().__init__(_c.halfplane_stage_new(config, name.encode()))
        self.inputs, self.outputs = (
            [Port(self, is_out, n) for n in range(_checked(_c.halfplane_stage_ports(self, is_out)))] for is_out in (0, 1)
        )

    @staticmethod
    def _number(ports, name):
        for number, port in enumerate(ports):
            if port.name == name:
                return number
        raise Error(f"there is no port {name}")

    def put(self, port, packet):
        number = self._number(self.inputs, port)
        _checked(_c.halfplane_stage_put(self, number, self.inputs[number].words(packet)))

    def get(self, port):
        """The next packet, or None when there is none before more is put in."""
        number = self._number(self.outputs, port)
        words = (ctypes.c_uint32 * ((self.outputs[number].bits + 31) // 32))()
        return self.outputs[number].packet(words) if _checked(_c.halfplane_stage_get(self, number, words)) else None
