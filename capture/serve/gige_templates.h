#pragma once

namespace stipple::gige {

/// The files *.xml.in of this folder, as format strings of fmt.
extern const char* const kCameraXml;
extern const char* const kRegionXml;
extern const char* const kFixedRegionXml;
extern const char* const kCodedHeaderXml;

}  // namespace stipple::gige
