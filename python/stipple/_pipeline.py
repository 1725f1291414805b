"""What a clip goes through: emulate, decode, compare; and how fast the chip reads it."""

import operator
import shutil
import tempfile
import weakref
from os import PathLike
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, Mapping, Optional, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _denoise, _stipple
from ._stipple import ComparedVideos, Sensor, Stream, decode_methods

__all__ = ["Schedule", "compare", "decode", "decode_methods", "emulate", "load", "timing"]

Name = Union[str, "PathLike[str]"]
Video = Union[Name, npt.ArrayLike]
Tell = Optional[Callable[[float, Optional[int]], object]]

#: A row of Schedule.exposures().
EXPOSURE = np.dtype([("row", "u2"), ("col", "u2"), ("first_slot", "u4"), ("open_slots", "u8")])


def _rows(exposures: Any) -> npt.NDArray[np.void]:
    """Rows of EXPOSURE; NumPy alone would cut fractions off and wrap numbers that are too large."""
    if getattr(exposures, "dtype", None) == EXPOSURE:
        return np.asarray(exposures)
    ends = [np.iinfo(EXPOSURE[field]).max for field in EXPOSURE.names or ()]
    rows = []
    for row in exposures:
        try:
            numbers = tuple(operator.index(number) for number in row)
        except TypeError:
            numbers = ()
        if len(numbers) != len(ends) or any(not 0 <= a <= b for a, b in zip(numbers, ends)):
            raise ValueError(
                f"exposures: {row!r} is not (row, col, first_slot, open_slots) in whole numbers of 0 to "
                "2^16 - 1, 2^16 - 1, 2^32 - 1 and 2^64 - 1"
            )
        rows.append(numbers)
    return np.array(rows, dtype=EXPOSURE)


def _with_file(text: str, size: Tuple[int, int]) -> "Schedule":
    """Of the text of a file. The program knows schedules as files, so there is one that goes with the object."""
    folder = Path(tempfile.mkdtemp(prefix="stipple_"))
    try:
        file = folder / "custom.toml"
        file.write_text(text, encoding="utf-8")
        schedule = Schedule(file, size=size)
    except BaseException:
        shutil.rmtree(folder)
        raise
    weakref.finalize(schedule, shutil.rmtree, folder)
    return schedule


class Schedule(_stipple.Schedule):
    __doc__ = _stipple.Schedule.__doc__

    def __reduce__(self) -> Tuple[Any, ...]:
        content = self._content()
        return (_with_file, (content, self.size)) if isinstance(content, str) else (Schedule, content)

    @staticmethod
    def from_exposures(
        exposures: npt.ArrayLike,
        tile: Tuple[int, int],
        period_slots: int,
        *,
        weights: Optional[npt.ArrayLike] = None,
        name: str = "custom",
        size: Tuple[int, int] = (480, 640),
    ) -> "Schedule":
        """A schedule of one's own.

        exposures: rows (row, col, first_slot, open_slots) as Schedule.exposures() gives: a list of tuples or
            a structured array. Bit i of open_slots (1 .. 2^64 - 1) opens the shutter in slot first_slot + i;
            bit 0 is set.
        tile: (rows, columns) of the tile that repeats over the array.
        period_slots: slots after which all repeats.
        weights: array (slot, row, col) as Schedule.weights() gives, 0 in closed slots, 2^-20 .. 1 in open ones;
            rounded to 1/65535.
        name: for the stream's header, at most 64 bytes.

        Raises ValueError where two exposures of a pixel share a slot or an exposure is longer than the period.
        """
        return _with_file(_stipple.schedule_text(_rows(exposures), tile, period_slots, name, weights), size)


def _in_order(
    switches: Mapping[int, Mapping[str, object]], now: Dict[str, Any]
) -> Iterator[Tuple[int, Dict[str, Any]]]:
    """The slots of the switches, each with all that holds from then on."""
    for slot, changes in sorted(switches.items()):
        if unknown := set(changes) - set(now):
            raise ValueError(f"switches: {sorted(unknown)} is none of {', '.join(now)}")
        now = {**now, **changes}
        yield slot, now


def _reading(
    transfer: Optional[str],
    luminance: bool,
    max_value: Optional[float],
    raw: Optional[str],
    min_value: Optional[float],
    scale: float = 1.0,
) -> _stipple.Reading:
    reading = _stipple.Reading(transfer, luminance, max_value)
    reading.set_raw(raw)
    reading.set_min_value(min_value)
    reading.set_scale(scale)
    return reading


def load(
    video: Video,
    *,
    transfer: Optional[str] = None,
    luminance: bool = False,
    max_value: Optional[float] = None,
    min_value: Optional[float] = None,
    raw: Optional[str] = None,
    scale: float = 1.0,
    progress: Tell = None,
) -> npt.NDArray[np.float32]:
    """Footage as an array of linear light: what "stipple emulate" would emulate (its option --truth). The array
    is as that of `decode`.

    video, transfer, luminance, max_value, min_value, raw, scale, progress: as for `emulate`.
    """
    reading = _reading(transfer, luminance, max_value, raw, min_value, scale)
    return _stipple.load(_stipple.Footage(video, reading), progress)


def emulate(
    video: Video,
    sensor: Union[Sensor, Name] = "paper",
    schedule: Union[_stipple.Schedule, Name] = "random",
    seed: int = 1,
    *,
    output: Optional[Name] = None,
    force: bool = False,
    switches: Mapping[int, Mapping[str, object]] = {},
    overrun: str = "stretch",
    transfer: Optional[str] = None,
    luminance: bool = False,
    max_value: Optional[float] = None,
    min_value: Optional[float] = None,
    raw: Optional[str] = None,
    scale: float = 1.0,
    resample: Optional[str] = None,
    frames_hz: Optional[float] = None,
    threads: int = 0,
    progress: Tell = None,
) -> Stream:
    """The sample stream that the chip makes of a video, as "stipple emulate" does.

    video: linear light, a frame per time slot; an array (slot, row, col) or (slot, row, col, 3), or a path to
        what the program reads. Floating-point values are light, uint8 and uint16 are divided by 255 and
        65535. Frames of float32 that lie plane by plane, as those of `decode` do, are not copied.
    sensor: a Sensor, the name of one, or the path of its file.
    schedule: a Schedule that was made for this size and seed, a name, or the path of a file.
    seed: of the noise and of a random schedule.
    output: a new .stipple file. Without it the stream lies in a temporary file (of the folder TMPDIR) that
        goes with the Stream; Stream.save copies it.
    force: replace a file that is there.
    switches: what changes from a slot on, {100: {"schedule": "tiled"}, 200: {"seed": 2}} (docs/schedules.md).
    overrun: what a sensor with timing does if a readout takes longer than its slot, "stretch" or "drop".
    transfer: how the numbers map to light, "linear" (default), "gamma22", "srgb", "bt709", "pq", "hlg", or
        "auto": as the file declares.
    luminance: reduce colour to Rec. 709 luminance.
    max_value: clip light to this value first.
    min_value: clip light below this value to it; 0 makes negative light 0, which is refused otherwise.
    raw: read a file as frames without a header, "640x480:mono12p" (docs/footage.md).
    scale: multiply light by this, before it is clipped.
    resample: make slots of frames of another rate, "hold", "blend" or "flow"; None: each frame is a slot.
    frames_hz: frames per second of the video; by default what its file declares.
    threads: 0 means all cores. The bytes do not depend on it.
    progress: called some ten times a second as progress(slots done, slots in all or None). What it raises ends
        the call, as Ctrl-C does; nothing is written then.

    The same arguments give the same bytes. A stream of a path is that of the program; of an array its header
    does not name the footage. Raises ValueError, or OSError for files. Footage whose frame rate, exposure time or
    black level does not suit the sensor is a UserWarning, and so are missing frames and damage of a recording.
    """
    reading = _reading(transfer, luminance, max_value, raw, min_value, scale)
    reading.set_resampling(resample)
    reading.set_rate(frames_hz)
    footage = _stipple.Footage(video, reading)
    setup = _stipple.Setup(footage, sensor, schedule, seed, overrun)
    for slot, now in _in_order(switches, {"sensor": sensor, "schedule": schedule, "seed": seed}):
        setup.switch_to(_stipple.Setup(footage, now["sensor"], now["schedule"], now["seed"], overrun), slot)
    with _stipple.Threads(threads):
        return _stipple.emulate(footage, setup, output, force, progress)


def decode(
    stream: Union[Stream, Name],
    method: str = "best",
    options: Mapping[str, object] = {},
    *,
    until: Optional[int] = None,
    fill_gaps: bool = False,
    strict: bool = False,
    calibration: Optional[Name] = None,
    denoiser: Optional[_denoise.Denoiser] = None,
    refiner: Optional[_denoise.Refiner] = None,
    threads: int = 0,
    progress: Tell = None,
) -> npt.NDArray[np.float32]:
    """The video of a sample stream, as "stipple decode" does: float32 in units of the footage.

    The array is (slot, row, col), or of colour (slot, row, col, plane) with planes red, green and blue: what
    the program writes to a .npy file. Colour lies plane by plane in memory, as it was decoded; use
    np.ascontiguousarray where other code wants it pixel by pixel.

    stream: a Stream, the path of one, or the folder of a rig.
    method: one of decode_methods(), from the fastest to the best.
    options: of the method, {"iterations": 20}; "stipple list keys decoder" lists them.
    until: decode only so many slots.
    fill_gaps: decode slots that are missing, however many they are.
    strict: raise ValueError at the first damage. Else damage costs its own samples and is a UserWarning.
    calibration: of the chip, a file that "stipple calibrate" wrote (docs/calibration.md), or "none". By
        default NAME.stcal beside a stream NAME.stipple, if it is there.
    denoiser: of plug_and_play, denoiser(video, sigma) or denoiser(video, sigma, step), which returns the video
        without noise, an array of its shape (docs/research.md#your-denoiser). `video` is a block, float32
        (slot, row, col) or (slot, row, col, plane), on the scale 2 sqrt(light), `sigma` the standard deviation
        of its noise, and `step` a DenoiserStep. It is called in this thread. What it raises ends the call.
    refiner: of learned and learned_fast in place of the network, refiner(inputs), which returns the refined first
        input, an array (row, col). `inputs` is a plane of a slot, float32 (input, row, col), as
        decoder/learned/refinement_inputs.h lists them. It is called in this thread for one plane after another.
    threads: 0 means all cores. The values do not depend on it.
    progress: as for `emulate`.
    """
    task = _stipple.DecodeTask(method, options, fill_gaps, strict, until)
    task.calibration = calibration
    _denoise.check_given(method, options, denoiser)
    if denoiser is not None:
        task.set_denoiser(_denoise.as_called(denoiser))
    if refiner is not None:
        task.set_refiner(_denoise.refiner_as_called(refiner))
    with _stipple.Threads(threads):
        is_path = isinstance(stream, (str, PathLike)) and not isinstance(stream, Stream)
        if is_path and _stipple.is_rig_folder(stream):
            return _stipple.decode_rig(stream, task, progress)
        source = stream if isinstance(stream, Stream) else Stream.open(stream)
        return _stipple.decode(source, task, progress)


def compare(
    result: Video,
    reference: Video,
    *,
    margin: int = 0,
    max_value: Optional[float] = None,
    min_value: Optional[float] = None,
    peak: float = 1.0,
    cd_per_unit: float = 100.0,
    until: Optional[int] = None,
    transfer: Optional[str] = None,
    luminance: bool = False,
    raw: Optional[str] = None,
    pu21_ssim: bool = False,
    pixels_per_degree: Optional[float] = None,
    threads: int = 0,
    progress: Tell = None,
) -> ComparedVideos:
    """Quality of a video against its reference, as "stipple compare" does; `frames` of the result has that
    of each frame. Of videos of unequal length the frames that both have are compared, with a warning.

    result, reference: videos as for `emulate`, of the same shape. `transfer`, `raw`, `min_value` and `max_value` are
        those of "stipple compare": transfer, raw and min_value are of the reference. The light of the result may
        be negative.
    margin: frames left out at each end.
    max_value: clip the light of both to it first.
    peak: light of which PSNR and PU21-PSNR are.
    cd_per_unit: luminance of light 1.0 for PU21, in cd/m2.
    until: compare only so many frames, which both must have.
    luminance: reduce colour of both to Rec. 709 luminance.
    pu21_ssim: compute it too.
    pixels_per_degree: pixels in a degree of visual angle, to compute pu21_csf_psnr_db too.
    """
    reading = _stipple.Reading("linear", luminance, None)
    reading.take_negative()
    a = _stipple.Footage(result, reading)
    reading = _reading(transfer, luminance, None, raw, min_value)
    b = _stipple.Footage(reference, reading)
    comparison = _stipple.Comparison(
        margin, max_value, peak, cd_per_unit, until, pu21_ssim, pixels_per_degree
    )
    with _stipple.Threads(threads):
        return _stipple.compare(a, b, comparison, progress)


def timing(
    sensor: Union[Sensor, Name],
    schedule: Union[_stipple.Schedule, Name] = "random",
    *,
    size: Optional[Tuple[int, int]] = None,
    seed: int = 1,
) -> dict[str, Any]:
    """How fast a sensor reads, in full and coded: the keys of "stipple timing --json" (docs/outputs.md).

    sensor: one with a section [timing] (Sensor.has_timing).
    schedule: a Schedule, a name, or the path of a file.
    size: (rows, columns) of what is read; by default those of the Schedule, else the whole array.
    seed: of a random schedule.
    """
    return _stipple.timing(sensor, schedule, size, seed)
