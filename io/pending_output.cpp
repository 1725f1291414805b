#include "io/pending_output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <new>
#include <random>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "io/disk_sync.h"
#include "io/partial_output.h"

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
    if (!result.empty() && !result.has_filename() && kind != OutputKind::kFolder)
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

}  // namespace

bool is_frame_name(std::string_view name) {
    constexpr std::size_t kSides = 6 + 4;  // "frame_" or "light_", and the extension
    if (name.size() < kSides + 4) return false;
    const std::string_view prefix = name.substr(0, 6);
    const std::string_view suffix = name.substr(name.size() - 4);
    const bool exr = prefix == "frame_" && suffix == ".exr";
    const bool integers = prefix == "light_" && (suffix == ".png" || suffix == ".tif");
    return (exr || integers) && all_digits(name.substr(6, name.size() - kSides));
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

/// Removes a folder that holds nothing but files of ours; fails, and keeps them, if others have
/// come in since.
void remove_own_files(const fs::path& folder, IsOwnName is_own) {
    for (const auto& entry : fs::directory_iterator(folder))
        if (is_own(entry.path().filename().string())) fs::remove(entry.path());
    fs::remove(folder);
}

void refuse_link(const fs::path& path) {
    std::error_code error;
    if (fs::is_symlink(fs::symlink_status(path, error)))
        throw InputError(path.string(),
                         "is a link, which is neither followed nor replaced in a folder that this "
                         "program fills; remove it");
}

/// What the link `path` leads to, by further links too; `path` if it is none.
fs::path link_target(const fs::path& path) {
    constexpr int kMaxLinks = 40;  // as of Linux
    fs::path target = path;
    std::error_code error;
    for (int i = 0; i < kMaxLinks && fs::is_symlink(fs::symlink_status(target, error)); ++i) {
        struct statfs system {};
        if (statfs(folder_of(target).c_str(), &system) == 0 && system.f_type == PROC_SUPER_MAGIC)
            throw InputError(path.string(),
                             "stands for a file that is open, which no other can replace; give "
                             "another name");
        target = folder_of(target) / fs::read_symlink(target, error);
    }
    if (target == path) return path;
    if (!fs::exists(target, error))
        throw InputError(path.string(),
                         fmt::format("is a link to \"{}\", which does not exist; give another name",
                                     target.string()));
    return fs::canonical(target, error);
}

}  // namespace

PendingOutput::PendingOutput(const fs::path& final_path, bool force, OutputKind kind,
                             IsOwnName is_own)
    : final_(tidy(final_path, kind)),
      force_(force),
      kind_(kind == OutputKind::kFolder ? kind : OutputKind::kFile),
      is_own_(is_own) {
    if (kind == OutputKind::kFile) final_ = link_target(final_);
    if (kind == OutputKind::kManagedFile) refuse_link(final_);
    const fs::path parent = folder_of(final_);
    std::error_code error;
    if (!fs::is_directory(parent, error))
        throw InputError(final_.string(), fmt::format("there is no folder \"{}\"; create it first",
                                                      parent.string()));
    if (fs::exists(fs::symlink_status(final_, error))) check_replaceable();
    partial_ = partial_path(final_, getpid(), std::random_device()());
    const std::string& name = partial_.native();
    listed_ = std::make_unique<char[]>(name.size() + 1);
    std::copy_n(name.c_str(), name.size() + 1, listed_.get());
    if (kind == OutputKind::kFolder) create_partial();
    place_in_list_ = list_partial(listed_.get());
}

void PendingOutput::check_replaceable() const {
    const auto refuse = [&](const Message& problem) { throw InputError(final_.string(), problem); };
    std::error_code error;
    const auto status = fs::symlink_status(final_, error);
    if (kind_ == OutputKind::kFile && fs::is_directory(status))
        refuse("is a folder; name a file in it");
    if (kind_ == OutputKind::kFile && !fs::is_regular_file(status))
        refuse("exists already and is not a regular file; give another name");
    if (kind_ == OutputKind::kFolder && fs::is_directory(status) && fs::is_empty(final_, error))
        return;
    if (!force_)
        refuse("exists already; give another name, or " + Parameter{"force", "true"} +
               " to replace it");
    if (kind_ == OutputKind::kFile) return;
    if (!fs::is_directory(status)) refuse("is not a folder; give another name");
    try {
        const fs::path foreign = foreign_entry(final_, is_own_);
        if (!foreign.empty())
            refuse(
                fmt::format("holds \"{}\", which this run does not write, so the folder "
                            "is not replaced; give another name",
                            foreign.filename().string()));
    } catch (const fs::filesystem_error& e) {
        refuse("cannot be listed: " + e.code().message());
    }
}

void PendingOutput::create_partial() const {
    // What lies there under that name is somebody else's: a link into another folder, say.
    constexpr int kNew = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
    const int made = kind_ == OutputKind::kFolder ? mkdir(partial_.c_str(), 0777)
                                                  : open(partial_.c_str(), kNew, 0666);
    if (made < 0)
        throw DeviceError(final_.string(),
                          "cannot be created: " + std::generic_category().message(errno));
    if (kind_ == OutputKind::kFile) close(made);
    created_ = true;
}

const fs::path& PendingOutput::partial() const {
    if (!created_) create_partial();
    return partial_;
}

PendingOutput::~PendingOutput() {
    if (!created_ || (!kept_ && remove_partial())) unregister();
    if (place_in_list_ < kListedOutputs) static_cast<void>(listed_.release());  // the list has it
}

bool PendingOutput::remove_partial() const noexcept try {
    std::error_code error;
    kind_ == OutputKind::kFile ? fs::remove(partial_, error) : fs::remove_all(partial_, error);
    return !error;
} catch (const std::bad_alloc&) {
    return false;
}

void PendingOutput::unregister() {
    unlist_partial(std::exchange(place_in_list_, kListedOutputs));
}

void PendingOutput::commit() {
    kept_ = true;
    fs::path name = final_;
    try {
        sync_all_to_disk(partial_);
        if (!rename_to_final()) name = rename_to_fallback();
    } catch (const fs::filesystem_error& e) {
        std::error_code error;
        const DeviceError failure(
            final_.string(),
            fmt::format("cannot be put in place: {}{}", e.code().message(),
                        fs::exists(partial_, error)
                            ? fmt::format("; what was written is in {}, rename it to keep it",
                                          partial_.string())
                            : ""));
        unregister();
        throw failure;
    }
    committed_ = true;
    if (!replaced_) unregister();
    settle(name);
    unregister();
    if (name != final_)
        throw DeviceError(final_.string(),
                          fmt::format("was created by another program meanwhile; what was "
                                      "written is in {}",
                                      name.string()));
}

void PendingOutput::settle(const fs::path& name) {
    std::string_view problem = "its name may not be on the disk";
    try {
        sync_to_disk(folder_of(name));
        problem = "what it replaces cannot be removed";
        if (replaced_) remove_own_files(partial_, is_own_);
    } catch (const fs::filesystem_error& e) {
        const DeviceError failure(
            name.string(),
            fmt::format(
                "is complete, but {}: {}{}", problem, e.code().message(),
                replaced_ ? fmt::format("; the output before is in {}", partial_.string()) : ""));
        unregister();
        throw failure;
    }
}

bool PendingOutput::rename_to_final() {
    if (kind_ == OutputKind::kFolder && !force_) rmdir(final_.c_str());  // only if it is empty
    if (!force_) return rename_to_free_name(partial_, final_);
    if (kind_ == OutputKind::kFolder && fs::is_directory(fs::symlink_status(final_))) {
        if (!foreign_entry(final_, is_own_).empty())
            throw fs::filesystem_error("rename",
                                       std::make_error_code(std::errc::directory_not_empty));
        replaced_ = exchange_names(partial_, final_);
        if (replaced_) return true;
        remove_own_files(final_, is_own_);
    }
    fs::rename(partial_, final_);
    return true;
}

fs::path PendingOutput::rename_to_fallback() const {
    for (int number = 2;; ++number) {
        fs::path name = final_.parent_path() / fmt::format("{}_{}{}", final_.stem().string(),
                                                           number, final_.extension().string());
        if (rename_to_free_name(partial_, name)) return name;
    }
}

void refuse_links(const fs::path& folder) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
        refuse_link(entry.path());
}

void visit_partial_outputs(void (*visit)(const char* path)) noexcept {
    for (const std::atomic<const char*>& path : listed_paths)
        if (const char* listed = path.load()) visit(listed);
}

}  // namespace stipple
