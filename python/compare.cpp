#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/text.h"
#include "python/bindings.h"
#include "python/call_progress.h"
#include "python/footage.h"
#include "study/metrics/video_quality.h"

namespace stipple::python {
namespace {

struct Comparison {
    QualityOptions options;
    std::optional<std::int64_t> until;  ///< frames of each; none: as many as both have
};

/// Of two videos, and of each of their frames.
struct ComparedVideos : VideoQuality {
    std::vector<VideoQuality> frames;  ///< between the margins
};

/// Adds up the frames that both have. Without the GIL. Returns a warning if one has more, else an
/// empty text. \throws InputError if one ends before `until`.
std::string compare_frames(Footage& result, Footage& reference, const Comparison& comparison,
                           QualityMeter& meter, CallProgress& progress) {
    for (std::int64_t frame = 0; !comparison.until || frame < *comparison.until; ++frame) {
        const auto a = result.next();
        const auto b = reference.next();
        if (a.empty() || b.empty()) {
            const std::string ends = fmt::format("ends after {} frames, before ", frame);
            const std::string name = (a.empty() ? result : reference).name();
            if (comparison.until)
                throw InputError(name, ends + fmt::format("until={}", *comparison.until));
            if (a.empty() && b.empty()) return {};
            return fmt::format("{}: {}the other does; these are compared", name, ends);
        }
        meter.add(a, b);
        if (!progress.reach(static_cast<double>(frame + 1))) return {};
    }
    return {};
}

ComparedVideos compare(Footage& result, Footage& reference, const Comparison& comparison,
                       const py::object& tell) {
    if (result.shape() != reference.shape())
        throw InputError(result.name(), shape_difference(result.shape(), reference.shape(),
                                                         "but the reference has"));
    QualityMeter meter(reference.shape(), comparison.options);
    CallProgress progress(tell, comparison.until ? comparison.until : reference.slots());
    std::string overlap;
    {
        const py::gil_scoped_release released;
        overlap = compare_frames(result, reference, comparison, meter, progress);
    }
    progress.finish();
    result.pass_warnings_on();
    reference.pass_warnings_on();
    ComparedVideos compared{meter.quality(), meter.frame_qualities()};
    warn(overlap);
    return compared;
}

}  // namespace

void bind_compare(py::module_& module) {
    py::class_<VideoQuality>(
        module, "VideoQuality",
        "Quality of a video against its reference. Equal videos have an infinite PSNR.")
        .def_readonly("psnr_db", &VideoQuality::psnr_db, "Linear light, pooled over all, in dB.")
        .def_readonly("psnr_gamma_db", &VideoQuality::psnr_gamma_db,
                      "Clamped to 0..1 and raised to 1/2.2, in dB.")
        .def_readonly("psnr_frame_mean_db", &VideoQuality::psnr_frame_mean_db,
                      "Linear light, mean of the frames' values, in dB.")
        .def_readonly("pu21_psnr_db", &VideoQuality::pu21_psnr_db, "Of PU21 values, in dB.")
        .def_readonly("ssim", &VideoQuality::ssim, "Clamped to 0..1 and raised to 1/2.2, up to 1.")
        .def_readonly("pu21_ssim", &VideoQuality::pu21_ssim,
                      "SSIM of PU21 values of luminance; None unless asked for.")
        .def_readonly("pu21_csf_psnr_db", &VideoQuality::pu21_csf_psnr_db,
                      "Of PU21 values of luminance, the error weighted by the contrast sensitivity "
                      "of the eye, in dB; None without pixels_per_degree.")
        .def("__repr__", [](const VideoQuality& self) {
            return fmt::format(
                "<stipple.VideoQuality psnr_db={:.2f} psnr_gamma_db={:.2f} "
                "psnr_frame_mean_db={:.2f} pu21_psnr_db={:.2f} ssim={:.4f}>",
                self.psnr_db, self.psnr_gamma_db, self.psnr_frame_mean_db, self.pu21_psnr_db,
                self.ssim);
        });
    py::class_<ComparedVideos, VideoQuality>(module, "ComparedVideos",
                                             "Quality of a video, and of each of its frames.")
        .def_readonly("frames", &ComparedVideos::frames,
                      "A VideoQuality for each frame between the margins.");
    py::class_<Comparison>(module, "Comparison")
        .def(py::init([](int margin, std::optional<double> max_value, double peak,
                         double cd_per_unit, std::optional<std::int64_t> until, bool pu21_ssim,
                         std::optional<double> pixels_per_degree) {
            if (until && *until < 1)
                throw InputError("until", fmt::format("{} is not above 0", *until));
            if (!(cd_per_unit > 0 && std::isfinite(cd_per_unit)))
                throw InputError("cd_per_unit",
                                 fmt::format("{} is not finite and above 0", cd_per_unit));
            return Comparison{.options = {.margin = margin,
                                          .max_value = max_value,
                                          .peak = peak,
                                          .unit_cd_per_m2 = cd_per_unit,
                                          .pu21_ssim = pu21_ssim,
                                          .pixels_per_degree = pixels_per_degree},
                              .until = until};
        }));
    module.def("compare", &compare);
}

}  // namespace stipple::python
