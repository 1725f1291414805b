#include "apps/mat_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "core/error.h"
#include "core/geometry.h"
#include "core/index.h"
#include "core/input_file.h"
#include "core/memory_limit.h"

#ifdef STIPPLE_MATIO
#include <dlfcn.h>
#include <matio.h>

#include "io/late_function.h"
#endif

namespace stipple {

bool is_mat(const std::string& file) {
    std::string extension = std::filesystem::path(file).extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension == ".mat";
}

#ifndef STIPPLE_MATIO

NpyVolume read_mat_volume(const std::string& file, const std::string& /*name*/) {
    throw InputError(file,
                     "this program was built without matio, which reads .mat files: install "
                     "libmatio-dev and build it again, or save arrays as .npy");
}

#else

namespace {

void* load_matio() {
    if (void* const library = dlopen(STIPPLE_MATIO, RTLD_NOW)) return library;
    throw DeviceError(STIPPLE_MATIO,
                      std::string("cannot be loaded, but .mat files need it: ") + dlerror());
}

/// A function of matio. It brings 30 other libraries with it, as HDF5 and libcurl; so it is loaded
/// when a .mat file is read. \throws DeviceError if it cannot be loaded.
void* matio_function(const char* name) {
    static void* const library = load_matio();
    if (void* const function = dlsym(library, name)) return function;
    throw DeviceError(STIPPLE_MATIO, std::string("does not have ") + name);
}

STIPPLE_LATE_FROM(matio_function, Mat_Close);
STIPPLE_LATE_FROM(matio_function, Mat_GetDir);
STIPPLE_LATE_FROM(matio_function, Mat_GetVersion);
STIPPLE_LATE_FROM(matio_function, Mat_Open);
STIPPLE_LATE_FROM(matio_function, Mat_VarFree);
STIPPLE_LATE_FROM(matio_function, Mat_VarRead);
STIPPLE_LATE_FROM(matio_function, Mat_VarReadInfo);

constexpr std::size_t kMaxValues = std::size_t{1} << 26U;

struct Closer {
    void operator()(mat_t* file) const { Mat_Close(file); }
    void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using MatFile = std::unique_ptr<mat_t, Closer>;
using MatVariable = std::unique_ptr<matvar_t, Closer>;

/// MATLAB counts columns before rows: order (layer, col, row).
template <typename Value>
void copy(const void* data, NpyVolume& volume) {
    const auto rows = index(volume.rows), cols = index(volume.cols);
    const std::span values(static_cast<const Value*>(data), volume.values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t layer = i / (rows * cols), col = i / rows % cols, row = i % rows;
        volume.values[(layer * rows + row) * cols + col] = static_cast<double>(values[i]);
    }
}

void copy(const matvar_t& variable, NpyVolume& volume, const std::string& where) {
    switch (variable.data_type) {
        case MAT_T_DOUBLE:
            return copy<double>(variable.data, volume);
        case MAT_T_SINGLE:
            return copy<float>(variable.data, volume);
        case MAT_T_UINT8:
            return copy<std::uint8_t>(variable.data, volume);
        case MAT_T_INT8:
            return copy<std::int8_t>(variable.data, volume);
        case MAT_T_UINT16:
            return copy<std::uint16_t>(variable.data, volume);
        case MAT_T_INT16:
            return copy<std::int16_t>(variable.data, volume);
        case MAT_T_UINT32:
            return copy<std::uint32_t>(variable.data, volume);
        case MAT_T_INT32:
            return copy<std::int32_t>(variable.data, volume);
        default:
            throw InputError(where, "holds no numbers of 8 to 64 bits");
    }
}

NpyVolume volume_of(const matvar_t& variable, const std::string& where) {
    const std::span dims(variable.dims, static_cast<std::size_t>(std::max(variable.rank, 0)));
    std::size_t values = 1;
    for (const std::size_t side : dims) {
        if (side < 1 || side > kMaxFrameSide) throw InputError(where, "has a side not in 1..65535");
        values = std::min(values * side, kMaxValues + 1);
    }
    if (dims.size() < 2 || dims.size() > 3 || values > kMaxValues || variable.isComplex != 0)
        throw InputError(where,
                         "needs real numbers (rows, columns) or (rows, columns, layers), at most "
                         "2^26 of them");
    return {.layers = dims.size() == 3 ? static_cast<int>(dims[2]) : 1,
            .rows = static_cast<int>(dims[0]),
            .cols = static_cast<int>(dims[1]),
            .values = {}};
}

/// Whether the elements of a MATLAB 5 file, each a type, a length and so many bytes, fill it after
/// its header of 128 bytes. matio takes a file for whole that ends within an element.
bool is_whole(const std::string& file) {
    check_memory(std::filesystem::file_size(file), file, "the file");
    const std::vector<std::uint8_t> bytes = read_file(file);
    constexpr std::size_t kHeader = 128, kTag = 8;
    if (bytes.size() < kHeader) return false;
    const bool big_endian = bytes[126] == 'M';
    std::size_t at = kHeader;
    while (at < bytes.size() && bytes.size() - at >= kTag) {
        std::size_t length = 0;
        for (std::size_t i = 0; i < 4; ++i)
            length |= std::size_t{bytes[at + 4 + (big_endian ? 3 - i : i)]} << (8 * i);
        at += kTag + length;
    }
    return at == bytes.size();
}

/// The first names of variables, quoted.
std::string names_in(mat_t* mat) {
    constexpr std::size_t kMaxNames = 8;
    std::size_t count = 0;
    char* const* names = Mat_GetDir(mat, &count);
    if (names == nullptr || count == 0) return "no variable";
    std::string text;
    for (const char* name : std::span(names, std::min(count, kMaxNames)))
        text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", name);
    return count > kMaxNames ? text + ", ..." : text;
}

}  // namespace

NpyVolume read_mat_volume(const std::string& file, const std::string& name) {
    const MatFile mat(Mat_Open(file.c_str(), MAT_ACC_RDONLY));
    if (!mat) throw InputError(file, "cannot be read as a .mat file");
    if (Mat_GetVersion(mat.get()) == MAT_FT_MAT5 && !is_whole(file))
        throw InputError(file, "is cut off or damaged: its elements do not fill it");
    const std::string where = fmt::format("{}: variable \"{}\"", file, name);
    const MatVariable described(Mat_VarReadInfo(mat.get(), name.c_str()));
    if (!described)
        throw InputError(where, fmt::format("is missing; the file holds {}; other names: "
                                            "--variable, --mask-variable",
                                            names_in(mat.get())));
    NpyVolume volume = volume_of(*described, where);
    const std::size_t values = index(volume.layers) * index(volume.rows) * index(volume.cols);
    check_memory(2 * sizeof(double) * values, where, "the array");
    const MatVariable variable(Mat_VarRead(mat.get(), name.c_str()));
    if (!variable || variable->data == nullptr ||
        variable->nbytes != values * static_cast<std::size_t>(variable->data_size))
        throw InputError(where, "cannot be read; the file is damaged, or holds no array in it");
    volume.values.resize(values);
    copy(*variable, volume, where);
    return volume;
}

#endif

}  // namespace stipple
