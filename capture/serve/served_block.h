#pragma once

#include <cstdint>

#include "capture/serve/frame_source.h"
#include "capture/serve/gige_device.h"
#include "capture/serve/gvsp_codec.h"

namespace stipple {

/// A frame ready for sending: its region, followed by the enabled chunks. The caller sets the id.
/// Precondition: frame.payload is a whole image in settings.format.
[[nodiscard]] GvspBlock served_block(ServedFrame frame, const ServedImage& image,
                                     const GigeStreamSettings& settings,
                                     std::uint64_t timestamp_ns);

}  // namespace stipple
