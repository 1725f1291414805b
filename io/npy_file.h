#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry.h"
#include "io/image.h"
#include "io/output_file.h"

namespace stipple {

/// The three entries of a .npy header, e.g. {'descr': '<f4', 'fortran_order': False,
/// 'shape': (2, 3, 4), }.
struct NpyFields {
    std::string descr;
    bool fortran_order = false;
    std::vector<std::uint64_t> shape;
};

/// Reads the Python dictionary of a .npy header, entries in any order.
/// \throws InputError at `where` if it is malformed or an entry is missing or unknown.
[[nodiscard]] NpyFields read_npy_fields(std::string_view dictionary, std::string_view where);

enum class NpyType { kUint8, kUint16, kHalf, kFloat, kDouble };

/// Bytes of one value.
[[nodiscard]] std::size_t npy_type_bytes(NpyType type);

/// Content of the header of a .npy video: an array (T,H,W), (T,H,W,3) or, of one frame,
/// (H,W) in C order.
struct NpyHeader {
    NpyType type = NpyType::kFloat;
    int slots = 0;
    FrameShape shape;
    std::size_t data_offset = 0;

    [[nodiscard]] std::size_t frame_bytes() const { return shape.sites() * npy_type_bytes(type); }
};

/// Maximum length of a header, from the start of the file.
inline constexpr std::size_t kMaxNpyHeaderBytes = 65536;

/// The Python dictionary of a header, and the position of the data.
struct NpyDictionary {
    std::string_view text;
    std::size_t data_offset = 0;
};

/// Finds the dictionary in `start`, the first bytes of a file. \throws InputError at `where` if the
/// file is no .npy file, has an unknown version, or ends within its header.
[[nodiscard]] NpyDictionary find_npy_dictionary(std::string_view start, std::string_view where);

/// Reads the header from `start`, the first min(file_bytes, kMaxNpyHeaderBytes) bytes of a file.
/// \throws InputError at `where` if the file is no .npy file, is not little-endian u1, u2, f2, f4
/// or f8 in C order, has another shape, is empty, or does not match the length of the file. Source:
/// numpy.lib.format, versions 1.0 to 3.0.
[[nodiscard]] NpyHeader parse_npy_header(std::span<const std::byte> start, std::uint64_t file_bytes,
                                         std::string_view where);

/// A header of fixed length for float32 frames of `shape`, so that the number of slots can be
/// written later. `comment`, of at most 32 letters, follows the dictionary after a #.
[[nodiscard]] std::string format_npy_header(int slots, FrameShape shape,
                                            std::string_view comment = {});

/// Reads a .npy video frame by frame.
class NpyReader {
  public:
    /// \throws InputError as parse_npy_header, or if the file is missing or unreadable.
    explicit NpyReader(const std::filesystem::path& file);

    [[nodiscard]] FrameShape shape() const { return header_.shape; }
    [[nodiscard]] int slots() const { return header_.slots; }
    /// The type of the stored numbers.
    [[nodiscard]] SourceInfo traits() const;
    /// The file and the last frame read, for messages.
    [[nodiscard]] std::string where() const;

    /// The next frame, order (plane, row, col), integers scaled to 0..1; false at the end.
    /// \throws InputError.
    bool read(std::span<float> frame);
    /// Leaves out the next `frames` frames. \throws InputError.
    void skip(int frames);

  private:
    struct Closer {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };

    std::string name_;
    std::unique_ptr<std::FILE, Closer> file_;
    NpyHeader header_;
    int next_slot_ = 0;
    std::vector<std::byte> bytes_;
};

/// Writes a float32 .npy video, (T,H,W) or (T,H,W,3), frame by frame. The header of an unfinished
/// file lacks at most the frames of the last second.
class NpyWriter {
  public:
    /// Creates `file`; messages name it `where`. The header has the comment. \throws DeviceError.
    NpyWriter(const std::filesystem::path& file, std::string_view where, FrameShape shape,
              std::string comment = {});

    /// `frame` holds shape.sites() floats, order (plane, row, col). \throws DeviceError.
    void write(std::span<const float> frame);
    /// Writes the number of frames and closes the file. \throws DeviceError.
    void finish();

  private:
    using Clock = std::chrono::steady_clock;
    void write_header();

    OutputFile file_;
    FrameShape shape_;
    std::string comment_;
    int slots_ = 0;
    int header_slots_ = 0;  ///< number of slots in the header
    Clock::time_point header_time_;
    std::vector<float> pixels_;  ///< by row, column and plane; empty before the first frame
};

/// Numbers of order (layer, row, col) from a .npy file.
struct NpyVolume {
    int layers = 0;
    int rows = 0;
    int cols = 0;
    std::vector<double> values;

    [[nodiscard]] double at(int layer, int row, int col) const {
        return values[(static_cast<std::size_t>(layer) * static_cast<std::size_t>(rows) +
                       static_cast<std::size_t>(row)) *
                          static_cast<std::size_t>(cols) +
                      static_cast<std::size_t>(col)];
    }
};

/// Whether two dimensions, (rows, columns), are a volume of one layer.
enum class NpyImages { kRefused, kOneLayer };

/// The volume in `bytes`, a whole .npy file: three dimensions of 1..65535, at most 2^26 values,
/// booleans, integers or floating-point numbers, little-endian, C order.
/// \throws InputError at `where` for anything else.
[[nodiscard]] NpyVolume parse_npy_volume(std::span<const std::byte> bytes, std::string_view where,
                                         NpyImages images = NpyImages::kRefused);

/// \throws InputError as above, or if the file cannot be read.
[[nodiscard]] NpyVolume read_npy_volume(const std::filesystem::path& file,
                                        NpyImages images = NpyImages::kRefused);

}  // namespace stipple
