#include <fmt/format.h>
#include <sys/resource.h>

#include <cstdio>
#include <ctime>
#include <memory>
#include <optional>
#include <stdexcept>

#include "core/config.h"
#include "core/parallel.h"
#include "core/text.h"
#include "decoder/decode_options.h"
#include "decoder/measurements.h"
#include "decoder/reconstruct.h"
#include "io/footage_reader.h"
#include "io/npy_file.h"
#include "session/decode_setup.h"
#include "study/metrics/video_quality.h"
#include "tests/bench/decoder/decode_table.h"

namespace stipple {
namespace {

struct PipeCloser {
    void operator()(std::FILE* pipe) const { pclose(pipe); }
};

/// Without the first and last slots, where less is known.
VideoQuality quality_of(const std::filesystem::path& decoded, const RecordedClip& clip) {
    FootageReader video(decoded);
    FootageReader reference(clip.truth);
    std::vector<float> frame(video.shape().sites());
    std::vector<float> reference_frame(reference.shape().sites());
    QualityMeter meter(reference.shape(), {.margin = usual_margin(reference.slots().value()),
                                           .max_value = clip.brightest});
    while (video.read(frame) && reference.read(reference_frame)) meter.add(frame, reference_frame);
    return meter.quality();
}

}  // namespace

void decode_and_print(const RecordedClip& clip, const MethodRun& run) {
    std::optional<ThreadLimit> limit;
    if (run.one_thread) limit.emplace(1);
    StreamReader reader(clip.stream, ReadPolicy::kStrict);
    Config config(run.settings);
    const auto output = clip.stream.parent_path() / "decoded.npy";
    NpyWriter video(output, output.string(), decoded_shape(reader.header()));
    const std::clock_t begin = std::clock();
    DecodeOptions options = read_decode_options(decode_method_from_name(run.method), config);
    read_option_file(options);
    const DecodeReport report =
        decode(reader, options, [&](std::int64_t, std::span<const float> frame) {
            video.write(frame);
            return true;
        });
    const double seconds = run.one_thread
                               ? static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC
                               : report.seconds;
    video.finish();
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const VideoQuality quality = quality_of(output, clip);
    fmt::print("figures {} {} {} {} {} {}\n", seconds, static_cast<double>(report.voxels) / seconds,
               quality.psnr_db, quality.psnr_gamma_db, quality.pu21_psnr_db,
               usage.ru_maxrss * 1024);
}

MethodFigures measure_apart(const RecordedClip& clip, const MethodRun& run) {
    const auto program = std::filesystem::read_symlink("/proc/self/exe");
    std::string command =
        fmt::format("{} --child {} {} {} {} {:d}", shell_quoted(program.string()),
                    shell_quoted(clip.stream.string()), shell_quoted(clip.truth.string()),
                    clip.brightest, shell_quoted(run.method), run.one_thread);
    for (const std::string& setting : run.settings)
        command += fmt::format(" {}", shell_quoted(setting));
    const std::unique_ptr<std::FILE, PipeCloser> pipe(popen(command.c_str(), "r"));
    MethodFigures f;
    long long peak = 0;
    if (!pipe || std::fscanf(pipe.get(), "figures %lf %lf %lf %lf %lf %lld", &f.seconds,
                             &f.voxels_per_second, &f.psnr_db, &f.psnr_gamma_db, &f.pu21_psnr_db,
                             &peak) != 6)
        throw std::runtime_error(fmt::format("method {} has failed", run.method));
    f.peak_bytes = peak;
    return f;
}

}  // namespace stipple
