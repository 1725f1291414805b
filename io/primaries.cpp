#include "io/primaries.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace stipple {
namespace {

using Vector = std::array<double, 3>;

constexpr ColourMatrix kBradford{
    {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};

Vector product(const ColourMatrix& a, const Vector& v) {
    Vector result{};
    for (std::size_t row = 0; row < 3; ++row)
        result[row] = a[row][0] * v[0] + a[row][1] * v[1] + a[row][2] * v[2];
    return result;
}

ColourMatrix product(const ColourMatrix& a, const ColourMatrix& b) {
    ColourMatrix result{};
    for (std::size_t col = 0; col < 3; ++col) {
        const Vector column = product(a, Vector{b[0][col], b[1][col], b[2][col]});
        for (std::size_t row = 0; row < 3; ++row) result[row][col] = column[row];
    }
    return result;
}

ColourMatrix diagonal(const Vector& v) {
    return {{{v[0], 0, 0}, {0, v[1], 0}, {0, 0, v[2]}}};
}

/// Nothing if the matrix has none.
std::optional<ColourMatrix> inverse(const ColourMatrix& m) {
    constexpr double kSmallest = 1e-6;
    ColourMatrix adjugate{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t col = 0; col < 3; ++col) {
            const auto at = [&](std::size_t r, std::size_t c) {
                return m[(col + r) % 3][(row + c) % 3];
            };
            adjugate[row][col] = at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1);
        }
    const double determinant =
        product(m, Vector{adjugate[0][0], adjugate[1][0], adjugate[2][0]})[0];
    if (!(std::abs(determinant) > kSmallest) || !std::isfinite(determinant)) return {};
    return product(diagonal({1 / determinant, 1 / determinant, 1 / determinant}), adjugate);
}

Vector direction(const Chromaticity& colour) {
    return {colour.x, colour.y, 1 - colour.x - colour.y};
}

/// CIE XYZ of a colour of luminance 1.
Vector xyz_of(const Chromaticity& colour) {
    const Vector v = direction(colour);
    return {v[0] / colour.y, 1, v[2] / colour.y};
}

std::optional<ColourMatrix> to_xyz(const Primaries& primaries) {
    const Vector red = direction(primaries.red);
    const Vector green = direction(primaries.green);
    const Vector blue = direction(primaries.blue);
    const ColourMatrix columns{
        {{red[0], green[0], blue[0]}, {red[1], green[1], blue[1]}, {red[2], green[2], blue[2]}}};
    const auto shares = inverse(columns);
    constexpr double kDarkestWhite = 1e-3;
    if (!shares || !(primaries.white.y > kDarkestWhite)) return {};
    return product(columns, diagonal(product(*shares, xyz_of(primaries.white))));
}

/// \pre the cones respond to both whites
ColourMatrix adaptation(const Chromaticity& from, const Chromaticity& to) {
    const Vector seen = product(kBradford, xyz_of(from));
    const Vector wanted = product(kBradford, xyz_of(to));
    return product(
        *inverse(kBradford),
        product(diagonal({wanted[0] / seen[0], wanted[1] / seen[1], wanted[2] / seen[2]}),
                kBradford));
}

bool close(const Chromaticity& a, const Chromaticity& b) {
    constexpr double kRounding = 1e-4;
    return std::abs(a.x - b.x) < kRounding && std::abs(a.y - b.y) < kRounding;
}

}  // namespace

std::optional<ColourMatrix> to_rec709(const Primaries& primaries) {
    const Primaries rec709;
    const auto xyz = to_xyz(primaries);
    if (!xyz) return {};
    ColourMatrix matrix = product(*inverse(*to_xyz(rec709)), *xyz);
    const bool are_xyz =
        close(primaries.red, {1, 0}) && close(primaries.green, {0, 1}) && close(primaries.blue, {});
    if (!are_xyz && !close(primaries.white, rec709.white))
        matrix = product(*inverse(*to_xyz(rec709)),
                         product(adaptation(primaries.white, rec709.white), *xyz));
    const bool finite = std::ranges::all_of(matrix, [](const Vector& row) {
        return std::ranges::all_of(row, [](double value) { return std::isfinite(value); });
    });
    return finite ? std::optional(matrix) : std::nullopt;
}

bool is_identity(const ColourMatrix& matrix) {
    constexpr double kRounding = 1e-4;
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t col = 0; col < 3; ++col)
            if (!(std::abs(matrix[row][col] - (row == col ? 1 : 0)) < kRounding)) return false;
    return true;
}

void convert(std::span<float> planes, const ColourMatrix& matrix) {
    const std::size_t pixels = planes.size() / 3;
    assert(planes.size() == 3 * pixels);
    const Vector luminance{0.2126, 0.7152, 0.0722};
    for (std::size_t i = 0; i < pixels; ++i) {
        Vector source;
        for (std::size_t plane = 0; plane < 3; ++plane)
            source[plane] = static_cast<double>(planes[plane * pixels + i]);
        Vector light = product(matrix, source);
        const double grey =
            luminance[0] * light[0] + luminance[1] * light[1] + luminance[2] * light[2];
        const double least = std::ranges::min(light);
        if (least < 0 && grey > 0 && std::ranges::min(source) >= 0)
            for (double& value : light)
                value = std::max(0.0, grey + (value - grey) * grey / (grey - least));
        for (std::size_t plane = 0; plane < 3; ++plane)
            planes[plane * pixels + i] = static_cast<float>(light[plane]);
    }
}

}  // namespace stipple
