#pragma once

#include <filesystem>

#include "io/raw_video.h"

namespace stipple {

/// The frames of a .cine file of a Phantom camera: grey or behind a colour filter array, of 8 to 16
/// bits, or packed in 10 or 12. Light is 0 at the black level and 1 at the white level that the
/// file declares, else at 2^bits - 1; numbers of 10 bits go through the curve of BT.709, as which
/// their published table is read to 1.2 of its 4000 steps. \throws InputError if the file is
/// damaged or of a kind that is not read.
[[nodiscard]] RawVideo open_cine(const std::filesystem::path& file);

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
