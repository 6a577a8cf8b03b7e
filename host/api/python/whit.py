"""whit from Python: pictures, ids and rays of an installed libwhit, by ctypes alone.

    import whit
    scene = whit.Scene("part.stl")
    renderer = whit.Renderer(scene, width=256, height=192, samples=4, numerics="exact")
    color = renderer.render()            # memoryview, [y, x, channel]: linear RGB and alpha, float32
    ids = renderer.ids()                 # memoryview, [y, x, 0 or 1]: instance, primitive, uint32
    hits = renderer.trace([((0, 0, 9), (0, 0, -1))])
    if not hits[0].missed:
        print(scene.instances[hits[0].instance], hits[0].primitive, hits[0].t)

numpy.asarray() makes arrays of all of these without a copy, and `out=` takes an array of one's own. What goes wrong
is an Error with whit's own message; warnings go to logging.getLogger("whit"). An object is used by one thread at a
time, but renderers of several threads may share a scene and a device. It lives as long as what was made from it, and
close() or `with` lets go of it. A child of os.fork() makes objects of its own, and ends by os._exit(), as those of
multiprocessing do. Names of parameters, units and defaults are those of whit.h, and words of enumerations are the last
ones of its names: numerics="exact" is WHIT_NUMERICS_EXACT.

The library is $WHIT_LIBRARY, or the libwhit.so of the prefix that this file is installed in, or else the system's.
"""

import atexit
import ctypes
import glob
import logging
import os
import re
import sys
import threading
import types
import weakref
from ctypes import c_bool, c_char, c_char_p, c_double, c_float, c_uint, c_uint8, c_uint32, c_uint64, c_void_p
from enum import IntEnum
from numbers import Integral

VERSION = "0.2.0"  # of the library that this file goes with, in its first two numbers
NONE = 0xFFFFFFFF  # no primitive, no instance: a miss
CPU = object()  # in the place of a device: rays alone, traced by the device's twin in C

# ---- What whit.h declares (a test holds all of it against that header) ----


# Enumeration and struct SceneInfo stand for whit_scene_info.
def _enumeration(name, words):
    return IntEnum(name, words.split(), start=0)


Result = _enumeration("Result", "OK ERROR_FAILED ERROR_USAGE ERROR_INPUT ERROR_OUTPUT ERROR_NO_DEVICE"
                      " ERROR_DEVICE ERROR_MEMORY ERROR_STATUS ERROR_TIME_LIMIT ERROR_CANCELLED")
LogLevel = _enumeration("LogLevel", "ERROR WARNING INFO DEBUG")
Up = _enumeration("Up", "Y X Z MINUS_X MINUS_Y MINUS_Z AUTO")
Lights = _enumeration("Lights", "AUTO FILE NONE KEY")
EnvironmentKind = _enumeration("EnvironmentKind", "GRADIENT MAP")
DeviceKind = _enumeration("DeviceKind", "DISCRETE INTEGRATED VIRTUAL CPU OTHER")
CameraKind = _enumeration("CameraKind", "PERSPECTIVE ORTHOGRAPHIC PANORAMA")
Traversal = _enumeration("Traversal", "DISTANCE SIGN BASIC")
Numerics = _enumeration("Numerics", "WATERTIGHT FAST EXACT")
Shadows = _enumeration("Shadows", "TINTED OPAQUE NONE")
SamplingKind = _enumeration("SamplingKind", "FIXED ADAPTIVE")
Minification = _enumeration("Minification", "MIPMAP NONE")
LoadPath = _enumeration("LoadPath", "AUTO STORAGE TEXEL")
Packets = _enumeration("Packets", "AUTO ON OFF")
Classes = _enumeration("Classes", "AUTO ONE MANY")
TraceOn = _enumeration("TraceOn", "DEVICE CPU_FLOAT CPU_BRUTE")
Aov = _enumeration("Aov", "COLOR IDS CUTS DISTANCES")
# What their enumerators begin with, where that is not the type's name.
PREFIXES = {Result: "WHIT", LogLevel: "WHIT_LOG", EnvironmentKind: "WHIT_ENVIRONMENT", DeviceKind: "WHIT_DEVICE",
            CameraKind: "WHIT_CAMERA", SamplingKind: "WHIT_SAMPLING", LoadPath: "WHIT_LOAD", TraceOn: "WHIT_TRACE"}

_LogFn = ctypes.CFUNCTYPE(None, c_void_p, c_uint, c_char_p)
_ProgressFn = ctypes.CFUNCTYPE(None, c_void_p, c_double)


def _struct(name, *members):
    """The struct `name`, of (names, type); an enumeration takes its words too."""
    fields = [(field, kind) for names, kind in members for field in names.split()]
    plain = [(field, c_uint if isinstance(kind, type(Result)) else kind) for field, kind in fields]
    return type(name, (ctypes.Structure,), {"_fields_": plain, "kinds": dict(fields)})


Log = _struct("Log", ("fn", _LogFn), ("user", c_void_p), ("level", LogLevel))
Camera = _struct("Camera", ("name", c_char_p), ("own", c_bool), ("kind", CameraKind),
                 ("eye target up", c_double * 3), ("fov_y_degrees height lens_radius focus_distance", c_double))
Sampling = _struct("Sampling", ("kind", SamplingKind), ("count first count_max", c_uint32), ("contrast", c_double))
LoadParams = _struct(
    "LoadParams", ("up", Up), ("lights", Lights), ("clip environment", c_char_p), ("has_background", c_bool),
    ("background", c_uint8 * 3), ("import_limit_s time_limit_s", c_double), ("require_sandbox", c_bool),
    ("memory_limit_bytes", c_uint64), ("texture_limit", c_uint32), ("cancel", c_void_p),
    ("allowed_folders", ctypes.POINTER(c_char_p)), ("allowed_count", c_uint32), ("refused", c_void_p),
    ("found found_user", c_void_p))
SceneInfo = _struct(
    "SceneInfo",
    ("mesh_count instance_count node_count material_count texture_count light_count camera_count note_count"
     " effect_count textures_missing", c_uint32),
    ("mesh_triangle_count triangle_count sphere_count file_bytes hash", c_uint64), ("channel_count", c_uint32),
    ("time_begin_s time_end_s", c_double), ("one_tree", c_bool),
    ("lo hi objects_lo objects_hi home_lo home_hi", c_double * 3),
    ("environment", EnvironmentKind), ("environment_made_by_whit", c_bool), ("exposure_ev", c_double))
InstanceInfo = _struct("InstanceInfo", ("name", c_char_p), ("mesh", c_uint32),
                       ("object_to_world", c_double * 12))
CameraInfo = _struct("CameraInfo", ("name", c_char_p), ("kind", CameraKind), ("eye target up", c_double * 3),
                     ("fov_y_degrees height lens_radius focus_distance", c_double),
                     ("target_is_direction made_by_whit", c_bool))
DeviceParams = _struct("DeviceParams", ("selector", c_char_p), ("validation", c_bool))
DeviceInfo = _struct(
    "DeviceInfo", ("index", c_uint32), ("name driver", c_char * 256), ("api_version", c_char * 32),
    ("kind", DeviceKind), ("memory_bytes max_storage_range_bytes", c_uint64), ("subgroup_size", c_uint32),
    ("float64 int64 timestamps usable automatic", c_bool), ("why_not", c_char * 128))
RendererParams = _struct(
    "RendererParams", ("width height first_row row_count", c_uint32), ("camera", Camera),
    ("time_s", c_double), ("sampling", Sampling), ("depth", c_uint32), ("bailout", c_double), ("shadows", Shadows),
    ("light_samples", c_uint32), ("schlick", c_bool), ("minification", Minification), ("portable", c_bool),
    ("exposure_ev", c_double),
    ("soft_highlights all_effects", c_bool), ("effects_added effects_removed", c_uint64),
    ("compile_async many_pictures keep_unread reuse_rays few_pixels time_stages color_only", c_bool),
    ("tile_size", c_uint32), ("cancel", c_void_p),
    ("progress", _ProgressFn), ("progress_user", c_void_p), ("step_spacing step_aov", c_uint32),
    ("step", c_void_p), ("time_limit_s", c_double), ("load_path", LoadPath), ("traversal", Traversal),
    ("numerics", Numerics), ("packets", Packets), ("classes", Classes), ("segments node_bytes", c_uint32), ("count", c_bool),
    ("shader", c_void_p), ("sliders", c_char_p), ("skip_sliders", c_bool), ("trace_rays", c_uint32))
ImageInfo = _struct("ImageInfo", ("width height channels", c_uint32), ("integers", c_bool))
Ray = _struct("Ray", ("origin", c_float * 3), ("t_min", c_float), ("dir", c_float * 3), ("t_max", c_float))
Hit = _struct("Hit", ("t u v", c_float), ("primitive instance", c_uint32), ("ng", c_float * 3))
Hit.missed = property(lambda hit: hit.primitive == NONE)
STRUCTS = [Log, Camera, Sampling, LoadParams, SceneInfo, InstanceInfo, CameraInfo, DeviceParams, DeviceInfo,
           RendererParams, ImageInfo, Ray, Hit]

PROTOTYPES = """
const char *whit_version(void);
const char *whit_result_name(whit_result result);
whit_result whit_scene_load(const char *path, const whit_load_params *params, const whit_log *log, whit_scene **out);
void whit_scene_destroy(whit_scene *scene);
void whit_scene_get_info(const whit_scene *scene, whit_scene_info *info);
void whit_scene_get_instance(const whit_scene *scene, uint32_t index, whit_instance_info *info);
void whit_scene_get_camera(const whit_scene *scene, uint32_t index, whit_camera_info *info);
whit_result whit_accel_create(const whit_scene *scene, const whit_accel_params *params, whit_accel **out);
void whit_accel_destroy(whit_accel *accel);
whit_result whit_device_create(const whit_device_params *params, const whit_log *log, whit_device **out);
void whit_device_destroy(whit_device *device);
void whit_device_get_info(const whit_device *device, whit_device_info *info);
whit_renderer_params whit_renderer_defaults(void);
whit_result whit_renderer_create(whit_device *device, whit_accel *accel, const whit_renderer_params *params,
                                 whit_renderer **out);
void whit_renderer_destroy(whit_renderer *renderer);
whit_result whit_renderer_render(whit_renderer *renderer);
whit_result whit_renderer_render_views(whit_renderer *renderer, const whit_camera *cameras, uint32_t count);
whit_result whit_renderer_image(whit_renderer *renderer, whit_aov aov, whit_image **out);
void whit_image_get_info(const whit_image *image, whit_image_info *info);
const float *whit_image_floats(const whit_image *image);
const uint32_t *whit_image_words(const whit_image *image);
whit_result whit_image_save(const whit_image *image, const char *path, const whit_text *texts, uint32_t text_count,
                            const whit_log *log);
void whit_image_destroy(whit_image *image);
whit_result whit_trace(whit_renderer *renderer, whit_trace_on on, const whit_ray *rays, uint64_t count, bool any,
                       whit_hit *hits, whit_cost *cost);
"""

# ---- The library ----

_TYPES = {"void": None, "bool": c_bool, "double": c_double, "uint32_t": c_uint32, "uint64_t": c_uint64,
          "whit_renderer_params": RendererParams}


def _type_of(text):
    """Of "const char *path" or "uint32_t": all pointers but texts are void *, enumerations are unsigned."""
    words = text.replace("const ", "").split()
    if "*" in text:
        return c_char_p if words[0] == "char" else c_void_p
    return _TYPES.get(words[0], c_uint)


def _candidates():
    name = "libwhit.so." + ".".join(VERSION.split(".")[:2])
    prefix = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", ".."))
    if "WHIT_LIBRARY" in os.environ:
        return [os.environ["WHIT_LIBRARY"]]
    return sorted(glob.glob(glob.escape(prefix) + "/lib*/" + name) +
                  glob.glob(glob.escape(prefix) + "/lib*/*/" + name)) + [name]


def _load():
    path = _candidates()[0]
    library = ctypes.CDLL(path)
    try:
        library.whit_version.restype = c_char_p
        version = library.whit_version().decode()
    except AttributeError:
        version = "an older version"
    if version.split(".")[:2] != VERSION.split(".")[:2]:
        raise ImportError(f"{__file__} is for libwhit {VERSION}, and {path} is {version}")
    for result, name, parameters in re.findall(r"([^;]*?\W)(whit_\w+)\(([^)]*)\);", PROTOTYPES):
        function = getattr(library, name)
        function.restype = _type_of(result)
        function.argtypes = [_type_of(one) for one in parameters.split(",") if one != "void"]
    return library


_library = _load()


class Error(Exception):
    """What whit refused or could not do, in its own words. `result`: a Result, which tells the kind."""

    def __init__(self, result, lines):
        self.result = Result(result)
        super().__init__("\n".join(lines) or _library.whit_result_name(result).decode())

    def __reduce__(self):
        return Error, (self.result, str(self).splitlines())


class _Hearing:
    """Where a handle's messages go: errors are kept for the exception, others are logged."""

    def __init__(self):
        self.errors = []  # (thread, text)
        self.lock = threading.Lock()
        self._fn = _LogFn(self._hear)
        self.log = Log(fn=self._fn, level=LogLevel.WARNING)

    def _hear(self, _user, level, text):
        text = text.decode("utf-8", "replace")
        if level == LogLevel.ERROR:
            with self.lock:
                self.errors.append((threading.get_ident(), text))
        else:
            logging.getLogger("whit").warning("%s", text)


def _take_errors(hearings):
    """The errors of this thread's calls, and of threads that only the library knows; those of others stay."""
    lines = []
    for hearing in hearings:
        # A thread of the library that has logged something counts as a thread of Python's too, as a dummy.
        others = {one.ident for one in threading.enumerate() if not isinstance(one, threading._DummyThread)}
        with hearing.lock:
            kept = [error for error in hearing.errors if error[0] in others - {threading.get_ident()}]
            lines += [error[1] for error in hearing.errors if error not in kept]
            hearing.errors[:] = kept
    return lines


def _check(result, *hearings):
    lines = _take_errors(hearings)
    if result != Result.OK:
        raise Error(result, lines)


class _Handle(c_void_p):
    """What a function of libwhit made, and another ends."""


_living = {}  # finalizers of handles by address, in the order in which they were made


def _release(destroy, address, process, _kept):
    del _living[address]
    if process == os.getpid():  # a child of fork() has handles of its parent, but not the threads behind them
        destroy(address)


def _make(create, destroy, *arguments, hearings, keep, cancel=None):
    """The handle that `create` gives, which `cancel` stops. Once nothing uses it `destroy` ends it, and what it borrows
    is kept until then."""
    handle = _Handle()
    with _Calling(cancel):
        _check(create(*arguments, ctypes.byref(handle)), *hearings)
        release = weakref.finalize(handle, _release, destroy, handle.value, os.getpid(), keep)
        release.atexit = False
        _living[handle.value] = release
    return handle


class _Calling:
    """A call that uses handles. Before these are destroyed at the interpreter's end, calls in daemon threads are
    cancelled, which ends the threads, and none begins any more."""

    idle = threading.Condition()
    running = set()
    ending = False

    def __init__(self, cancel=None):
        self._cancel = cancel

    def __enter__(self):
        with self.idle:
            if self.ending:
                raise Error(Result.ERROR_CANCELLED, ["the interpreter ends"])
            self.running.add(self)

    def __exit__(self, *_):
        with self.idle:
            self.running.discard(self)
            self.idle.notify_all()
        if self.ending:
            raise SystemExit

    @classmethod
    def end(cls):
        with cls.idle:
            cls.ending = True
            for call in cls.running:
                if call._cancel is not None:
                    call._cancel.value = True
            if not cls.idle.wait_for(lambda: not cls.running, timeout=10.0):
                return
        for release in reversed(list(_living.values())):
            release()

    @classmethod
    def forked(cls):
        cls.idle, cls.running = threading.Condition(), set()


atexit.register(_Calling.end)
os.register_at_fork(after_in_child=_Calling.forked)


class _Closing:
    """What has a handle: close(), or the end of a `with` block, lets go of it. What was made from it can still be
    used."""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.handle = None

    def _opened(self):
        if self.handle is None:
            raise ValueError(f"{type(self).__name__}: it is closed")
        return self.handle


# ---- Parameters ----


def _text(name, value):
    """The bytes of a text or path."""
    text = os.fsencode(value)
    if b"\0" in text:
        raise ValueError(f"{name}: {value!r} has a null character")
    return text


def _of_length(name, count, values):
    if len(values) != count:
        raise ValueError(f"{name}: {count} numbers are needed")
    return tuple(values)


def _number(name, kind, value):
    if isinstance(kind, type(Result)) and isinstance(value, str):
        words = [word.lower().replace("_", "-") for word in kind.__members__]
        if value.lower().replace("_", "-") not in words:
            raise ValueError(f"{name}: {value!r} is none of {', '.join(words)}")
        return words.index(value.lower().replace("_", "-"))
    whole = c_uint if isinstance(kind, type(Result)) else kind
    if whole in (c_uint, c_uint8, c_uint32, c_uint64) and not 0 <= value < 1 << 8 * ctypes.sizeof(whole):
        raise ValueError(f"{name}: {value} is out of range")
    if kind is c_bool and value not in (False, True):
        raise ValueError(f"{name}: {value!r} is neither True nor False")
    return value


# Kinds and names of members that only this file sets.
_INNER = (None, c_void_p, _ProgressFn, ctypes.POINTER(c_char_p), "has_background", "allowed_count")


def _fill(params, values):
    """Sets members of `params` by name; None leaves a default."""
    for name, value in values.items():
        kind = params.kinds.get(name)
        if kind in _INNER or name in _INNER:
            names = sorted(one for one, its in params.kinds.items() if its not in _INNER and one not in _INNER)
            raise TypeError(f"there is no parameter {name!r}; there are {', '.join(names)}")
        if value is None:
            continue
        if kind is c_char_p:
            value = _text(name, value)
        elif isinstance(kind, type(ctypes.Structure)):
            _fill(getattr(params, name), value)
            continue
        elif isinstance(kind, type(c_uint8 * 3)):
            value = kind(*(_number(name, kind._type_, one) for one in _of_length(name, kind._length_, value)))
        else:
            value = _number(name, kind, value)
        setattr(params, name, value)


# ---- Scenes and devices ----


def _told(info):
    """What a struct says: texts are str, arrays tuples, enumerators those of their class."""
    told = types.SimpleNamespace()
    for name, kind in info.kinds.items():
        value = getattr(info, name)
        if isinstance(value, bytes):
            value = os.fsdecode(value)
        elif isinstance(kind, type(Result)):
            value = kind(value)
        elif isinstance(value, ctypes.Array):
            value = tuple(value)
        setattr(told, name, value)
    return told


class Scene(_Closing):
    """A file of a scene or a model. Parameters are those of whit_load_params, of which `background` is a colour of
    three bytes; `allow`: a further folder that may be read, or several. `info` has the members of whit_scene_info."""

    def __init__(self, path, *, allow=(), **params):
        load = LoadParams()
        _fill(load, params)
        load.has_background = params.get("background") is not None
        allow = [allow] if isinstance(allow, (str, bytes, os.PathLike)) else allow
        load.allowed_folders = (c_char_p * len(allow))(*(_text("allow", folder) for folder in allow))
        load.allowed_count = len(allow)
        cancel = c_bool(False)
        load.cancel = ctypes.addressof(cancel)
        self._hearing = _Hearing()
        self.handle = _make(_library.whit_scene_load, _library.whit_scene_destroy, _text("path", path),
                            ctypes.byref(load), ctypes.byref(self._hearing.log), hearings=[self._hearing],
                            keep=self._hearing, cancel=cancel)
        info = SceneInfo()
        _library.whit_scene_get_info(self.handle, ctypes.byref(info))
        self.info = _told(info)
        self.instances = self._names(InstanceInfo, _library.whit_scene_get_instance, self.info.instance_count)
        self.cameras = self._names(CameraInfo, _library.whit_scene_get_camera, self.info.camera_count)

    def _names(self, info, get, count):
        names, one = [], info()
        for index in range(count):
            get(self.handle, index, ctypes.byref(one))
            names.append(os.fsdecode(one.name))
        return names


class Device(_Closing):
    """A Vulkan device: by number, or part of a name; None: the one that whit takes by itself. `info` has the members
    of whit_device_info."""

    def __init__(self, selector=None, *, validation=False):
        params = DeviceParams(None if selector is None else _text("selector", str(selector)), validation)
        self._hearing = _Hearing()
        self.handle = _make(_library.whit_device_create, _library.whit_device_destroy, ctypes.byref(params),
                            ctypes.byref(self._hearing.log), hearings=[self._hearing], keep=self._hearing)
        info = DeviceInfo()
        _library.whit_device_get_info(self.handle, ctypes.byref(info))
        self.info = _told(info)


# ---- Pictures and rays ----


def _copy(source, count, kind, shape, out):
    """`count` numbers of 4 bytes at `source`, of `kind` "f" or "I", in `out`, or in memory of their own."""
    memory = bytearray(4 * count) if out is None else out
    view = memoryview(memory)
    if view.readonly or not view.c_contiguous or view.nbytes != 4 * count or \
            view.format.lstrip("<=@") not in (kind, "B") or view.ndim != 1 and view.shape != shape:
        raise ValueError(f"out: {count} numbers of the format {kind!r} in the shape {shape}, side by side and "
                         f"writable, are needed; it has {view.nbytes} bytes of the format {view.format!r} in the "
                         f"shape {view.shape}")
    ctypes.memmove((c_char * view.nbytes).from_buffer(memory), source, view.nbytes)
    return view.cast(kind, shape) if out is None else out


def _rays_of(rays):
    """Rays * n of (origin, dir) or (origin, dir, t_min, t_max) each, or of n * 8 floats in the order of whit_ray."""
    try:
        view = memoryview(rays)
    except TypeError:
        rays = [(origin, *(span or (0.0, float("inf"))), direction) for origin, direction, *span in rays]
        vector = c_float * 3
        return (Ray * len(rays))(*(Ray(vector(*_of_length("origin", 3, o)), low,
                                       vector(*_of_length("dir", 3, d)), high) for o, low, high, d in rays))
    bytes_each = ctypes.sizeof(Ray)
    whole = view.itemsize == bytes_each or view.ndim <= 1 or view.shape[-1] * view.itemsize == bytes_each
    letters = set(re.sub(r":[^:]*:|[T{}()<=@0-9,]", "", view.format))  # of a struct too: "T{(3)<f:origin:<f:t_min:...}"
    if not view.c_contiguous or view.nbytes % bytes_each or not whole or letters not in ({"f"}, {"B"}):
        raise ValueError("rays: 8 floats of 32 bits each are needed: origin, t_min, direction, t_max")
    return (Ray * (view.nbytes // bytes_each)).from_buffer_copy(view if view.nbytes else b"")


class _Progress:
    """How far a picture is, told to `tell`; what that raises ends the picture, as Ctrl+C does: no exception may pass
    through C."""

    def __init__(self, tell):
        self.cancel = c_bool(False)
        self.raised = None
        self._tell = tell
        this = weakref.ref(self)  # the renderer's handle keeps `fn`, while `tell` may refer to the renderer
        self.fn = _ProgressFn(lambda _user, done: this()._go_on(done))

    def _stop(self, raised):
        self.raised = raised
        self.cancel.value = True

    def _go_on(self, done):
        try:
            if self._tell:
                self._tell(done)
        except BaseException as raised:  # pylint: disable=broad-except
            self._stop(raised)

    def run(self, function, *arguments):
        """What `function` gives. Python may raise Ctrl+C as a function that C calls begins, before its `try`; then it
        goes to sys.unraisablehook. It does so in the main thread alone, and no other thread changes the hook here."""
        main = threading.main_thread()
        if threading.current_thread() is not main:
            return function(*arguments)
        hook = sys.unraisablehook

        def stop(what):
            if "ctypes callback" in (what.err_msg or "") and threading.current_thread() is main:
                self._stop(what.exc_value)
            else:
                hook(what)

        try:
            sys.unraisablehook = stop
            return function(*arguments)
        finally:
            sys.unraisablehook = hook


def _camera_of(camera):
    """Members of whit_camera: of a name or number, of four values, or as they are."""
    if isinstance(camera, dict):
        camera = {key: value for key, value in camera.items() if value is not None}
        return {"own": bool(camera.keys() - {"name"}), **camera}
    if camera is None:
        return {}
    if isinstance(camera, (str, Integral)):
        return {"name": str(camera)}
    members = ("eye", "target", "up", "fov_y_degrees")
    if len(camera) != len(members):
        raise ValueError(f"camera: {camera!r} is not (eye, target, up, vertical degrees)")
    return {"own": True, **dict(zip(members, camera))}


class Renderer(_Closing):
    """Pictures of a scene. `device`: a Device, a selector of one, None, or CPU. `camera`: the name or number of one of
    the scene's, (eye, target, up, vertical degrees), or a dict of members of whit_camera, whose `own` is true where it
    has more than a name. `samples` of a pixel. `progress`: called with the share done, 0 to 1. Further parameters are
    those of whit_renderer_params."""

    def __init__(self, scene, device=None, *, camera=None, samples=None, progress=None, **params):
        if not isinstance(scene, Scene):
            raise TypeError(f"scene: {scene!r} is no whit.Scene")
        if samples is not None and params.get("sampling") is not None:
            raise TypeError("samples and sampling: one of them")
        self.scene = scene
        self.device = device if isinstance(device, Device) or device is CPU else Device(device)
        self._hearings = [scene._hearing] + ([] if self.device is CPU else [self.device._hearing])
        self._progress = _Progress(progress)
        self._params = _library.whit_renderer_defaults()
        _fill(self._params, {**params, "camera": _camera_of(camera)})
        _fill(self._params.sampling, {"count": samples})
        self._views = ()
        self._params.progress = self._progress.fn
        self._params.cancel = ctypes.addressof(self._progress.cancel)
        on, within = None if self.device is CPU else self.device._opened(), scene._opened()
        accel = _make(_library.whit_accel_create, _library.whit_accel_destroy, within, None,
                      hearings=self._hearings, keep=within)
        self.handle = _make(_library.whit_renderer_create, _library.whit_renderer_destroy, on, accel,
                            ctypes.byref(self._params), hearings=self._hearings,
                            keep=(accel, on, self._params, self._progress.cancel), cancel=self._progress.cancel)

    def _call(self, function, *arguments):
        progress = self._progress
        progress.raised, progress.cancel.value = None, False
        with _Calling(progress.cancel):
            result = progress.run(function, self._opened(), *arguments)
        if progress.raised is not None:
            _take_errors(self._hearings)
            raise progress.raised
        _check(result, *self._hearings)

    def _with_image(self, aov, use):
        image = c_void_p()
        self._call(_library.whit_renderer_image, aov, ctypes.byref(image))
        try:
            return use(image)
        finally:
            _library.whit_image_destroy(image)

    def _array(self, aov, out):
        def copy(image):
            info = ImageInfo()
            _library.whit_image_get_info(image, ctypes.byref(info))
            shape = (info.height // (self._views or (1,))[0], info.width, info.channels)
            shape = self._views + shape
            source = (_library.whit_image_words if info.integers else _library.whit_image_floats)(image)
            return _copy(source, info.height * info.width * info.channels, "I" if info.integers else "f", shape, out)
        return self._with_image(aov, copy)

    def render(self, out=None):
        """Draws the picture. Gives `out`, or a memoryview of float32 [y, x, 4]: linear RGB and alpha, row 0 above."""
        self._call(_library.whit_renderer_render)
        self._views = ()
        return self._array(Aov.COLOR, out)

    def render_views(self, cameras, out=None):
        """Draws small pictures of many cameras together: float32 [view, y, x, 4]. What ids() and distances() give then
        begins with the view too. Best with many_pictures=True."""
        views = (Camera * len(cameras))()
        for view, camera in zip(views, cameras):
            _fill(view, _camera_of(camera))
        self._call(_library.whit_renderer_render_views, views, len(views))
        self._views = (len(views),)
        return self._array(Aov.COLOR, out)

    def distances(self, out=None):
        """How far the views' camera rays go, in world units: float32 [view, y, x, 1]; infinity: they meet nothing."""
        return self._array(Aov.DISTANCES, out)

    def ids(self, out=None):
        """What the picture's pixels hit, by their first samples: uint32 [y, x, 2], an index of scene.instances and the
        number of a primitive; NONE: nothing."""
        return self._array(Aov.IDS, out)

    def save(self, path):
        """Writes the picture that was drawn: .png, .exr or .pfm."""
        self._with_image(Aov.COLOR, lambda image: _check(_library.whit_image_save(
            image, _text("path", path), None, 0, ctypes.byref(self._hearings[-1].log)), *self._hearings))

    def trace(self, rays, *, any_hit=False, on=None):
        """Hits of rays: Hit * n. `rays`: a sequence of (origin, dir) or (origin, dir, t_min, t_max), or an array of
        n * 8 floats as whit_ray has them. `on`: a word of TraceOn; by itself the device, where there is one."""
        rays = _rays_of(rays)
        hits = (Hit * len(rays))()
        on = _number("on", TraceOn, on if on is not None else "cpu-float" if self.device is CPU else "device")
        self._call(_library.whit_trace, on, rays, len(rays), any_hit, hits, None)
        return hits
