#include "capture/recording/recovery.h"

#include <fmt/format.h>

#include <system_error>

#include "capture/recording/recording_reader.h"
#include "core/error.h"
#include "io/disk_sync.h"
#include "io/partial_output.h"
#include "stream/stream_reader.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

/// How much of a stream is whole.
Recovered whole_of_stream(const fs::path& file, const std::function<void()>& check) {
    StreamReader reader(file, ReadPolicy::kCounts);
    reader.follow_switches();
    SamplePacket packet;
    while (reader.next(packet)) check();
    const StreamReport& report = reader.report();
    return {Recoverable::kStream, static_cast<std::uint64_t>(report.slots), report.tail_bytes,
            report.complete};
}

Recovered whole_of_recording(const fs::path& file, const std::function<void()>& check) {
    RecordingReader reader(file);
    CapturedFrame frame;
    while (reader.next(frame)) check();
    return {Recoverable::kRecording, reader.report().frames, reader.report().tail_bytes,
            reader.end().has_value()};
}

}  // namespace

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

Recovered recover(const fs::path& partial, const fs::path& output,
                  const std::function<void()>& check) {
    const Recoverable kind = recoverable(partial);
    if (kind == Recoverable::kNo)
        throw InputError(
            partial.string(),
            "cannot be recovered: it is not a stream or recording with a whole header, "
            "and other files are whole at their end only; delete it");
    const bool stream = kind == Recoverable::kStream;
    const Recovered whole =
        stream ? whole_of_stream(partial, check) : whole_of_recording(partial, check);
    if (whole.whole == 0)
        throw InputError(partial.string(),
                         fmt::format("holds no whole {}; delete it", stream ? "packet" : "frame"));
    const auto refuse = [&] {
        throw InputError(output.string(), "exists already; give another name with -o");
    };
    try {
        if (fs::exists(fs::symlink_status(output))) refuse();
        fs::resize_file(partial, fs::file_size(partial) - whole.cut_bytes);
        sync_to_disk(partial);
        if (!rename_to_free_name(partial, output)) refuse();
        sync_to_disk(folder_of(output));
    } catch (const fs::filesystem_error& e) {
        throw DeviceError(output.string(), "cannot be put in place: " + e.code().message());
    }
    return whole;
}

}  // namespace stipple
