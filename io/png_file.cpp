#include "io/png_file.h"

#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <cassert>
#include <csetjmp>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>

#include "core/error.h"
#include "core/light.h"
#include "core/memory_limit.h"
#include "io/output_file.h"

namespace stipple {
namespace {

constexpr std::size_t kSignatureBytes = 8;

/// What libpng gave up for. No string, for libpng leaves by a jump, which skips destructors.
struct Problem {
    std::array<char, 128> text{};
    bool no_memory = false;
};

[[noreturn]] void give_up(png_structp png, png_const_charp text) {
    auto& problem = *static_cast<Problem*>(png_get_error_ptr(png));
    std::strncpy(problem.text.data(), text, problem.text.size() - 1);
    png_longjmp(png, 1);
}

void drop_warning(png_structp /*png*/, png_const_charp /*text*/) {}

void* allocate(png_structp png, png_alloc_size_t size) {
    void* const memory = std::malloc(size);
    if (memory == nullptr) static_cast<Problem*>(png_get_mem_ptr(png))->no_memory = true;
    return memory;
}

void release(png_structp /*png*/, void* memory) {
    std::free(memory);
}

/// Runs calls of libpng, which make no objects; false if it has given up.
template <typename Calls>
bool succeeds(png_structp png, Calls calls) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    calls();
    return true;
}

/// The bytes of a file while they are read.
struct Source {
    std::span<const std::uint8_t> bytes;
    std::size_t next = 0;
    std::size_t chunk = 0;  ///< where the chunk at hand begins
};

void read_bytes(png_structp png, png_bytep to, std::size_t count) {
    auto& source = *static_cast<Source*>(png_get_io_ptr(png));
    if ((png_get_io_state(png) & PNG_IO_MASK_LOC) == PNG_IO_CHUNK_HDR) source.chunk = source.next;
    if (count > source.bytes.size() - source.next) png_error(png, "the file ends too early");
    std::memcpy(to, source.bytes.data() + source.next, count);
    source.next += count;
}

/// What libpng holds of a file that it reads or writes.
struct Png {
    Problem problem{};
    bool is_read;
    png_structp png;
    png_infop info;

    explicit Png(bool for_reading)
        : is_read(for_reading),
          png((is_read ? png_create_read_struct_2 : png_create_write_struct_2)(
              PNG_LIBPNG_VER_STRING, &problem, give_up, drop_warning, &problem, allocate, release)),
          info(png == nullptr ? nullptr : png_create_info_struct(png)) {
        if (info != nullptr) return;
        destroy();
        throw std::bad_alloc();
    }
    ~Png() { destroy(); }
    Png(const Png&) = delete;
    Png& operator=(const Png&) = delete;

    /// After libpng has given up. \throws std::bad_alloc.
    [[nodiscard]] const char* reason() const {
        if (problem.no_memory) throw std::bad_alloc();
        return problem.text.data();
    }
    void destroy() {
        is_read ? png_destroy_read_struct(&png, &info, nullptr)
                : png_destroy_write_struct(&png, &info);
    }
};

/// What is read is what makes up the pixels and transparency; of all else, CRCs alone.
void read_header(png_structp png, png_infop info, Source& source) {
    png_set_read_fn(png, &source, read_bytes);
    png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_chunk_malloc_max(png, 0);  // or a long chunk that is left out would be refused
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_read_info(png, info);
}

SourceInfo traits_of(png_structp png, png_infop info, bool grey) {
    SourceInfo traits{.gamma_coded = !grey && png_get_bit_depth(png, info) <= 8};
    traits.bits = png_get_bit_depth(png, info);
    traits.has_alpha = (png_get_color_type(png, info) & PNG_COLOR_MASK_ALPHA) != 0 ||
                       png_get_valid(png, info, PNG_INFO_tRNS) != 0;
    return traits;
}

/// Everything but the bytes. \throws InputError for a size that the file cannot hold or that is
/// more than a run may take.
PngImage image_of(png_structp png, png_infop info, std::uint64_t file_bytes,
                  const std::string& where) {
    const int type = png_get_color_type(png, info);
    const int depth = png_get_bit_depth(png, info);
    const bool grey = (type & PNG_COLOR_MASK_COLOR) == 0;
    const std::uint64_t rows = png_get_image_height(png, info);
    const FrameShape shape =
        checked_shape(rows, png_get_image_width(png, info), grey ? 1 : 3, where);
    check_packed(png_get_rowbytes(png, info) * rows, file_bytes, where);
    const std::size_t unpacked = depth == 16 ? 2 : 1;
    check_memory((unpacked + sizeof(float)) * shape.sites(), where, "the image", file_bytes);
    return {.pixels = PngPixels{.rows = shape.rows,
                                .cols = shape.cols,
                                .channels = shape.planes,
                                .bytes_per_sample = static_cast<int>(unpacked),
                                .bytes = std::vector<std::uint8_t>(unpacked * shape.sites())},
            .traits = traits_of(png, info, grey),
            .as_stored = type == PNG_COLOR_TYPE_GRAY && depth >= 8};
}

std::size_t row_bytes(const PngPixels& pixels) {
    return pixels.bytes.size() / static_cast<std::size_t>(pixels.rows);
}

void swap_bytes(png_structp png, const PngPixels& pixels) {
    if (pixels.bytes_per_sample == 2 && std::endian::native == std::endian::little)
        png_set_swap(png);
}

struct Sink {
    OutputFile file;
    std::exception_ptr failure = nullptr;  ///< which must not pass through libpng
};

void write_bytes(png_structp png, png_bytep bytes, std::size_t count) {
    auto& sink = *static_cast<Sink*>(png_get_io_ptr(png));
    try {
        sink.file.write(std::as_bytes(std::span(bytes, count)));
        return;
    } catch (...) {
        sink.failure = std::current_exception();
    }
    png_error(png, "cannot be written");
}

void flush(png_structp /*png*/) {}

}  // namespace

PngImage decode_png(std::span<const std::uint8_t> file, const std::string& where) {
    if (file.size() < kSignatureBytes || png_sig_cmp(file.data(), 0, kSignatureBytes) != 0)
        throw InputError(where, "is not a PNG file");
    Source source{file};
    const Png reader(true);
    const png_structp png = reader.png;
    const png_infop info = reader.info;
    const auto check = [&](bool succeeded) {
        if (succeeded) return;
        throw InputError(
            where, fmt::format("offset {}: {}; it is damaged", source.chunk, reader.reason()));
    };
    check(succeeds(png, [&] { read_header(png, info, source); }));
    PngImage image = image_of(png, info, file.size(), where);
    std::vector<png_bytep> rows(static_cast<std::size_t>(image.pixels.rows));
    for (std::size_t row = 0; row < rows.size(); ++row)
        rows[row] = image.pixels.bytes.data() + row * row_bytes(image.pixels);
    check(succeeds(png, [&] {
        png_set_expand(png);
        png_set_strip_alpha(png);
        swap_bytes(png, image.pixels);
        png_set_interlace_handling(png);
        png_read_update_info(png, info);
        assert(png_get_rowbytes(png, info) == row_bytes(image.pixels));
        png_read_image(png, rows.data());
        png_read_end(png, nullptr);
    }));
    add_png_declarations(file, image.pixels.channels == 3, where, image.traits);
    return image;
}

void write_png_file(const std::filesystem::path& file, const PngPixels& pixels,
                    const std::string& where) {
    Sink sink{OutputFile(file, where)};
    const Png writer(false);
    const png_structp png = writer.png;
    const png_infop info = writer.info;
    const bool succeeded = succeeds(png, [&] {
        png_set_write_fn(png, &sink, write_bytes, flush);
        png_set_IHDR(png, info, static_cast<png_uint_32>(pixels.cols),
                     static_cast<png_uint_32>(pixels.rows), 8 * pixels.bytes_per_sample,
                     pixels.channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB,
                     PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        // Of the ways to pack the fastest, and on noise no larger than others.
        png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
        png_set_compression_level(png, Z_BEST_SPEED);
        png_set_compression_strategy(png, Z_RLE);
        png_write_info(png, info);
        swap_bytes(png, pixels);
        for (int row = 0; row < pixels.rows; ++row)
            png_write_row(png,
                          pixels.bytes.data() + static_cast<std::size_t>(row) * row_bytes(pixels));
        png_write_end(png, nullptr);
    });
    if (sink.failure) std::rethrow_exception(sink.failure);
    if (!succeeded) throw DeviceError(where, fmt::format("cannot be written: {}", writer.reason()));
    sink.file.close();
}

}  // namespace stipple
