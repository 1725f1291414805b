#include "io/frame_writer.h"

#include <fmt/format.h>

#include <cassert>
#include <string>
#include <system_error>
#include <utility>
#include <variant>

#include "core/error.h"
#include "core/light.h"
#include "io/exr_file.h"
#include "io/footage_files.h"
#include "io/npy_writer.h"
#include "io/pending_output.h"
#include "io/video_writer.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

/// Writes a folder of frame_%04d.exr.
class ExrFolderWriter {
  public:
    ExrFolderWriter(fs::path folder, std::string where, FrameShape shape, bool live)
        : folder_(std::move(folder)), where_(std::move(where)), shape_(shape), live_(live) {}

    void write(std::span<const float> frame) {
        const std::string name = fmt::format("frame_{:04}.exr", next_slot_++);
        const std::string where = (fs::path(where_) / name).string();
        if (!live_) return write_exr(folder_ / name, where, shape_, frame);
        PendingOutput whole(folder_ / name, false);
        write_exr(whole.partial(), where, shape_, frame);
        whole.commit();
    }
    void finish() {}

  private:
    fs::path folder_;
    std::string where_;
    FrameShape shape_;
    bool live_;
    int next_slot_ = 0;
};

using Writer = std::variant<ExrFolderWriter, NpyWriter, VideoWriter>;

enum class Format { kExrFolder, kNpy, kVideo };

Format format_of(const fs::path& output) {
    const std::string extension = lower_extension(output);
    std::error_code error;
    if (extension.empty() || fs::is_directory(output, error)) return Format::kExrFolder;
    if (extension == ".npy") return Format::kNpy;
    if (extension == ".mp4" || extension == ".mkv") return Format::kVideo;
    throw InputError(output.string(),
                     fmt::format("videos cannot be written as \"{}\"; give .npy, .mp4, .mkv, or a "
                                 "folder (a name without extension, or with a / at its end)",
                                 extension));
}

/// \throws InputError.
OutputKind checked_kind(const fs::path& output, FrameShape shape,
                        const FrameWriterOptions& options) {
    static_cast<void>(checked_shape(static_cast<std::uint64_t>(shape.rows),
                                    static_cast<std::uint64_t>(shape.cols),
                                    static_cast<std::uint64_t>(shape.planes), output.string()));
    if (!(options.frames_per_second >= 0.01 && options.frames_per_second <= 10000))
        throw InputError(output.string(),
                         fmt::format("a playback rate of {} is outside 0.01..10000 frames per "
                                     "second",
                                     options.frames_per_second));
    return format_of(output) == Format::kExrFolder ? OutputKind::kFolder : OutputKind::kFile;
}

/// A live folder is put in place at once.
Writer open_writer(PendingOutput& output, Format format, FrameShape shape,
                   const FrameWriterOptions& options) {
    const std::string where = output.final_path().string();
    switch (format) {
        case Format::kExrFolder:
            if (options.live) output.commit();
            return ExrFolderWriter(options.live ? output.final_path() : output.partial(), where,
                                   shape, options.live);
        case Format::kNpy:
            return NpyWriter(output.partial(), where, shape);
        case Format::kVideo:
            break;
    }
    return VideoWriter(output.partial(), where, shape, options.frames_per_second);
}

}  // namespace

struct FrameWriter::Impl {
    std::size_t sites;
    PendingOutput output;
    Writer writer;
    bool finished = false;

    Impl(const fs::path& path, FrameShape shape, const FrameWriterOptions& options)
        : sites(shape.sites()),
          output(path, options.force, checked_kind(path, shape, options)),
          writer(open_writer(output, format_of(path), shape, options)) {}
};

FrameWriter::FrameWriter(const fs::path& output, FrameShape shape, FrameWriterOptions options)
    : impl_(std::make_unique<Impl>(output, shape, options)) {}

FrameWriter::~FrameWriter() = default;

void FrameWriter::write(std::span<const float> frame) {
    assert(frame.size() == impl_->sites && !impl_->finished);
    std::visit([&](auto& writer) { writer.write(frame); }, impl_->writer);
}

void FrameWriter::finish() {
    if (std::exchange(impl_->finished, true)) return;
    std::visit([](auto& writer) { writer.finish(); }, impl_->writer);
    if (!impl_->output.committed()) impl_->output.commit();
}

}  // namespace stipple
