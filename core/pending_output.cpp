#include "core/pending_output.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/partial_output.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

/// Paths of the partial outputs, for a signal handler, which must not wait for a lock.
constexpr std::size_t kListedOutputs = 32;
std::array<std::atomic<const char*>, kListedOutputs> listed_paths{};

/// The place that `path` took in the list, or kListedOutputs if it is full.
std::size_t list_partial(const char* path) {
    for (std::size_t i = 0; i < kListedOutputs; ++i) {
        const char* none = nullptr;
        if (listed_paths[i].compare_exchange_strong(none, path)) return i;
    }
    return kListedOutputs;
}

void unlist_partial(std::size_t place) {
    if (place < kListedOutputs) listed_paths[place] = nullptr;
}

/// The output's path without "." parts and a folder's trailing slash.
fs::path tidy(const fs::path& path, OutputKind kind) {
    if (path == "-")
        throw InputError("output \"-\"", "standard output does not take it; give it a name");
    fs::path result = path.lexically_normal();
    std::error_code error;
    if (!result.empty() && !result.has_filename() && kind == OutputKind::kFile)
        throw InputError(fmt::format("output \"{}\"", path.string()),
                         fs::is_directory(result, error)
                             ? "is a folder; name a file in it"
                             : "names a folder that does not exist; create it first, or leave out "
                               "the slash at the end");
    if (!result.has_filename()) result = result.parent_path();
    const auto name = result.filename();
    if (name.empty() || name == "." || name == "..")
        throw InputError(fmt::format("output \"{}\"", path.string()),
                         "names no new file or folder; give it a name");
    return result;
}

bool all_digits(std::string_view text) {
    return std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

fs::path folder_of(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

}  // namespace

bool is_frame_name(std::string_view name) {
    constexpr std::string_view kPrefix = "frame_";
    constexpr std::string_view kSuffix = ".exr";
    if (!name.starts_with(kPrefix) || !name.ends_with(kSuffix)) return false;
    if (name.size() < kPrefix.size() + 4 + kSuffix.size()) return false;
    name.remove_prefix(kPrefix.size());
    name.remove_suffix(kSuffix.size());
    return all_digits(name);
}

namespace {

/// An entry of `folder` that is not ours, or an empty path.
fs::path foreign_entry(const fs::path& folder, IsOwnName is_own) {
    for (const auto& entry : fs::directory_iterator(folder))
        if (!is_own(entry.path().filename().string()) ||
            !fs::is_regular_file(entry.symlink_status()))
            return entry.path();
    return {};
}

}  // namespace

PendingOutput::PendingOutput(const fs::path& final_path, bool force, OutputKind kind,
                             IsOwnName is_own)
    : final_(tidy(final_path, kind)), force_(force), kind_(kind), is_own_(is_own) {
    const fs::path parent = folder_of(final_);
    std::error_code error;
    if (!fs::is_directory(parent, error))
        throw InputError(final_.string(), fmt::format("there is no folder \"{}\"; create it first",
                                                      parent.string()));
    if (fs::exists(fs::symlink_status(final_, error))) check_replaceable();
    partial_ = partial_path(final_, getpid());
    fs::remove_all(partial_, error);  // left by an earlier process of the same number
    if (kind == OutputKind::kFolder && !fs::create_directory(partial_, error))
        throw DeviceError(final_.string(), "cannot be created: " + error.message());
    place_in_list_ = list_partial(partial_.c_str());
}

void PendingOutput::check_replaceable() const {
    const auto refuse = [&](const std::string& problem) {
        throw InputError(final_.string(), problem);
    };
    std::error_code error;
    if (kind_ == OutputKind::kFolder && fs::is_directory(fs::symlink_status(final_, error)) &&
        fs::is_empty(final_, error))
        return;
    if (!force_) refuse("exists already; give another name, or --force to replace it");
    const auto status = fs::status(final_, error);
    if (kind_ == OutputKind::kFile) {
        if (!fs::is_regular_file(status)) refuse("is not a regular file; give another name");
        return;
    }
    if (!fs::is_directory(fs::symlink_status(final_, error)))
        refuse("is not a folder; give another name");
    try {
        const fs::path foreign = foreign_entry(final_, is_own_);
        if (!foreign.empty())
            refuse(
                fmt::format("holds \"{}\", which is no file that this run writes, so the folder "
                            "is not replaced; give another name",
                            foreign.filename().string()));
    } catch (const fs::filesystem_error& e) {
        refuse("cannot be listed: " + e.code().message());
    }
}

PendingOutput::~PendingOutput() {
    unlist_partial(place_in_list_);
    std::error_code error;
    if (!committed_) fs::remove_all(partial_, error);
}

void PendingOutput::remove_replaced_folder() const {
    for (const auto& entry : fs::directory_iterator(final_))
        if (is_own_(entry.path().filename().string())) fs::remove(entry.path());
    fs::remove(final_);  // fails, and keeps them, if other files have come in since
}

void PendingOutput::commit() {
    try {
        const auto status = fs::symlink_status(final_);
        if (kind_ == OutputKind::kFolder && force_ && fs::is_directory(status))
            remove_replaced_folder();
        if (kind_ == OutputKind::kFolder && !force_) rmdir(final_.c_str());  // only if it is empty
        if (force_) {
            fs::rename(partial_, final_);
        } else if (!rename_to_free_name(partial_, final_)) {
            keep_under_another_name();
        }
    } catch (const fs::filesystem_error& e) {
        throw DeviceError(final_.string(), "cannot be put in place: " + e.code().message());
    }
    set_committed();
}

void PendingOutput::keep_under_another_name() {
    for (int number = 2;; ++number) {
        const fs::path name =
            final_.parent_path() /
            fmt::format("{}_{}{}", final_.stem().string(), number, final_.extension().string());
        if (!rename_to_free_name(partial_, name)) continue;
        set_committed();
        throw DeviceError(final_.string(),
                          fmt::format("was created by another program meanwhile; what was "
                                      "written is in {}",
                                      name.string()));
    }
}

void PendingOutput::set_committed() {
    committed_ = true;
    unlist_partial(std::exchange(place_in_list_, kListedOutputs));
}

void visit_partial_outputs(void (*visit)(const char* path)) noexcept {
    for (const std::atomic<const char*>& path : listed_paths)
        if (const char* listed = path.load()) visit(listed);
}

}  // namespace stipple
