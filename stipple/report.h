#pragma once

/// A run as an HTML page that needs no other file (docs/report.md):
///
///     stipple::FootageReader decoded("decoded.npy");
///     stipple::RunReport report({.title = "A clip"}, decoded.shape(), nullptr);
///     const std::size_t run = report.add_run("clip.stipple", "lux1310");
///     const std::size_t video = report.add_video({.name = "fast", .run = run});
///     std::vector<float> light(decoded.shape().sites());
///     for (std::int64_t slot = 0; decoded.read(light); ++slot) report.put(video, slot, light);
///     std::ofstream("report.html") << report.page();
#include "stipple/video.h"
#include "study/report/run_report.h"
