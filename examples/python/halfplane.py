"""Halfplane from Python, through ctypes: the C interface (halfplane.h) as classes. Needs the shared library alone.

The library is looked for at HALFPLANE_LIBRARY, then as libhalfplane_c where the system looks. Everything that fails raises
halfplane.Error with the library's one line. With cocotb, make a Pipeline or a Stage in the test and give it what the bus
carries.

Vertices, indices and texels may be lists, or any buffer: bytes, array.array, memoryview, ctypes and NumPy arrays. Planes are
memoryviews of 32-bit words, which numpy.asarray() takes without copying: numpy.asarray(frame.plane("depth")).reshape(h, w).
"""

import array
import ctypes
import ctypes.util
import os
import re

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
    for name in "config scene target stage pipeline host".split():
        getattr(library, f"halfplane_{name}_new").restype = ctypes.c_void_p
    for name in ("scene_read", "render_threads"):
        getattr(library, "halfplane_" + name).restype = ctypes.c_void_p
    for name in (
        "scene_vertices scene_records frame_plane frame_reals frame_counter target_plane target_counter "
        "pipeline_memory_size pipeline_plane".split()
    ):
        getattr(library, "halfplane_" + name).restype = ctypes.c_int64
    library.halfplane_config_id.restype = ctypes.c_uint64
    if library.halfplane_abi() != ABI:
        raise Error(f"the library has ABI {library.halfplane_abi()}, this module speaks {ABI}")
    return library


_c = _load()


def _checked(result):
    """A handle or a number as it came, unless it says that something failed."""
    if result is None or result < 0:
        raise Error(_c.halfplane_last_error().decode(errors="replace"))
    return result


def _bytes_of(buffer):
    """A pointer to what a buffer holds, and its size in bytes. Copies only what is read-only or has gaps."""
    view = memoryview(buffer)
    if not view.c_contiguous:
        view = memoryview(view.tobytes())
    if view.nbytes == 0:
        return None, 0
    view = view.cast("B") if view.format != "B" or view.ndim != 1 else view
    kind = ctypes.c_char * view.nbytes
    return (kind.from_buffer_copy if view.readonly else kind.from_buffer)(view), view.nbytes


def _indices(values):
    """Indices as 32-bit words, and how many. A buffer of 32-bit words is taken as it is."""
    if isinstance(values, (list, tuple, range)):
        values = array.array("I", values)
    view = memoryview(values)
    if view.itemsize != 4 or view.format in ("f", "<f"):
        view = memoryview(array.array("I", view.tolist()))
    return _bytes_of(view)[0], view.nbytes // 4


class _Attribute(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("components", ctypes.c_int), ("offset", ctypes.c_size_t)]


class Layout(ctypes.Structure):
    """Vertices as they lie in memory: `stride` bytes from one to the next, and for each attribute that they have its type,
    "f64", "f32", "u8" or "i16", its number of components and its place, in bytes. Four floats with a colour of 8 bits a
    channel behind them: Layout(20, position=("f32", 4, 0), color=("u8", 4, 16)).
    """

    _fields_ = [("stride", ctypes.c_size_t)] + [
        (name, _Attribute) for name in ("position", "color", "texcoord", "normal")
    ]
    TYPES = {"f64": 1, "f32": 2, "u8": 3, "i16": 4}

    def __init__(self, stride, **attributes):
        super().__init__(stride)
        for name, (kind, components, offset) in attributes.items():
            if kind not in self.TYPES:
                raise Error(f"there is no type {kind!r}; give one of {', '.join(self.TYPES)}")
            setattr(self, name, _Attribute(self.TYPES[kind], components, offset))


def _vertices(vertices, layout):
    """Layout, pointer, bytes and number of vertices. Without a layout, rows of x y z w [r g b a [u v]]: lists, or a buffer of
    floats or doubles with a row for each vertex.
    """
    if layout is not None:
        pointer, size = _bytes_of(vertices)
        return layout, pointer, size, size // layout.stride if layout.stride else 0
    if isinstance(vertices, (list, tuple)):
        width, rows, kind = len(vertices[0]) if vertices else 4, len(vertices), "f64"
        if any(len(row) != width for row in vertices):
            raise Error("rows of vertices have different lengths")
        vertices = array.array("d", (value for row in vertices for value in row))
    else:
        view = memoryview(vertices)
        kind = {"d": "f64", "<d": "f64", "f": "f32", "<f": "f32"}.get(view.format)
        if view.ndim != 2 or kind is None:
            raise Error("give a layout: these vertices are not rows of floats or doubles")
        rows, width = view.shape
    if width not in (4, 8, 10):
        raise Error(f"a vertex has 4, 8 or 10 numbers, not {width}")
    size = 8 if kind == "f64" else 4
    attributes = {"position": (kind, 4, 0), "color": (kind, 4, 4 * size), "texcoord": (kind, 2, 8 * size)}
    made = Layout(width * size, **dict(list(attributes.items())[: {4: 1, 8: 2, 10: 3}[width]]))
    return made, *_bytes_of(vertices), rows


def _plane(function, handle, name, count, into):
    """A plane as 32-bit words, in `into` or in memory of its own."""
    if into is None:
        into = (ctypes.c_uint32 * count)()
    view = memoryview(into)
    if view.readonly or not view.c_contiguous:
        raise Error("a plane needs a buffer that can be written, without gaps")
    _checked(function(handle, name.encode(), _bytes_of(view)[0], ctypes.c_size_t(view.nbytes // 4)))
    return view.cast("B").cast("I")


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

    def id(self):
        """raster_pkg::CONFIG_ID of this configuration."""
        return _checked(_c.halfplane_config_id(self) or None)


def config_id(path):
    """CONFIG_ID of a design, from its raster_pkg.sv or its plain Verilog."""
    with open(path, encoding="utf-8") as file:
        found = re.search(r"CONFIG_ID (?:= )?64'h(\w+)", file.read())
    if not found:
        raise Error(f"{path} has no CONFIG_ID; give a raster_pkg.sv, or what tools/plain_verilog.sh writes")
    return int(found[1], 16)


class Scene(_Handle):
    """A capture (docs/capture.md), as text."""

    kind = "scene"

    def __init__(self, capture):
        text = capture.encode()
        super().__init__(_c.halfplane_scene_read(text, ctypes.c_size_t(len(text))))


class ArrayScene(_Handle):
    """A scene from arrays: vertices [x, y, z, w], [..., r, g, b, a] or [..., u, v] or as a Layout says, and draws of their
    indices.
    """

    kind = "scene"

    def __init__(self, width, height, lines=""):
        super().__init__(_c.halfplane_scene_new(width, height))
        self.say(lines)

    def say(self, lines):
        """Lines of a capture for the draws that follow: "space window", "state cull back"."""
        text = lines.encode()
        _checked(_c.halfplane_scene_say(self, text, ctypes.c_size_t(len(text))))

    def texture(self, name, width, height, rgba, texel_format="rgba8888", mips="none"):
        """A texture for `state texture NAME`, from a buffer of R, G, B, A, a byte each."""
        _give_texture(_c.halfplane_scene_texture, self, name, width, height, rgba, texel_format, mips)

    def vertices(self, vertices, layout=None):
        """Adds vertices; returns the index of the first."""
        used, pointer, size, count = _vertices(vertices, layout)
        return _checked(
            _c.halfplane_scene_records(
                self, ctypes.byref(used), pointer, ctypes.c_size_t(size), ctypes.c_size_t(count)
            )
        )

    def draw(self, indices, topology="triangles"):
        pointer, count = _indices(indices)
        _checked(_c.halfplane_scene_draw(self, topology.encode(), pointer, ctypes.c_size_t(count)))


def _give_texture(function, handle, name, width, height, rgba, texel_format, mips):
    pointer, size = _bytes_of(rgba)
    if size != 4 * width * height:
        raise Error(f"texture {name}: {size} bytes for {width}x{height} texels; give 4 for each")
    _checked(function(handle, name.encode(), width, height, pointer, texel_format.encode(), mips.encode()))


class Target(_Handle):
    """A frame that stays: cleared and drawn on call by call. `planes`: near and far, where the depth mapping needs them."""

    kind = "target"

    def __init__(self, config, width, height, planes=None, threads=1):
        near_far = (ctypes.c_double * 2)(*planes) if planes else None
        super().__init__(_c.halfplane_target_new(config, width, height, near_far))
        self.width, self.height = width, height
        _checked(_c.halfplane_target_set_threads(self, threads))

    def say(self, lines):
        """Lines of a capture for the draws that follow: "space window", "state cull back"."""
        text = lines.encode()
        _checked(_c.halfplane_target_say(self, text, ctypes.c_size_t(len(text))))

    def texture(self, name, width, height, rgba, texel_format="rgba8888", mips="none"):
        """As ArrayScene.texture(); one that has the name already is replaced."""
        _give_texture(_c.halfplane_target_texture, self, name, width, height, rgba, texel_format, mips)

    def clear(self, color=None, depth=None, stencil=None):
        """Clears what is given, inside the scissor that was said: r g b a of 0 to 255, a window z, 0 to 255."""
        channels = (ctypes.c_double * 4)(*color) if color is not None else None
        z = ctypes.byref(ctypes.c_double(depth)) if depth is not None else None
        _checked(_c.halfplane_target_clear(self, channels, z, -1 if stencil is None else stencil))

    def draw(self, vertices, layout=None, indices=None, topology="triangles"):
        """Draws vertices as of ArrayScene.vertices(), in their order or as `indices` say."""
        used, pointer, size, count = _vertices(vertices, layout)
        index, indexed = _indices(indices) if indices is not None else (None, 0)
        if indices is not None and indexed == 0:
            return
        _checked(
            _c.halfplane_target_draw(
                self,
                topology.encode(),
                ctypes.byref(used),
                pointer,
                ctypes.c_size_t(size),
                ctypes.c_size_t(count),
                index,
                ctypes.c_size_t(indexed),
            )
        )

    def draw_scene(self, scene):
        _checked(_c.halfplane_target_draw_scene(self, scene))

    def plane(self, name, into=None):
        """As Frame.plane(), of the frame so far."""
        return _plane(_c.halfplane_target_plane, self, name, self.width * self.height, into)

    def counter(self, name):
        """Of the last draw."""
        return _checked(_c.halfplane_target_counter(self, name.encode()))


class Frame(_Handle):
    """A scene drawn by an engine: functional, scalar, cycle or golden."""

    kind = "frame"

    def __init__(self, scene, config, engine="functional", threads=1):
        super().__init__(_c.halfplane_render_threads(scene, config, engine.encode(), threads))
        self.width = _checked(_c.halfplane_frame_width(self))
        self.height = _checked(_c.halfplane_frame_height(self))

    def plane(self, name, into=None):
        """Codes, row by row from the top: "depth", "color" or "stencil". A memoryview of 32-bit words: of `into`, a buffer that
        can be written and holds them, or of memory of its own.
        """
        return _plane(_c.halfplane_frame_plane, self, name, self.width * self.height, into)

    def counter(self, name):
        return _checked(_c.halfplane_frame_counter(self, name.encode()))


def _number(words):
    return sum(word << 32 * i for i, word in enumerate(words))


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
        """Fields by name, of the words of a packet or of the whole as one number."""
        value, fields = words if isinstance(words, int) else _number(words), {}
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


class Host(_Handle):
    """The packets that raster_top gets for a scene, from a fast clear to the flush: `for primitive, line in Host(...)`,
    each one number, the packed struct; line is None but of a primitive of kind line.
    """

    kind = "host"

    def __init__(self, scene, config):
        super().__init__(_c.halfplane_host_new(scene, config))
        bits = (_checked(_c.halfplane_packet_bits(config, arrow)) for arrow in (b"primitive", b"line"))
        self._primitive, self._line = ((ctypes.c_uint32 * ((b + 31) // 32))() for b in bits)

    def __iter__(self):
        while got := _checked(_c.halfplane_host_next(self, self._primitive, self._line)):
            yield _number(self._primitive), _number(self._line) if got == 2 else None


class Event(ctypes.Structure):
    """A sample that was written (kind WRITES), or a primitive that is through (RETIRED): halfplane.h."""

    _fields_ = [(n, ctypes.c_uint32) for n in "kind primitive x y sample parts depth stencil color".split()]


class Pipeline(_Handle):
    """raster_top from reset with its memory: what a design is held against. Packets are one number, the packed struct.
    `design_id`: CONFIG_ID of the design, as config_id() reads it. `outputs`: a sum of WRITES, RETIRED and BEATS; what is
    named is kept until it is taken.
    """

    kind = "pipeline"
    WRITES, RETIRED, BEATS = 1, 2, 4
    DEPTH, COLOR = 1, 2

    def __init__(self, config, design_id, outputs):
        super().__init__(_c.halfplane_pipeline_new(config, ctypes.c_uint64(design_id), outputs))
        self._words = {}
        for arrow in ("primitive", "line", "beat"):
            self._words[arrow] = (_checked(_c.halfplane_packet_bits(config, arrow.encode())) + 31) // 32

    def _packet(self, arrow, number):
        count = self._words[arrow]
        return (ctypes.c_uint32 * count)(*(number >> 32 * i & 0xFFFFFFFF for i in range(count)))

    def put_primitive(self, number):
        _checked(_c.halfplane_pipeline_put_primitive(self, self._packet("primitive", number)))

    def put_line(self, number):
        _checked(_c.halfplane_pipeline_put_line(self, self._packet("line", number)))

    def event(self):
        """The next Event, or None when there is none before more is put in."""
        event = Event()
        return event if _checked(_c.halfplane_pipeline_get_event(self, ctypes.byref(event))) else None

    def beat(self):
        """The next memory_beat_t as a number, or None."""
        words = self._packet("beat", 0)
        return _number(words) if _checked(_c.halfplane_pipeline_get_beat(self, words)) else None

    @property
    def layout(self):
        """Bases of depth, colour and their flags, bytes between rows of tiles. May be set before the first primitive."""
        values = (ctypes.c_uint32 * 5)()
        _checked(_c.halfplane_pipeline_layout(self, values))
        return tuple(values)

    @layout.setter
    def layout(self, values):
        _checked(_c.halfplane_pipeline_set_layout(self, (ctypes.c_uint32 * 5)(*values)))

    def memory(self, address=0, count=None):
        """Bytes of memory as the hardware leaves them: all of them, or `count` from an address on."""
        count = _checked(_c.halfplane_pipeline_memory_size(self)) - address if count is None else count
        return self._bytes(_c.halfplane_pipeline_memory, address, count)

    def texels(self, address, count):
        return self._bytes(_c.halfplane_pipeline_texels, address, count)

    def _bytes(self, function, address, count):
        room = (ctypes.c_uint8 * count)()
        _checked(function(self, ctypes.c_uint32(address), room, ctypes.c_size_t(count)))
        return bytes(room)

    def textures(self, scene):
        """From now on the texture memory holds the textures of `scene`."""
        _checked(_c.halfplane_pipeline_textures(self, scene))

    def plane(self, name, width, height, into=None):
        """As Frame.plane(), of the picture in memory. After a flush."""
        return _plane(_c.halfplane_pipeline_plane, self, name, width * height, into)
