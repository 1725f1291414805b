#include "readout/timing/waveform_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <span>
#include <vector>

#include "core/error.h"
#include "io/footage_files.h"
#include "io/output_file.h"
#include "io/text_file.h"
#include "readout/timing/waveform.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

constexpr auto kConverter = "vcd2fst";

/// Exit status of vcd2fst. \throws DeviceError if it cannot be started.
int run_converter(std::vector<std::string> arguments) {
    std::string name = kConverter;
    std::vector<char*> pointers{name.data()};
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t silent;
    posix_spawn_file_actions_init(&silent);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&silent, stream, "/dev/null", O_RDWR, 0);
    pid_t child = 0;
    const int problem =
        posix_spawnp(&child, kConverter, &silent, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&silent);
    if (problem != 0)
        throw DeviceError(kConverter,
                          fmt::format("{}; a .fst needs it: install the package gtkwave, or name a "
                                      ".vcd",
                                      strerror(problem)));
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

fs::path with_extension(fs::path file, const char* extension) {
    return file.replace_extension(extension);
}

/// \throws DeviceError naming `final_path`.
void convert(const fs::path& vcd, const fs::path& fst, const fs::path& final_path) {
    std::error_code error;
    if (run_converter({fs::absolute(vcd).string(), fs::absolute(fst).string()}) != 0 ||
        fs::file_size(fst, error) == 0)
        throw DeviceError(
            final_path.string(),
            fmt::format("{} failed, perhaps for want of room; name a .vcd", kConverter));
}

}  // namespace

WaveformFile::WaveformFile(const fs::path& file, bool force)
    : output_(file, force), view_(with_extension(file, ".gtkw"), force) {
    if (lower_extension(file) != ".fst") return;
    run_converter({"-h"});  // or the work would be in vain
    // With force, because this name is only that of a hidden file.
    vcd_.emplace(with_extension(file, ".vcd"), true);
}

void WaveformFile::write(ReadoutCost& cost, const std::string& sensor, SlotRange range,
                         const std::function<bool()>& keep_going) {
    const fs::path& final_path = output_.final_path();
    OutputFile file((vcd_ ? *vcd_ : output_).partial(), final_path.string());
    const auto write = [&](const std::string& text) { file.write(std::as_bytes(std::span(text))); };
    Waveform waveform(cost.timing(), sensor);
    write(waveform.head());
    cost.begin_at(range.first);
    for (std::int64_t i = 0; i < range.slots && keep_going(); ++i) write(waveform.add_slot(cost));
    write(waveform.tail(cost.clocks()));
    file.close();
    if (vcd_) convert(vcd_->partial(), output_.partial(), final_path);
    output_.commit();
    write_text(view_, waveform.view(final_path.filename().string()));
}

}  // namespace stipple
