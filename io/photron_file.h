#pragma once

#include <filesystem>

#include "io/raw_video.h"

namespace stipple {

/// True of the files of a recording by a Photron camera: .mraw, .cihx and .cih.
[[nodiscard]] bool is_photron_name(const std::filesystem::path& file);

/// The header of a recording and the file of its frames, which have the same name.
struct PhotronFiles {
    std::filesystem::path header;  ///< .cihx (XML) or .cih (text)
    std::filesystem::path frames;  ///< .mraw
};

/// Both by one of them. \throws InputError if there is not the other one.
[[nodiscard]] PhotronFiles photron_files(const std::filesystem::path& file);

/// The frames of a recording, by either of its files: grey of 8, 12 (packed) or 16 bits. Light is 1
/// at the highest number of the bits that the header declares. \throws InputError if one of the two
/// is missing or damaged, or the video is of a kind that is not read.
[[nodiscard]] RawVideo open_photron(const std::filesystem::path& file);

}  // namespace stipple
