#pragma once

#include "core/hdr_curves.h"

namespace stipple {

/// How light becomes the numbers of a video.
enum class VideoCurve {
    kSdr,  ///< tone-mapped to 8 bits (io/tone_map.h)
    kPq,   ///< luminance, 10 bits: SMPTE ST 2084
    kHlg,  ///< light relative to a peak, 10 bits: ARIB STD-B67
};

/// Of 10 bits; 8 bits are H.264.
enum class HdrCodec { kHevc, kAv1 };

struct VideoCoding {
    VideoCurve curve = VideoCurve::kSdr;
    bool uncompressed = false;  ///< .y4m; by the name of the output
    HdrCodec codec = HdrCodec::kHevc;
    double frames_hz = 30;                   ///< of playback
    double cd_per_unit = kReferenceWhiteCd;  ///< luminance of light 1.0, in cd/m2
    double peak_cd = 1000;                   ///< PQ: brighter light is clipped to it
};

/// Light of a video in PQ, as CTA-861.3 defines it, in cd/m2.
struct LightLevels {
    double max_cll = 0;           ///< of the brightest pixel: the largest of its R, G and B
    double max_fall = 0;          ///< of the brightest frame: the mean of these
    double clipped_fraction = 0;  ///< of the values, above the peak
};

}  // namespace stipple
