#pragma once

#include <cstdlib>

#include "core/error.h"
#include "io/footage_reader.h"
#include "io/image_file.h"
#include "tests/support/memory_file.h"

namespace stipple {

/// Reads an image as light and, if it can be one, as digital numbers. What passes has all its
/// numbers.
inline void read_image(std::span<const std::uint8_t> bytes, const char* extension) {
    const NamedMemoryFile file(bytes, extension);
    try {
        Image image;
        read_image(file.path(), image);
        if (image.values.size() != image.shape.sites() || image.values.empty()) std::abort();
    } catch (const InputError&) {
    }
    try {
        const DnImage image = read_dn_image(file.path());
        if (image.dn.size() != image.shape.pixels() || image.dn.empty()) std::abort();
    } catch (const InputError&) {
    }
}

/// Reads footage to its end, or some frames of it.
inline void read_footage(const std::filesystem::path& file, const FootageOptions& options) {
    constexpr int kMaxFrames = 8;
    try {
        FootageReader reader(file, options);
        std::vector<float> frame(reader.shape().sites());
        for (int i = 0; i < kMaxFrames && reader.read(frame); ++i)
            for (const float light : frame)
                if (!(light >= 0)) std::abort();
        static_cast<void>(reader.take_warnings());
    } catch (const InputError&) {
    }
}

}  // namespace stipple
