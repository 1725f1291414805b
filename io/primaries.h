#pragma once

#include <array>
#include <optional>
#include <span>

namespace stipple {

/// A colour by its CIE 1931 coordinates.
struct Chromaticity {
    double x = 0;
    double y = 0;
};

/// The colours of red, green, blue and of R = G = B; those of Rec. 709 (ITU-R BT.709-6).
struct Primaries {
    Chromaticity red{0.64, 0.33};
    Chromaticity green{0.30, 0.60};
    Chromaticity blue{0.15, 0.06};
    Chromaticity white{0.3127, 0.3290};
};

using ColourMatrix = std::array<std::array<double, 3>, 3>;

/// From linear RGB of these primaries to that of Rec. 709: the matrix of SMPTE RP 177, and that of
/// Bradford (ICC.1:2022, annex E) from their white to D65. If R, G and B are CIE X, Y and Z
/// themselves, their white is that of no light, and stays. Nothing if the primaries make no
/// colours.
[[nodiscard]] std::optional<ColourMatrix> to_rec709(const Primaries& primaries);

/// True if a matrix changes no number by more than 0.0001 of the largest.
[[nodiscard]] bool is_identity(const ColourMatrix& matrix);

/// Converts planes R, G, B. Colours outside of Rec. 709 are mixed with the grey of their luminance
/// until none of the three is negative, so that the luminance stays. Negative numbers are not light
/// and stay outside.
void convert(std::span<float> planes, const ColourMatrix& matrix);

}  // namespace stipple
