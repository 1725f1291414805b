#include "io/partial_output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

namespace stipple {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kMark = ".partial";

/// "-" and hexadecimal digits, or nothing, as of version 0.1.
bool is_random_part(std::string_view text) {
    return text.empty() || (text.front() == '-' && text.size() > 1 &&
                            text.find_first_not_of("0123456789abcdef", 1) == text.npos);
}

/// The name of a process; empty if there is none.
std::string process_name(const std::string& process) {
    std::ifstream file(fmt::format("/proc/{}/comm", process));
    std::string name;
    std::getline(file, name);
    return name;
}

/// When a process began, by the clock of files; nothing if that cannot be told.
std::optional<fs::file_time_type> began(int process) {
    constexpr int kStartField = 22;  // of proc(5), ticks since the machine was started
    std::ifstream file(fmt::format("/proc/{}/stat", process));
    std::string text;
    std::getline(file, text, '\0');
    std::istringstream fields(text.substr(text.rfind(')') + 1));  // the name before may hold spaces
    for (int field = 3; field < kStartField; ++field) fields >> text;
    double ticks = 0;
    timespec now{};
    if (!(fields >> ticks) || clock_gettime(CLOCK_BOOTTIME, &now) != 0) return std::nullopt;
    const double age_s = static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9 -
                         ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
    return fs::file_time_type::clock::now() -
           std::chrono::duration_cast<fs::file_time_type::duration>(
               std::chrono::duration<double>(age_s));
}

}  // namespace

bool PartialOutput::running() const {
    const std::string own_name = process_name("self");
    const std::string name = process_name(std::to_string(process));
    std::error_code error;
    // A name that cannot be read, as where no further file can be opened, may be this program's.
    if (own_name.empty() || name.empty())
        return fs::exists(fmt::format("/proc/{}", process), error);
    if (name != own_name) return false;
    // A process that is younger than the file has got the number of one that is gone; the clock of
    // a file server may be a little behind.
    const auto written = fs::last_write_time(path, error);
    return error || began(process).value_or(written) <= written + std::chrono::minutes(1);
}

fs::path folder_of(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

fs::path partial_path(const fs::path& final_path, int process, std::uint32_t random) {
    return folder_of(final_path) / fmt::format(".{}.{}-{:08x}{}{}", final_path.stem().string(),
                                               process, random, kMark,
                                               final_path.extension().string());
}

std::optional<PartialOutput> partial_output(const fs::path& path) {
    const std::string name = path.filename().string();
    const auto mark = name.rfind(kMark);
    if (!name.starts_with('.') || mark == std::string::npos || mark == 0) return std::nullopt;
    const std::string extension = name.substr(mark + kMark.size());
    if (!extension.empty() && extension.front() != '.') return std::nullopt;
    const auto dot = name.rfind('.', mark - 1);
    if (dot == std::string::npos || dot < 2) return std::nullopt;
    PartialOutput found{path, path.parent_path() / (name.substr(1, dot - 1) + extension)};
    const char* const end = name.data() + mark;
    const auto [read_to, error] = std::from_chars(name.data() + dot + 1, end, found.process);
    if (error != std::errc() || found.process < 1) return std::nullopt;
    if (!is_random_part({read_to, end})) return std::nullopt;
    return found;
}

std::vector<PartialOutput> partial_outputs(const fs::path& folder) {
    std::vector<PartialOutput> found;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
        if (auto partial = partial_output(entry.path())) found.push_back(std::move(*partial));
    std::ranges::sort(found, {}, &PartialOutput::path);
    return found;
}

std::optional<fs::path> partial_of(const fs::path& final_path) {
    std::error_code error;
    std::optional<fs::path> newest;
    for (const PartialOutput& partial : partial_outputs(folder_of(final_path)))
        if (partial.final_path.filename() == final_path.filename() &&
            (!newest ||
             fs::last_write_time(partial.path, error) > fs::last_write_time(*newest, error)))
            newest = partial.path;
    return newest;
}

bool exchange_names(const fs::path& a, const fs::path& b) {
    if (renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0) return true;
    // EXDEV: a folder of a lower layer of an overlay, as in a container.
    if (errno == EINVAL || errno == ENOSYS || errno == EXDEV) return false;
    throw fs::filesystem_error("rename", std::error_code(errno, std::generic_category()));
}

bool rename_to_free_name(const fs::path& from, const fs::path& to) {
    if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
    if (errno == EEXIST) return false;
    if (errno != EINVAL && errno != ENOSYS)
        throw fs::filesystem_error("rename", std::error_code(errno, std::generic_category()));
    // The file system does not know it: look first.
    if (fs::exists(fs::symlink_status(to))) return false;
    fs::rename(from, to);
    return true;
}

}  // namespace stipple
