#pragma once

#include <string>

#include "capture/serve/frame_source.h"

namespace stipple {

/// The GenICam description (GenApi 1.1 schema, SFNC names) of a camera that serves such images: it
/// names the registers of gige_registers.h.
[[nodiscard]] std::string gige_xml(const ServedImage& image);

/// Pixels by which width and horizontal offset change, so that rows stay whole bytes and whole
/// cells of a colour filter array in every format.
[[nodiscard]] int gige_width_step(const ServedImage& image);

}  // namespace stipple
