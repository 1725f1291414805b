#include "io/tiff_file.h"
#include "tests/fuzz/image_fuzz.h"

namespace stipple {
namespace {

/// A page that passes has all its bytes.
void read_pages(const std::string& path) {
    constexpr int kMaxPages = 4;
    try {
        TiffFile tiff(path);
        TiffPixels pixels;
        for (int page = 0; page < tiff.pages() && page < kMaxPages; ++page) {
            tiff.read(page, pixels);
            if (pixels.bytes.size() != pixels.shape.pixels() * pixels.sample_bytes() *
                                           static_cast<std::size_t>(pixels.channels))
                std::abort();
        }
    } catch (const InputError&) {
    }
}

}  // namespace
}  // namespace stipple

/// Input: a TIFF file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    const std::span<const std::uint8_t> bytes(data, size);
    read_pages(MemoryFile(bytes).path());
    read_image(bytes, ".tif");
    return 0;
}
