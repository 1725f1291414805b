"""Lists cameras, takes and records their frames, and emulates a chip on them while they run::

    addresses = [camera.address for camera in stipple.capture.list()]
    with stipple.capture.frames("gige:192.168.0.5") as frames:
        for frame in frames: ...
    recording = stipple.capture.record("gige:192.168.0.5", "clip.strec", seconds=10)
    stream = stipple.capture.live("gige:192.168.0.5", "paper", "tiled", frames=500)

Addresses are those of docs/capture.md: "gige:IP", "usb:SERIAL", "v4l2:DEVICE", and "replay:FILE" of a
recording or footage. The functions that take frames have

settings: features of the camera, {"PixelFormat": "Mono12p", "ExposureTime": 2000}.
config: a file of such settings; `settings` come after it.
buffers: number of frame buffers on the host, 2 to 1024.

and all but `record_coded`

incomplete: what to do with frames that did not arrive whole: "drop" them, "keep" them, or "mask" what is
    missing.
stall_ms: silence in ms (or 5 frame periods) after which the camera is opened anew; 0: never.
reconnect: whether it is opened anew at all.

Waiting lets other threads run, and Ctrl-C ends it. Outages are UserWarnings. Errors are ValueError and
OSError, with the texts of the program."""

from os import PathLike
from typing import Callable, List, Mapping, NamedTuple, Optional, Tuple, Union
from warnings import warn

from . import _stipple
from ._stipple import CameraFrames, PreviewFrame, Recording, Sensor, Stream

__all__ = ["CameraFeature", "CameraListing", "features", "frames", "list", "live", "record", "record_coded"]

Name = Union[str, "PathLike[str]"]
Tell = Optional[Callable[[float, Optional[int]], object]]
Settings = Mapping[str, object]


class CameraListing(NamedTuple):
    """A camera that was found."""

    address: str
    """As the functions of this module take it: "gige:192.168.0.5"."""
    transport: str
    """"GigE Vision", "USB3 Vision" or "V4L2"."""
    vendor: str
    model: str
    serial: str


class CameraFeature(NamedTuple):
    """A feature of a GenICam camera or a control of a V4L2 device, as the camera describes it now: ranges and
    choices may depend on the values of others. Values are texts, as `settings` takes them."""

    name: str
    category: str
    """That lists it, or ""."""
    type: str
    """"integer", "float", "boolean", "choice", "text", "command", "mask" (bits), "register" or "unknown"."""
    access: str
    """"rw", "ro", "wo", or "na": not available now."""
    locked: bool
    """It is "ro" or "na" only while frames come."""
    value: Optional[str]
    """None if it cannot be read."""
    unit: str
    minimum: Optional[str]
    """Of numbers, if the camera tells; likewise `maximum` and `increment`."""
    maximum: Optional[str]
    increment: Optional[str]
    choices: Tuple[str, ...]
    """That are available now."""
    text: str
    """A line from the camera, or ""."""


def list() -> List[CameraListing]:
    """The cameras that can be opened, as "stipple capture list" finds them. Takes about a second.

    Kinds of cameras that could not be searched are UserWarnings, which say why.
    """
    cameras, problems = _stipple.find_cameras()
    for problem in problems:
        warn(problem, UserWarning, stacklevel=2)
    return [CameraListing(*camera) for camera in cameras]


def features(address: str, pattern: str = "") -> List[CameraFeature]:
    """Settings of a camera with values, units, ranges, choices and access, as "stipple capture features".

    pattern: part of a name, or a name with wildcards * ? []; upper and lower case are equal. "" is all.

    Raises ValueError if the address is none, is a replay, or if no feature matches; OSError if the camera does
    not answer.
    """
    return [CameraFeature(*feature) for feature in _stipple.camera_features(address, pattern)]


def frames(
    address: str,
    *,
    settings: Settings = {},
    config: Optional[Name] = None,
    incomplete: str = "mask",
    stall_ms: int = 250,
    reconnect: bool = True,
    buffers: int = 32,
    queue: int = 64,
) -> CameraFrames:
    """Frames of a camera as they come: an iterator over Frame, which `with` or close() ends.

    A frame is handed over without a copy; Frame.payload and, of formats with 16-bit words, Frame.dn (uint16,
    (row, col)) are views of it.

    queue: frames that may wait, 1 to 4096. Those that find it full are dropped, and counted in lost_before
        of the next one (cause "queue_drop").
    """
    task = _stipple.CameraTask(address, settings, config, buffers, (incomplete, stall_ms, reconnect), (None, None))
    return CameraFrames(task, queue)


def record(
    address: str,
    output: Name,
    *,
    frames: Optional[int] = None,
    seconds: Optional[float] = None,
    settings: Settings = {},
    config: Optional[Name] = None,
    incomplete: str = "mask",
    stall_ms: int = 250,
    reconnect: bool = True,
    buffers: int = 32,
    force: bool = False,
    progress: Tell = None,
) -> Recording:
    """Records a camera to a .strec file, as "stipple capture record" does.

    output: a new file.
    frames, seconds: stop after so many frames or seconds, whichever comes first; by default never.
    force: replace a file that is there.
    progress: called some ten times a second as progress(frames, frames in all or None). If it returns False,
        the recording ends; what it raises ends the call, as Ctrl-C does. The file holds all frames until then.

    Recording.figures has the keys of "stipple capture record --json": frames, lost frames by cause ... Raises
    OSError if the camera is lost or the disk is full (the file holds the frames before), ValueError.
    """
    task = _stipple.CameraTask(
        address, settings, config, buffers, (incomplete, stall_ms, reconnect), (frames, seconds)
    )
    return _stipple.record(task, output, force, progress)


def record_coded(
    address: str,
    output: Name,
    *,
    frames: Optional[int] = None,
    seconds: Optional[float] = None,
    settings: Settings = {},
    config: Optional[Name] = None,
    buffers: int = 32,
    force: bool = False,
    progress: Tell = None,
) -> Stream:
    """Records a camera that sends a coded stream (docs/served_camera.md) to the .stipple file that "emulate"
    would have written, as "stipple capture record --coded" does.

    output, frames, seconds, force, progress: as for `record`.

    Slots that do not arrive are missing in the stream. Stream.figures has the keys slots, missing_slots and
    damaged_frames.
    """
    task = _stipple.CameraTask(address, settings, config, buffers, ("mask", 250, True), (frames, seconds))
    return _stipple.record_coded(task, output, force, progress)


def live(
    address: str,
    sensor: Union[Sensor, Name] = "paper",
    schedule: Union[_stipple.Schedule, Name] = "random",
    seed: int = 1,
    *,
    output: Optional[Name] = None,
    frames: Optional[int] = None,
    seconds: Optional[float] = None,
    settings: Settings = {},
    config: Optional[Name] = None,
    black_level_dn: float = 0,
    overrun: str = "stretch",
    incomplete: str = "keep",
    stall_ms: int = 250,
    reconnect: bool = True,
    buffers: int = 32,
    queue: int = 64,
    late_after: float = 2,
    preview: Optional[Callable[[PreviewFrame], object]] = None,
    preview_method: str = "live",
    preview_size: Optional[Tuple[int, int]] = None,
    threads: int = 0,
    force: bool = False,
    progress: Tell = None,
) -> Stream:
    """The stream that the chip makes of a camera's frames while it runs, as "stipple capture live" does.

    Each frame is a slot. Light is (DN - black level) / (full scale - black level). Where a frame is missing
    or incomplete, the one before stands in.

    sensor, schedule, seed, overrun, output, threads: as for `stipple.emulate`.
    frames, seconds, force, progress: as for `record`. The stream holds all slots until the end.
    black_level_dn: DN without light.
    queue: frames that may wait, 1 to 4096.
    late_after: slots after which a packet counts as late.
    preview: called with decoded frames of the newest slots while the camera runs, as preview(frame): frame.slot;
        frame.light, float32, (row, col) or (row, col, 3), in the unit of `stipple.decode`; frame.saturated,
        bool, (row, col). Another thread decodes when the machine is idle; slots that come meanwhile are not
        shown. The call is made between two frames of the camera, in the thread that has called `live`: if it
        takes longer than `queue` frames, frames are dropped and counted. What it raises ends the call; the
        stream holds all slots until then. If no frame was ready by the end, the first one is waited for.
    preview_method: "live", "naive", or "fast", which is better and takes seconds.
    preview_size: (rows, columns), 8 to 65535, of the middle of the frame; by default as much as is decoded within
        some seconds.

    Stream.figures has the keys of "stipple capture live --json": latencies in us, held and late slots ...
    """
    task = _stipple.CameraTask(
        address, settings, config, buffers, (incomplete, stall_ms, reconnect), (frames, seconds)
    )
    shown = None if preview is None else _stipple.PreviewTask(preview, preview_method, preview_size)
    chip = _stipple.LiveTask(sensor, schedule, seed, overrun, black_level_dn, queue, late_after, shown)
    with _stipple.Threads(threads):
        return _stipple.live(task, chip, output, force, progress)
