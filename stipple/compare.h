#pragma once

/// Quality of a video against its reference: PSNR, SSIM, PU21 (docs/outputs.md):
///
///     stipple::FootageReader result("decoded.npy"), reference("scene.npy");
///     stipple::QualityMeter meter(result.shape(), {.margin = 4});
///     std::vector<float> a(result.shape().sites()), b(a.size());
///     while (result.read(a) && reference.read(b)) meter.add(a, b);
///     std::cout << meter.quality().psnr_db << " dB\n";
///
/// emva1288::evaluate measures a camera from its images by EMVA 1288 (docs/characterize.md).
#include "stipple/video.h"
#include "study/metrics/emva1288/camera_figures.h"
#include "study/metrics/emva1288/series_evaluation.h"
#include "study/metrics/video_quality.h"
