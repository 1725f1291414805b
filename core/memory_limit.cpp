#include "core/memory_limit.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <system_error>

#include "core/error.h"
#include "core/text.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;
constexpr std::uint64_t kGiB = std::uint64_t{1} << 30U;
constexpr std::uint64_t kMaxOfSmallInputs = 256 * kMiB;

std::uint64_t told_bytes = 0;  ///< by the living MemoryLimit; 0: none lives

std::string text_of(std::uint64_t bytes) {
    const auto size = static_cast<double>(bytes);
    return bytes < kGiB ? fmt::format("{:.0f} MiB", size / kMiB)
                        : fmt::format("{:.1f} GiB", size / kGiB);
}

/// A little more than `bytes`, as `parse_memory` reads it.
std::string option_of(std::uint64_t bytes) {
    constexpr std::uint64_t kStep = 64 * kMiB;
    return bytes < 4 * kGiB ? fmt::format("{}M", (bytes / kStep + 1) * (kStep / kMiB))
                            : fmt::format("{}G", bytes / kGiB + 1);
}

/// What a file says before anything else, if that is a number.
std::uint64_t limit_in(const std::string& file) {
    std::uint64_t limit = 0;
    return std::ifstream(file) >> limit ? limit : kEndlessInput;
}

}  // namespace

MemoryLimit::MemoryLimit(std::uint64_t bytes) : before_(told_bytes) {
    told_bytes = bytes;
}

MemoryLimit::~MemoryLimit() {
    told_bytes = before_;
}

std::uint64_t input_bytes(const fs::path& file) {
    std::error_code error;
    if (fs::is_regular_file(file, error)) return fs::file_size(file, error);
    if (!fs::is_directory(file, error)) return kEndlessInput;
    std::uint64_t bytes = 0;
    for (const auto& entry : fs::directory_iterator(file, error))
        if (entry.is_regular_file(error)) bytes += entry.file_size(error);
    return error ? kEndlessInput : bytes;
}

std::uint64_t max_memory(std::uint64_t input_bytes) {
    if (told_bytes > 0) return told_bytes;
    static const std::uint64_t quarter = machine_memory() / 4;  // asked for at each image
    return input_bytes < kSmallInput ? std::min(quarter, kMaxOfSmallInputs) : quarter;
}

void check_memory(std::uint64_t bytes, const Message& where, std::string_view what,
                  std::uint64_t input_bytes) {
    const std::uint64_t allowed = max_memory(input_bytes);
    if (bytes <= allowed) return;
    const Message whose = told_bytes > 0 ? Parameter{"max_memory"} + " says"
                          : allowed == max_memory()
                              ? "a run may take, a quarter of this machine's memory"
                              : "a file of less than 1 MB may take";
    throw InputError(where, fmt::format("needs {} of memory for {}, more than the {} that ",
                                        text_of(bytes), what, text_of(allowed)) +
                                whose + "; " + Parameter{"max_memory", option_of(bytes)} +
                                " allows it");
}

std::uint64_t machine_memory(const fs::path& proc, const fs::path& groups) {
    const auto size = [](int name) { return static_cast<std::uint64_t>(sysconf(name)); };
    std::uint64_t bytes = size(_SC_PHYS_PAGES) * size(_SC_PAGESIZE);
    std::ifstream lists(proc / "cgroup");  // "0::/path", of version 1 "4:memory:/path"
    for (std::string line; std::getline(lists, line);) {
        const auto controllers = line.find(':');
        const auto path = line.find(":/");
        if (controllers == std::string::npos || path == std::string::npos) continue;
        const bool second = line.starts_with("0::");
        if (!second &&
            line.substr(controllers, path - controllers).find("memory") == std::string::npos)
            continue;
        const std::string root = (second ? groups : groups / "memory").string();
        const char* const name = second ? "/memory.max" : "/memory.limit_in_bytes";
        // A container may see its own group as the root. Not by fs::path, which libstdc++ 12 frees
        // twice where memory runs out while it takes a path apart.
        for (std::string group = line.substr(path + 1);; group.erase(group.rfind('/'))) {
            bytes = std::min(bytes, limit_in(root + group + name));
            if (group.empty()) break;
        }
    }
    return bytes;
}

std::optional<std::uint64_t> parse_memory(std::string_view text) {
    constexpr std::string_view kUnits = "KMGT";
    const auto unit = text.empty() ? std::string_view::npos : kUnits.find(text.back());
    if (unit == std::string_view::npos) return std::nullopt;
    text.remove_suffix(1);
    const auto number = parsed_number<double>(text);
    if (!number) return std::nullopt;
    const double bytes = *number * static_cast<double>(std::uint64_t{1024} << (10 * unit));
    if (!(bytes >= static_cast<double>(kMiB) && bytes < 0x1p60)) return std::nullopt;
    return static_cast<std::uint64_t>(bytes);
}

}  // namespace stipple
