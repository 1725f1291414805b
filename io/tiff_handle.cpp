#include "io/tiff_handle.h"

#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <fstream>
#include <system_error>

#include "core/error.h"
#include "core/input_file.h"
#include "core/light.h"
#include "core/memory_limit.h"

namespace stipple {
namespace {

/// Keeps the first message of libtiff, which would go to standard error.
int keep_message(TIFF* /*tiff*/, void* first, const char* /*module*/, const char* format,
                 va_list arguments) {
    auto& text = *static_cast<std::string*>(first);
    char line[200] = {};
    std::vsnprintf(line, sizeof(line), format, arguments);
    if (text.empty()) text = line;
    return 1;
}

int drop_message(TIFF* /*tiff*/, void* /*data*/, const char* /*module*/, const char* /*format*/,
                 va_list /*arguments*/) {
    return 1;
}

/// \throws InputError if the file cannot be opened for reading.
std::uint64_t checked_file_bytes(const std::filesystem::path& file) {
    refuse_special(file);
    errno = 0;
    if (!std::ifstream(file, std::ios::binary).good())
        throw InputError(file.string(),
                         "cannot be read: " + std::generic_category().message(errno));
    std::error_code error;
    const auto bytes = std::filesystem::file_size(file, error);
    if (error) throw InputError(file.string(), "cannot be read: " + error.message());
    return bytes;
}

}  // namespace

void TiffHandle::Closer::operator()(tiff* file) const {
    TIFFClose(file);
}

TiffHandle::TiffHandle(const std::filesystem::path& file)
    : name_(file.string()), file_bytes_(checked_file_bytes(file)) {
    TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options, keep_message, &message_);
    TIFFOpenOptionsSetWarningHandlerExtR(options, drop_message, nullptr);
    tiff_.reset(TIFFOpenExt(file.c_str(), "rm", options));  // m: not mapped to memory
    TIFFOpenOptionsFree(options);
    if (!tiff_) fail(name_);
}

void TiffHandle::check_size(std::uint64_t stored, std::uint64_t taken, std::uint64_t ratio,
                            const std::string& where) const {
    const std::uint64_t block =
        TIFFIsTiled(get()) != 0 ? TIFFTileSize64(get()) : TIFFScanlineSize64(get());
    check_packed(std::max(stored, block), file_bytes_, where, ratio);
    check_memory(taken + block, where, "the image", file_bytes_);
}

void TiffHandle::fail(const std::string& where) const {
    throw InputError(where, fmt::format("cannot be decoded{}; it is damaged or ends too early",
                                        message_.empty() ? "" : fmt::format(" ({})", message_)));
}

}  // namespace stipple
