"""whit.py over the library that was built: pictures and rays against the program's, and what goes wrong."""

import _thread
import copy
import gc
import logging
import os
import pickle
import struct
import subprocess
import sys
import threading
import weakref

import pytest
import whit

SCENES = os.environ["WHIT_SCENES"]
CUBE = SCENES + "/cube.json"
SMALL = {"width": 40, "height": 30}


@pytest.fixture(scope="module")
def renderer():
    return whit.Renderer(whit.Scene(CUBE), samples=4, **SMALL)


def pfm_of(tmp_path, *options):
    path = tmp_path / "a.pfm"
    subprocess.run([os.environ["WHIT"], "render", CUBE, "--size", "40x30", "-o", path, "-q", *options], check=True)
    head, pixels = path.read_bytes()[:16], path.read_bytes()[-40 * 30 * 12:]
    assert head.startswith(b"PF\n40 30\n-1")
    rows = [pixels[y * 480:y * 480 + 480] for y in range(30)]
    return [struct.unpack("<120f", row) for row in reversed(rows)]


def test_a_picture_is_the_programs(renderer, tmp_path):
    color = renderer.render()
    assert (color.shape, color.format) == ((30, 40, 4), "f")
    rows = pfm_of(tmp_path, "--aa", "4")
    assert all(color[y, x, c] == rows[y][3 * x + c] for y in range(30) for x in range(40) for c in range(3))
    renderer.save(tmp_path / "b.pfm")
    assert (tmp_path / "b.pfm").read_bytes() == (tmp_path / "a.pfm").read_bytes()


def test_parameters_are_the_programs(tmp_path):
    view = whit.Renderer(whit.Scene(CUBE, background=(16, 32, 48)), camera=((3, 2, 4), (0, 0, 0), (0, 1, 0), 35),
                         numerics="exact", shadows="none", depth=2, exposure_ev=1.0, **SMALL)
    rows = pfm_of(tmp_path, "--camera", "3,2,4,0,0,0,0,1,0,35", "--numerics", "exact", "--shadows", "none", "--depth",
                  "2", "--background", "#102030")
    color = view.render()
    assert all(color[y, x, c] == rows[y][3 * x + c] for y in range(30) for x in range(40) for c in range(3))


def test_ids_are_what_rays_hit(renderer):
    color, ids = renderer.render(), renderer.ids()
    assert (ids.shape, ids.format, color.nbytes) == ((30, 40, 2), "I", 19200)
    assert renderer.scene.instances[ids[15, 20, 0]]
    hits = {(ids[y, x, 0], ids[y, x, 1]) for y in range(30) for x in range(40)}
    assert len(hits) > 3


def test_views_of_many_cameras(renderer):
    cameras = [((3, 2, 4 + i), (0, 0, 0), (0, 1, 0), 35) for i in range(3)] + [0, {"eye": (3, 2, 4),
               "up": (0, 1, 0), "kind": "orthographic", "height": 3.0}]
    color = renderer.render_views(cameras)
    ids, distances = renderer.ids(), renderer.distances()
    assert (color.shape, ids.shape, distances.shape) == ((5, 30, 40, 4), (5, 30, 40, 2), (5, 30, 40, 1))
    for i, camera in enumerate(cameras):
        single = whit.Renderer(renderer.scene, camera=camera, samples=4, **SMALL)
        assert single.render().tobytes() == color.tobytes()[i * 19200:(i + 1) * 19200]
        assert single.ids().tobytes() == ids.tobytes()[i * 9600:(i + 1) * 9600]
    hit = renderer.trace([((3, 2, 4), (-3, -2, -4))])[0]
    assert abs(distances[0, 15, 20, 0] - hit.t * 29 ** 0.5) < 0.1 and distances[0, 0, 0, 0] == float("inf")
    with pytest.raises(whit.Error, match="there must be one"):
        renderer.render_views([])
    assert renderer.render().shape == (30, 40, 4)


def test_memory_of_ones_own(renderer):
    color = renderer.render()
    own = bytearray(color.nbytes)
    assert renderer.render(out=own) is own and own == color.tobytes()
    turned = memoryview(bytearray(color.nbytes)).cast("f", (40, 30, 4))
    for wrong in (bytearray(8), bytes(color.nbytes), memoryview(bytearray(color.nbytes)).cast("d"), turned):
        with pytest.raises(ValueError, match=r"4800 numbers of the format 'f' in the shape \(30, 40, 4\)"):
            renderer.render(out=wrong)


def test_rays(renderer):
    rays = [((0, 9, 0), (0, -1, 0)), ((0, 9, 0), (0, 1, 0)), ((0, 9, 0), (0, -1, 0), 0.0, 1.0)]
    hits = renderer.trace(rays)
    assert [hit.missed for hit in hits] == [False, True, True]
    assert hits[0].instance < len(renderer.scene.instances) and 0 < hits[0].t < 10
    flat = struct.pack("<24f", *(n for o, d, *s in rays for n in (*o, (s or [0])[0], *d, (s or [0, float("inf")])[1])))
    assert bytes(renderer.trace(flat)) == bytes(hits)
    twin = whit.Renderer(renderer.scene, whit.CPU)
    assert bytes(twin.trace(rays)) == bytes(hits) == bytes(twin.trace(rays, on="cpu-brute"))
    assert not renderer.trace(rays, any_hit=True)[0].missed
    assert bytes(renderer.trace(memoryview(flat).cast("f", (3, 1, 8)))) == bytes(hits)
    assert bytes(renderer.trace((whit.Ray * 3).from_buffer_copy(flat))) == bytes(hits)
    assert len(renderer.trace((whit.Ray * 0)())) == len(renderer.trace([])) == 0
    for wrong in (b"123", memoryview(bytes(96)).cast("f", (4, 2, 3)), memoryview(bytes(96)).cast("f", (4, 6))):
        with pytest.raises(ValueError, match="8 floats"):
            renderer.trace(wrong)
    for wrong in (((0, 5), (0, -1, 0)), ((0, 5, 0), (0, -1, 0, 1))):
        with pytest.raises(ValueError, match="3 numbers are needed"):
            renderer.trace([wrong])
    with pytest.raises(TypeError, match="not str"):
        renderer.trace([((0, "5", 0), (0, -1, 0))])
    for device in (0, whit.TraceOn.DEVICE):
        with pytest.raises(whit.Error, match="without a device"):
            twin.trace(rays, on=device)
    with pytest.raises(whit.Error, match="not on 7"):
        twin.trace(rays, on=7)


def test_numpy(renderer):
    numpy = pytest.importorskip("numpy")
    color = numpy.empty((30, 40, 4), numpy.float32)
    assert renderer.render(out=color) is color
    assert (color == numpy.asarray(renderer.render())).all() and color[..., 3].min() == 1
    ids = numpy.asarray(renderer.ids())
    assert ids.dtype == numpy.uint32 and ids.shape == (30, 40, 2)
    rays = numpy.array([[0, 9, 0, 0, 0, -1, 0, numpy.inf]] * 3, numpy.float32)
    hits = numpy.asarray(renderer.trace(rays))
    assert hits["t"].shape == (3,) and (hits["instance"] == hits["instance"][0]).all()
    record = [("origin", "f4", 3), ("t_min", "f4"), ("dir", "f4", 3), ("t_max", "f4")]
    assert (numpy.asarray(renderer.trace(rays.view(record)[:, 0])) == hits).all()
    with pytest.raises(ValueError, match="8 floats"):
        renderer.trace(rays.view([("numbers", "i4", 8)]))
    assert renderer.render_views(numpy.arange(1)).tobytes() == color.tobytes()
    with pytest.raises(ValueError, match="of the format 'f'"):
        renderer.render(out=color.astype(numpy.float64))


def test_what_goes_wrong_says_why(renderer, tmp_path):
    with pytest.raises(whit.Error, match="nowhere.stl: there is no such file") as raised:
        whit.Scene("nowhere.stl")
    assert raised.value.result == whit.Result.ERROR_INPUT
    scene = whit.Scene(CUBE)
    whit.Renderer(scene, camera={"name": "0", "fov_y_degrees": None}).render()
    with pytest.raises(whit.Error, match="camera .nobody.: the scene has 1 cameras"):
        whit.Renderer(scene, camera="nobody")
    with pytest.raises(whit.Error) as raised:
        whit.Renderer(scene, "no such device")
    assert raised.value.result == whit.Result.ERROR_NO_DEVICE and "no such device" in str(raised.value)
    with pytest.raises(whit.Error, match="without a device"):
        whit.Renderer(scene, whit.CPU).render()
    with pytest.raises(ValueError, match="numerics: 'fine' is none of watertight, fast, exact"):
        whit.Renderer(scene, numerics="fine")
    with pytest.raises(ValueError, match="width: -1 is out of range"):
        whit.Renderer(scene, width=-1)
    with pytest.raises(TypeError, match="no parameter 'hight'; there are .*height") as raised:
        whit.Renderer(scene, hight=3)
    assert not {"cancel,", "progress,", "step,", "shader,"} & set(str(raised.value).split())
    for call in (lambda: whit.Scene(CUBE + "\0.obj"), lambda: whit.Scene(CUBE, allow="/\0"),
                 lambda: whit.Renderer(scene, camera="0\0"), lambda: whit.Device("0\0"),
                 lambda: renderer.save(tmp_path / "a.png\0.exr")):
        with pytest.raises(ValueError, match="has a null character"):
            call()
    with pytest.raises(whit.Error, match="/nowhere: cannot be allowed"):
        whit.Scene(CUBE, allow="/nowhere")


def test_threads_get_their_own_errors(renderer, monkeypatch):
    create, both, said = whit._library.whit_renderer_create, threading.Barrier(2, timeout=30), {}

    def create_and_wait(*arguments):
        result = create(*arguments)
        both.wait()
        return result

    def refuse(count):
        try:
            whit.Renderer(renderer.scene, whit.CPU, samples=count)
        except whit.Error as error:
            said[count] = str(error)

    monkeypatch.setattr(whit._library, "whit_renderer_create", create_and_wait)
    threads = [threading.Thread(target=refuse, args=(count,)) for count in (5001, 5002)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert said == {count: f"{count} samples a pixel: must be 1..4096" for count in (5001, 5002)}


def test_warnings_are_logged(tmp_path, caplog):
    (tmp_path / "a.obj").write_text("mtllib no.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with caplog.at_level(logging.WARNING, "whit"):
        whit.Scene(tmp_path / "a.obj")
    assert "no.mtl" in caplog.text


def test_progress_can_stop(renderer):
    class Stop(Exception):
        pass

    def progress(done):
        assert 0 <= done <= 1
        raise Stop

    with pytest.raises(Stop):
        whit.Renderer(renderer.scene, progress=progress, tile_size=16, **SMALL).render()


def test_an_interrupt_at_the_entry_of_a_callback_ends_the_picture(renderer):
    shares, returns = [], threading.Semaphore(0)
    interrupter = threading.Thread(target=lambda: (returns.acquire(), _thread.interrupt_main()))
    interrupter.start()

    def progress(done):
        shares.append(done)
        if len(shares) == 1:
            returns.release()  # the interrupt comes about when C goes on, and is raised as the next call begins
        else:
            interrupter.join()

    drawn = whit.Renderer(renderer.scene, progress=progress, tile_size=16, **SMALL)
    with pytest.raises(KeyboardInterrupt):
        drawn.render()
    stopped = len(shares)
    drawn.render()
    assert stopped <= 2 < len(shares) - stopped


def test_what_is_borrowed_goes_last(monkeypatch):
    gone = []

    def listen(name):
        destroy = getattr(whit._library, name)
        monkeypatch.setattr(whit._library, name, lambda handle: (gone.append(name.split("_")[1]), destroy(handle)))

    for kind in ("scene", "accel", "device", "renderer"):
        listen(f"whit_{kind}_destroy")
    scene = whit.Scene(CUBE)
    scene.cycle = whit.Renderer(scene, **SMALL)
    del scene
    gc.collect()
    assert sorted(gone) == ["accel", "device", "renderer", "scene"] and gone[0] == "renderer"
    assert gone.index("accel") < gone.index("scene")


def test_what_the_callback_refers_to_is_freed(renderer):
    def draw():
        drawn = whit.Renderer(renderer.scene, progress=lambda done: drawn, **SMALL)
        drawn.render()
        return weakref.ref(drawn)

    gone = draw()
    gc.collect()
    assert gone() is None


ENDS = """
import os, sys, threading, time, whit
begun = threading.Event()
scene = whit.Scene(sys.argv[1])
drawn = whit.Renderer(scene, width=40, height=30, samples=4096, tile_size=16, progress=lambda done: begun.set())
if sys.argv[2] == "daemon":
    threading.Thread(target=drawn.render, daemon=True).start()
    begun.wait()
elif os.fork():
    sys.exit(os.waitstatus_to_exitcode(os.wait()[1]))
"""


@pytest.mark.parametrize("how", ["daemon", "fork"])
def test_the_interpreter_ends(how):
    ended = subprocess.run([sys.executable, "-c", ENDS, CUBE, how], stderr=subprocess.PIPE, check=True, timeout=30)
    assert ended.stderr == b""


def test_closing(renderer):
    with whit.Scene(CUBE) as scene, whit.Device() as device:
        drawn = whit.Renderer(scene, device, **SMALL)
    assert drawn.render().shape == (30, 40, 4)
    drawn.close()
    for call in (drawn.render, lambda: whit.Renderer(scene, whit.CPU), lambda: whit.Renderer(renderer.scene, device)):
        with pytest.raises(ValueError, match="it is closed"):
            call()


def test_errors_and_enumerators_are_copied():
    error = pickle.loads(pickle.dumps(whit.Error(whit.Result.ERROR_INPUT, ["one", "two"])))
    assert (error.result, str(error)) == (whit.Result.ERROR_INPUT, "one\ntwo")
    assert str(copy.copy(whit.Error(3, []))) == "bad input"
    assert pickle.loads(pickle.dumps(whit.Numerics.EXACT)) is whit.Numerics.EXACT


def test_no_parameter_is_ignored(renderer):
    assert isinstance(renderer.device.info.name, str) and renderer.device.info.kind in whit.DeviceKind
    whit.Scene(CUBE, environment=None, background=None)
    whit.Renderer(renderer.scene, whit.CPU, sliders=None, sampling=None, samples=4)
    for parameters, wrong in (({"numerics": 2**32 + 2}, "numerics: 4294967298 is out of range"),
                              ({"portable": "no"}, "portable: 'no' is neither True nor False"),
                              ({"camera": (1, 2, 3)}, r"camera: \(1, 2, 3\) is not \(eye, target"),
                              ({"samples": 4, "sampling": {"contrast": 0.5}}, "samples and sampling: one of them")):
        with pytest.raises((ValueError, TypeError), match=wrong):
            whit.Renderer(renderer.scene, whit.CPU, **parameters)
    with pytest.raises(TypeError, match="scene: None is no whit.Scene"):
        whit.Renderer(None)
    for name in ("has_background", "allowed_count"):
        with pytest.raises(TypeError, match=f"no parameter '{name}'"):
            whit.Scene(CUBE, **{name: 1})
