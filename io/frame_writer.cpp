#include "io/frame_writer.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cassert>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/light.h"
#include "io/exr_file.h"
#include "io/footage_files.h"
#include "io/npy_file.h"
#include "io/output_names.h"
#include "io/pending_output.h"
#include "io/png_file.h"
#include "io/tiff_writer.h"
#include "io/video_writer.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

/// Writes a folder of frame_%04d.exr, light_%04d.png or light_%04d.tif.
class FolderWriter {
  public:
    FolderWriter(fs::path folder, std::string where, FrameShape shape,
                 const FrameWriterOptions& options)
        : folder_(std::move(folder)),
          where_(std::move(where)),
          shape_(shape),
          coding_(options.images),
          live_(options.live) {}

    void write(std::span<const float> frame) {
        const std::string name = name_of_next();
        const std::string where = (fs::path(where_) / name).string();
        if (!live_) return write_image(folder_ / name, where, frame);
        PendingOutput whole(folder_ / name, false);
        write_image(whole.partial(), where, frame);
        whole.commit();
    }
    void finish() {}

  private:
    [[nodiscard]] std::string name_of_next() {
        const int slot = next_slot_++;
        if (coding_.format == ImageFormat::kPng) return fmt::format("light_{:04}.png", slot);
        if (coding_.format == ImageFormat::kTiff) return fmt::format("light_{:04}.tif", slot);
        return fmt::format("frame_{:04}.exr", slot);
    }
    void write_image(const fs::path& file, const std::string& where, std::span<const float> frame);

    fs::path folder_;
    std::string where_;
    FrameShape shape_;
    ImageCoding coding_;
    bool live_;
    int next_slot_ = 0;
};

void FolderWriter::write_image(const fs::path& file, const std::string& where,
                               std::span<const float> frame) {
    if (coding_.format == ImageFormat::kPng) {
        std::vector<std::byte> words;
        interleave(frame, shape_, coding_, words);
        PngPixels pixels{shape_.rows, shape_.cols, shape_.planes, 2, {}};
        pixels.bytes.resize(words.size());
        std::memcpy(pixels.bytes.data(), words.data(), words.size());
        return write_png_file(file, pixels, where);
    }
    if (coding_.format == ImageFormat::kExr)
        return write_exr(
            file, where, shape_, frame,
            coding_.samples == SampleKind::kHalf ? ExrSample::kHalf : ExrSample::kFloat);
    TiffWriter tiff(file, where, shape_, coding_, TiffWriter::Kind::kImage);
    tiff.write(frame);
    tiff.finish();
}

using Writer = std::variant<FolderWriter, NpyWriter, VideoWriter, TiffWriter>;

enum class Format { kFolder, kNpy, kVideo, kY4m, kTiffStack };

Format format_of(const fs::path& output) {
    const std::string extension = lower_extension(output);
    std::error_code error;
    if (is_pipe(output) && extension.empty()) return Format::kY4m;
    if (extension == ".y4m") return Format::kY4m;
    if (is_pipe(output))
        throw InputError(output.string(), "is a pipe, which takes .y4m only; rename it");
    if (extension.empty() || fs::is_directory(output, error)) return Format::kFolder;
    if (extension == ".npy") return Format::kNpy;
    if (extension == ".mp4" || extension == ".mkv") return Format::kVideo;
    if (extension == ".tif" || extension == ".tiff") return Format::kTiffStack;
    throw InputError(
        output.string(),
        fmt::format("videos cannot be written as \"{}\"; give .npy, .mp4, .mkv, .y4m, .tif, or "
                    "a folder (a name without extension, or with a / at its end)",
                    extension));
}

/// \throws InputError.
OutputKind checked_kind(const fs::path& output, FrameShape shape,
                        const FrameWriterOptions& options) {
    static_cast<void>(checked_shape(static_cast<std::uint64_t>(shape.rows),
                                    static_cast<std::uint64_t>(shape.cols),
                                    static_cast<std::uint64_t>(shape.planes), output.string()));
    const VideoCoding& video = options.video;
    if (!(video.frames_hz >= 0.01 && video.frames_hz <= 10000))
        throw InputError(output.string(),
                         fmt::format("a playback rate of {} is outside 0.01..10000 frames per "
                                     "second",
                                     video.frames_hz));
    const Format format = format_of(output);
    if (video.curve != VideoCurve::kSdr && format != Format::kVideo)
        throw InputError(output.string(), "holds no HDR video; PQ and HLG need .mp4 or .mkv");
    return format == Format::kFolder ? OutputKind::kFolder : OutputKind::kFile;
}

/// With the samples that the format has if none are wanted. \throws InputError if it lacks them.
FrameWriterOptions checked_samples(const fs::path& output, FrameWriterOptions options) {
    ImageCoding& images = options.images;
    const Format format = format_of(output);
    options.video.uncompressed = format == Format::kY4m;
    if (format == Format::kNpy || format == Format::kVideo || format == Format::kY4m)
        return options;
    if (format == Format::kTiffStack) images.format = ImageFormat::kTiff;
    const bool png = images.format == ImageFormat::kPng;
    const SampleKind samples =
        images.samples.value_or(png ? SampleKind::kWord : SampleKind::kFloat);
    const SampleKind other =
        images.format == ImageFormat::kExr ? SampleKind::kHalf : SampleKind::kWord;
    if (samples != other && (png || samples != SampleKind::kFloat))
        throw InputError(output.string(), png ? "PNG has integers of 16 bits only (u16)"
                                          : images.format == ImageFormat::kExr
                                              ? "EXR has floats only (f32, f16)"
                                              : "TIFF is written as f32 or u16");
    images.samples = samples;
    return options;
}

/// For messages. \throws InputError if it is a terminal.
std::string pipe_name(const fs::path& pipe) {
    if (pipe != "-") return pipe.string();
    if (isatty(STDOUT_FILENO) != 0)
        throw InputError("standard output",
                         "is a terminal; send the video to a program or a file, as by "
                         "-o - | ffmpeg -i - OUT.mov");
    return "standard output";
}

/// A live folder is put in place at once.
Writer open_writer(PendingOutput& output, Format format, FrameShape shape,
                   const FrameWriterOptions& options) {
    const std::string where = output.final_path().string();
    switch (format) {
        case Format::kFolder:
            if (options.live) output.commit();
            return FolderWriter(options.live ? output.final_path() : output.partial(), where, shape,
                                options);
        case Format::kNpy:
            return NpyWriter(output.partial(), where, shape);
        case Format::kTiffStack:
            return TiffWriter(output.partial(), where, shape, options.images);
        case Format::kVideo:
        case Format::kY4m:
            break;
    }
    return VideoWriter(output.partial(), where, shape, options.video);
}

}  // namespace

struct FrameWriter::Impl {
    std::size_t sites;
    std::optional<PendingOutput> output;  ///< none: a pipe
    Writer writer;
    bool finished = false;

    Impl(const fs::path& path, FrameShape shape, const FrameWriterOptions& options)
        : sites(shape.sites()), writer(open(path, shape, options)) {}

  private:
    Writer open(const fs::path& path, FrameShape shape, const FrameWriterOptions& wanted) {
        const OutputKind kind = checked_kind(path, shape, wanted);
        const FrameWriterOptions options = checked_samples(path, wanted);
        if (is_pipe(path)) return VideoWriter(path, pipe_name(path), shape, options.video);
        output.emplace(path, options.force, kind);
        return open_writer(*output, format_of(path), shape, options);
    }
};

FrameWriter::FrameWriter(const fs::path& output, FrameShape shape, FrameWriterOptions options)
    : impl_(std::make_unique<Impl>(output, shape, options)) {}

FrameWriter::~FrameWriter() = default;

void FrameWriter::write(std::span<const float> frame) {
    assert(frame.size() == impl_->sites && !impl_->finished);
    std::visit([&](auto& writer) { writer.write(frame); }, impl_->writer);
}

std::optional<LightLevels> FrameWriter::light_levels() const {
    const auto* const video = std::get_if<VideoWriter>(&impl_->writer);
    return video == nullptr ? std::nullopt : video->light_levels();
}

void FrameWriter::finish() {
    if (std::exchange(impl_->finished, true)) return;
    std::visit([](auto& writer) { writer.finish(); }, impl_->writer);
    if (impl_->output && !impl_->output->committed()) impl_->output->commit();
}

}  // namespace stipple
