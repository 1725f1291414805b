#pragma once

#include <string>

#include "capture/serve/frame_source.h"

namespace stipple {

/// The GenICam description (GenApi 1.1 schema, SFNC names) of a camera that serves `image`, with
/// the registers of gige_registers.h.
[[nodiscard]] std::string gige_xml(const ServedImage& image);

/// Increment of width and horizontal offset in pixels, so that rows are whole bytes and whole cells
/// of a colour filter array in every format.
[[nodiscard]] int gige_width_step(const ServedImage& image);

}  // namespace stipple

namespace stipple::gige {

/// The files *.xml.in of this folder, as format strings of fmt.
extern const char* const kCameraXml;
extern const char* const kRegionXml;
extern const char* const kFixedRegionXml;
extern const char* const kCodedHeaderXml;

}  // namespace stipple::gige
