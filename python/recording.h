#pragma once

#include <pybind11/pytypes.h>

#include <filesystem>

#include "capture/recording/recording_format.h"

namespace stipple::python {

/// A recording, which can be gone through again and again.
struct RecordingFile {
    std::filesystem::path path;
    SessionRecord session;
    pybind11::object figures;  ///< of its making, a dict; None if it was opened
};

/// \throws InputError as RecordingReader, FileError.
[[nodiscard]] RecordingFile open_recording(const std::filesystem::path& path,
                                           pybind11::object figures);

}  // namespace stipple::python
