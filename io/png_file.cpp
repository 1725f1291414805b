#include "io/png_file.h"

#include <opencv2/core.hpp>

#include "core/error.h"
#include "io/opencv_quiet.h"
#include "io/output_file.h"

namespace stipple {

PngPixels decode_png(const PngChunks& png, PngLayout layout, const std::string& place) {
    silence_opencv();
    PngPixels pixels;
    try {
        pixels = late_opencv().decode_png(png.file, layout);
    } catch (const cv::Exception&) {
        // Said below: OpenCV's own text names nothing that a user knows.
    }
    if (pixels.rows == 0)
        throw InputError(place, "cannot be decoded; it is damaged or ends too early");
    return pixels;
}

void write_png_file(const std::filesystem::path& file, PngPixels& pixels) {
    silence_opencv();
    const std::vector<std::uint8_t> bytes = late_opencv().encode_png(pixels);
    OutputFile output(file, file.string());
    output.write(std::as_bytes(std::span(bytes)));
    output.close();
}

}  // namespace stipple
