#include "io/mat_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <new>
#include <span>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/geometry.h"
#include "core/index.h"
#include "core/input_file.h"
#include "core/memory_limit.h"

#ifdef STIPPLE_MATIO
#include <dlfcn.h>
#include <matio.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/lazy_function.h"
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

STIPPLE_LAZY_FROM(matio_function, Mat_Close);
STIPPLE_LAZY_FROM(matio_function, Mat_GetDir);
STIPPLE_LAZY_FROM(matio_function, Mat_GetVersion);
STIPPLE_LAZY_FROM(matio_function, Mat_Open);
STIPPLE_LAZY_FROM(matio_function, Mat_VarFree);
STIPPLE_LAZY_FROM(matio_function, Mat_VarRead);
STIPPLE_LAZY_FROM(matio_function, Mat_VarReadInfo);

constexpr std::size_t kMaxValues = std::size_t{1} << 26U;

struct Closer {
    void operator()(mat_t* file) const { Mat_Close(file); }
    void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
    void operator()(std::FILE* file) const { std::fclose(file); }
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
        case MAT_T_UINT64:
            return copy<std::uint64_t>(variable.data, volume);
        case MAT_T_INT64:
            return copy<std::int64_t>(variable.data, volume);
        default:
            throw InputError(where, "holds no numbers of 8 to 64 bits");
    }
}

/// \throws InputError unless it is an array of real numbers.
void check_class(const matvar_t& variable, const std::string& where) {
    if (variable.isComplex != 0)
        throw InputError(where, "holds complex numbers; save real ones, as abs(x)");
    switch (variable.class_type) {
        case MAT_C_SPARSE:
            throw InputError(where, "is a sparse array; save full(x)");
        case MAT_C_CHAR:
        case MAT_C_CELL:
        case MAT_C_STRUCT:
        case MAT_C_OBJECT:
        case MAT_C_FUNCTION:
        case MAT_C_OPAQUE:
            throw InputError(where,
                             "is text, a cell, a structure or an object; save an array of "
                             "numbers");
        default:
            break;
    }
}

NpyVolume volume_of(const matvar_t& variable, const std::string& where) {
    check_class(variable, where);
    const std::span dims(variable.dims, static_cast<std::size_t>(std::max(variable.rank, 0)));
    std::size_t values = 1;
    for (const std::size_t side : dims) {
        if (side < 1 || side > kMaxFrameSide) throw InputError(where, "has a side not in 1..65535");
        values = std::min(values * side, kMaxValues + 1);
    }
    if (dims.size() < 2 || dims.size() > 3 || values > kMaxValues)
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

NpyVolume read_here(const std::string& file, const std::string& name) {
    const MatFile mat(Mat_Open(file.c_str(), MAT_ACC_RDONLY));
    if (!mat) throw InputError(file, "cannot be read as a .mat file");
    if (Mat_GetVersion(mat.get()) == MAT_FT_MAT5 && !is_whole(file))
        throw InputError(file, "is cut off or damaged: its elements do not fill it");
    const std::string where = fmt::format("{}: variable \"{}\"", file, name);
    const MatVariable described(Mat_VarReadInfo(mat.get(), name.c_str()));
    if (!described)
        throw InputError(where, fmt::format("is missing; the file holds {}; other names: ",
                                            names_in(mat.get())) +
                                    Parameter{"variable"} + ", " + Parameter{"mask_variable"});
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

/// What the process that reads sends: numbers, or the two parts of an InputError.
struct Reply {
    enum class Kind { kVolume, kInputError, kNoMemory } kind = Kind::kNoMemory;
    int layers = 0, rows = 0, cols = 0;
    std::uint64_t where_bytes = 0, bytes = 0;  ///< bytes: of what follows
};

void send(std::FILE* file, Reply reply, std::span<const std::byte> content) {
    reply.bytes = content.size();
    std::fwrite(&reply, sizeof(reply), 1, file);
    std::fwrite(content.data(), 1, content.size(), file);
    std::fflush(file);
}

void receive(std::FILE* file, std::span<std::byte> bytes, const std::string& where) {
    if (std::fread(bytes.data(), 1, bytes.size(), file) != bytes.size())
        throw InputError(where,
                         "cannot be read as a .mat file: matio, which reads it, failed; the file "
                         "is damaged");
}

constexpr char kParameter = '\x1F', kValue = '\x1E';

/// A parameter between two kParameter, for message_of.
std::string marked(const Parameter& parameter) {
    return kParameter + parameter.name + kValue + parameter.value + kParameter;
}

/// The message of such a text.
Message message_of(std::string_view text) {
    Message message;
    for (bool is_parameter = false;; is_parameter = !is_parameter) {
        const std::string_view part = text.substr(0, text.find(kParameter));
        const auto value = part.find(kValue);
        if (is_parameter && value != std::string_view::npos)
            message +=
                Parameter{std::string(part.substr(0, value)), std::string(part.substr(value + 1))};
        else if (!part.empty())
            message += part;
        if (part.size() == text.size()) return message;
        text.remove_prefix(part.size() + 1);
    }
}

/// From now on, this process takes little more memory and time than a whole file may need.
void limit_process(const std::string& file) {
    constexpr rlim_t kSlackBytes = 16U << 20U, kSeconds = 10, kBytesPerSecond = 1'000'000;
    const std::uint64_t bytes = input_bytes(file);
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t memory =
        pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + kSlackBytes + max_memory(bytes);
    const rlim_t seconds = kSeconds + bytes / kBytesPerSecond;
    const rlimit memory_limit{memory, memory}, time_limit{seconds, seconds}, no_core{0, 0};
    setrlimit(RLIMIT_AS, &memory_limit);
    setrlimit(RLIMIT_CPU, &time_limit);
    setrlimit(RLIMIT_CORE, &no_core);
}

void read_for(std::FILE* reply, const std::string& file, const std::string& name) {
    try {
        limit_process(file);
        const NpyVolume volume = read_here(file, name);
        send(reply,
             {.kind = Reply::Kind::kVolume,
              .layers = volume.layers,
              .rows = volume.rows,
              .cols = volume.cols},
             std::as_bytes(std::span(volume.values)));
    } catch (const InputError& e) {
        const std::string text = e.message().text(marked);
        send(reply,
             {.kind = Reply::Kind::kInputError, .where_bytes = e.where().text(marked).size()},
             std::as_bytes(std::span(text)));
    } catch (const std::bad_alloc&) {
        send(reply, {.kind = Reply::Kind::kNoMemory}, {});
    } catch (...) {  // without a reply, the file counts as damaged
    }
}

NpyVolume received_volume(std::FILE* file, const std::string& where) {
    Reply reply;
    receive(file, std::as_writable_bytes(std::span(&reply, 1)), where);
    if (reply.kind == Reply::Kind::kNoMemory) throw std::bad_alloc();
    if (reply.kind == Reply::Kind::kInputError) {
        constexpr std::size_t kColon = 2;
        std::string text(reply.bytes, '\0');
        receive(file, std::as_writable_bytes(std::span(text)), where);
        throw InputError(message_of(text.substr(0, reply.where_bytes)),
                         message_of(text.substr(reply.where_bytes + kColon)));
    }
    NpyVolume volume{.layers = reply.layers, .rows = reply.rows, .cols = reply.cols, .values = {}};
    volume.values.resize(reply.bytes / sizeof(double));
    receive(file, std::as_writable_bytes(std::span(volume.values)), where);
    return volume;
}

}  // namespace

// matio believes the lengths in a file, and may crash where they are wrong. So it reads in a
// process of its own, whose memory and time are limited.
NpyVolume read_mat_volume(const std::string& file, const std::string& name) {
    static_cast<void>(matio_function("Mat_Open"));
    const std::unique_ptr<std::FILE, Closer> reply(
        fdopen(memfd_create("mat_volume", MFD_CLOEXEC), "w+"));
    const pid_t child = reply ? fork() : -1;
    if (child < 0)
        throw DeviceError(file,
                          std::string("no process can be started to read it: ") + strerror(errno));
    if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        read_for(reply.get(), file, name);
        _exit(0);
    }
    while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
    }
    std::rewind(reply.get());
    return received_volume(reply.get(), file);
}

#endif

}  // namespace stipple
