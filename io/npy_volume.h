#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace stipple {

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
