#include "apps/leftovers.h"

#include <fmt/format.h>

#include <system_error>

#include "apps/interrupt.h"
#include "apps/report/standard_error.h"
#include "capture/recording/recording_reader.h"
#include "core/error.h"
#include "io/disk_sync.h"
#include "stream/stream_reader.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

/// How much of a file is whole.
struct Whole {
    std::uint64_t count = 0;  ///< slots or frames
    std::uint64_t tail_bytes = 0;
    bool complete = false;
};

Whole whole_of_stream(const fs::path& file) {
    StreamReader reader(file, ReadPolicy::kCounts);
    SamplePacket packet;
    while (reader.next(packet)) throw_if_stopped();
    const StreamReport& report = reader.report();
    return {static_cast<std::uint64_t>(report.slots), report.tail_bytes, report.complete};
}

Whole whole_of_recording(const fs::path& file) {
    RecordingReader reader(file);
    CapturedFrame frame;
    while (reader.next(frame)) throw_if_stopped();
    return {reader.report().frames, reader.report().tail_bytes, reader.end().has_value()};
}

}  // namespace

void say_leftover(const fs::path& output) {
    std::error_code error;
    const bool linked = fs::is_symlink(fs::symlink_status(output, error));
    const fs::path file = linked ? fs::canonical(output, error) : output;
    const fs::path name = file.has_filename() ? file : file.parent_path();
    const fs::path folder = folder_of(name);
    for (const PartialOutput& partial : partial_outputs(folder)) {
        if (partial.final_path.filename() != name.filename() || partial.running()) continue;
        say_error("{}: a run that was killed left {}; `stipple recover {}` says what can be kept",
                  output.string(), partial.path.filename().string(), folder.string());
        return;
    }
}

std::string leftover_text(const fs::path& file) {
    const auto partial = partial_output(file);
    if (!partial) return {};
    if (partial->running()) return fmt::format("; process {} is writing it", partial->process);
    return fmt::format("; its run was killed, `stipple recover {}` keeps it", file.string());
}

Recoverable recoverable(const fs::path& partial) {
    std::error_code error;
    if (!fs::is_regular_file(partial, error)) return Recoverable::kNo;
    try {
        if (is_recording(partial)) return Recoverable::kRecording;
        const StreamReader header_of(partial, ReadPolicy::kCounts);
        return Recoverable::kStream;
    } catch (const InputError&) {
        return Recoverable::kNo;
    }
}

Recovered recover(const fs::path& partial, const fs::path& output) {
    const Recoverable kind = recoverable(partial);
    if (kind == Recoverable::kNo)
        throw InputError(partial.string(),
                         "cannot be recovered: it is no stream or recording with a whole header, "
                         "and other files are whole at their end only; delete it");
    const bool stream = kind == Recoverable::kStream;
    const Whole whole = stream ? whole_of_stream(partial) : whole_of_recording(partial);
    if (whole.count == 0)
        throw InputError(partial.string(),
                         fmt::format("holds no whole {}; delete it", stream ? "packet" : "frame"));
    const auto refuse = [&] {
        throw InputError(output.string(), "exists already; give another name with -o");
    };
    try {
        if (fs::exists(fs::symlink_status(output))) refuse();
        fs::resize_file(partial, fs::file_size(partial) - whole.tail_bytes);
        sync_to_disk(partial);
        if (!rename_to_free_name(partial, output)) refuse();
        sync_to_disk(folder_of(output));
    } catch (const fs::filesystem_error& e) {
        throw DeviceError(output.string(), "cannot be put in place: " + e.code().message());
    }
    std::string text =
        fmt::format("{}: {} whole {}", output.string(), whole.count, stream ? "slots" : "frames");
    if (whole.tail_bytes > 0)
        text += fmt::format(", {} bytes of the next one cut off", whole.tail_bytes);
    text += whole.complete ? "; it is complete" : "; without an end, which marks it as cut off";
    return {text, whole.count, whole.tail_bytes};
}

}  // namespace stipple
