"""Model of a camera chip with per-pixel coded exposure: light in, packed samples out, and back to video.

    stream = stipple.emulate(video)     # an array (slot, row, col) of linear light, or a path
    result = stipple.decode(stream)     # an array of the same shape and unit
    print(stipple.compare(result, video))

Light 1.0 is the sensor's `photons_per_unit` photons per site and time slot; a frame is a slot. The bytes
and values are those of the program `stipple`, whose documentation holds here too. Errors of values are
ValueError, errors of files OSError, both with the program's texts."""

from . import capture
from ._calibrate import calibrate
from ._characterize import characterize, characterize_images
from ._chip import Chip
from ._dataset import Dataset, TrainingItem, dataset
from ._decoder import Decoder
from ._denoise import denoise
from ._dictionary import dictionary
from ._explore import explore, rivals
from ._forward_model import ForwardModel
from ._measurements import export, import_measurements
from ._pipeline import Schedule, compare, decode, decode_methods, emulate, load, timing
from ._report import report
from ._rig import emulate_rig, synth
from ._stipple import (
    ComparedVideos,
    DenoiserStep,
    Frame,
    MaxMemory,
    PreviewFrame,
    Recording,
    Sensor,
    Stream,
    VideoQuality,
    __version__,
)
from ._view import View, view

__all__ = [
    "Chip",
    "ComparedVideos",
    "Dataset",
    "Decoder",
    "DenoiserStep",
    "ForwardModel",
    "Frame",
    "MaxMemory",
    "PreviewFrame",
    "Recording",
    "Schedule",
    "Sensor",
    "Stream",
    "TrainingItem",
    "VideoQuality",
    "View",
    "__version__",
    "calibrate",
    "capture",
    "characterize",
    "characterize_images",
    "compare",
    "dataset",
    "decode",
    "decode_methods",
    "denoise",
    "dictionary",
    "emulate",
    "emulate_rig",
    "explore",
    "export",
    "import_measurements",
    "load",
    "report",
    "rivals",
    "synth",
    "timing",
    "view",
]
