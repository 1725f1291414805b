#include <algorithm>

#include "study/scenes/embedded_scenes.h"
#include "study/scenes/surfaces.h"

namespace stipple {

namespace {

constexpr float kBoreRadius = 0.113F;

}  // namespace

Rgb PencilsScene::pencil_light(const Pencil& pencil, const Posed& posed,
                               Vec2 local) const noexcept {
    const float across = local.y / pencil.half_width;
    const float grain = textures_->coarse.at(2 * local.x, 2 * local.y + pencil.start.x);
    if (pencil.plain) {  // a round, lacquered stick
        const float round = 1 - square(across + 0.35F);
        return (0.35F + 0.65F * clamp01(round)) * (1 + 0.08F * grain) * pencil.colour +
               0.9F * power16(clamp01(1 - square(across + 0.3F))) * Rgb{1, 0.97F, 0.9F};
    }
    const float from_tip = (pencil.half_length - local.x) / pencil.half_width;
    const float from_end = (pencil.half_length + local.x) / pencil.half_width;
    const float round = 0.35F + 0.75F * clamp01(1 - square(across + 0.4F));
    if (from_end < 2.4F) return round * (1 + 0.15F * grain) * Rgb{0.75F, 0.30F, 0.27F};  // rubber
    if (from_end < 5) {  // ferrule: ribbed metal with a hard highlight
        const float rib = fraction(from_end * 1.55F) < 0.35F ? 0.55F : 1.0F;
        const float glint = power16(clamp01(1 - square(1.2F * across + 0.42F)));
        return rib * ((0.12F + 0.4F * round) * Rgb{0.80F, 0.74F, 0.56F} +
                      3.2F * glint * Rgb{1, 0.95F, 0.82F});
    }
    const std::size_t facet = across < posed.edge[0]   ? 0
                              : across < posed.edge[1] ? 1
                              : across < posed.edge[2] ? 2
                                                       : 3;
    const float scallop = 4.7F - 0.5F * square(2 * fraction(1.5F * across) - 1);
    if (from_tip < 1.2F) return 0.6F * round * pencil.colour;  // lead
    if (from_tip < scallop) {                                  // sharpened wood
        return round * (1 + 0.16F * grain) * Rgb{0.74F, 0.50F, 0.28F};
    }
    Rgb lacquer = (1 + 0.05F * grain) * pencil.colour;
    // Gold lettering: fine strokes on the middle facets near the end.
    const float letter = fraction(from_end * 0.9F);
    const bool stroke = from_end > 6 && from_end < 13 && letter < 0.62F &&
                        std::abs(across - 0.08F) < 0.26F &&
                        (letter < 0.2F || std::abs(across - 0.08F) > 0.14F);
    if (stroke) lacquer = {0.80F, 0.62F, 0.25F};
    return (0.22F + 0.85F * posed.light[facet]) * lacquer +
           0.8F * posed.highlight[facet] * Rgb{1, 0.97F, 0.92F};
}

Rgb PencilsScene::cup(Vec2 from_centre) const noexcept {
    const float radius = std::sqrt(dot(from_centre, from_centre));
    const Vec2 unit = 1 / kCupRadius * from_centre;
    const float towards_sun =
        radius > 0 ? (-0.65F * unit.x - 0.76F * unit.y) * kCupRadius / radius : 0;
    const float rim = (radius - kBoreRadius) / (kCupRadius - kBoreRadius);
    if (rim > 0) {  // polished rim: two highlights across from each other
        const float shine = power64(std::abs(towards_sun)) * clamp01(4 * rim * (1 - rim));
        const float grain = textures_->coarse.at(from_centre.x * 2, from_centre.y * 2);
        return (0.16F + 0.30F * clamp01(towards_sun + 0.4F)) * (1 + 0.06F * grain) *
                   Rgb{0.80F, 0.84F, 0.90F} +
               (towards_sun > 0 ? 12.0F : 3.0F) * shine * square(shine) * Rgb{1, 0.96F, 0.88F};
    }
    // The inside: only its wall across from the sun is lit, the bottom is the deepest shadow.
    const float wall = clamp01(1 + rim * (kCupRadius - kBoreRadius) / 0.026F);
    const float lit = square(wall) * clamp01(-towards_sun + 0.15F);
    const float grain = textures_->coarse.at(3 * from_centre.x, 3 * from_centre.y);
    return (2.2e-4F * (1 + 0.3F * grain) + 0.20F * lit) * Rgb{1, 0.98F, 0.95F};
}

Rgb PencilsScene::desk(Vec2 point) const noexcept {
    const float grain = textures_->coarse.at(point.x, point.y);
    // A sheet of squared paper, lying askew.
    const Vec2 sheet{0.966F * (point.x - 0.20F) + 0.259F * (point.y - 0.02F),
                     0.966F * (point.y - 0.02F) - 0.259F * (point.x - 0.20F)};
    if (std::abs(sheet.x) < 0.27F && std::abs(sheet.y) < 0.36F) {
        const bool line = fraction(sheet.x / 0.03F) < 0.09F || fraction(sheet.y / 0.03F) < 0.09F;
        const bool margin = std::abs(sheet.x + 0.20F) < 0.0018F;
        const Rgb ink = margin ? Rgb{0.75F, 0.25F, 0.22F} : Rgb{0.50F, 0.62F, 0.74F};
        return (1 + 0.025F * grain) * (line || margin ? ink : Rgb{0.80F, 0.79F, 0.74F});
    }
    const Vec2 edge{std::abs(sheet.x - 0.006F) - 0.27F, std::abs(sheet.y - 0.008F) - 0.36F};
    const float under = smooth_step(-0.01F, 0.012F, std::max(edge.x, edge.y));
    return mix(0.5F, 1.0F, under) * 0.85F * planks(*textures_, {point.y + 4, point.x}, 0.30F);
}

}  // namespace stipple
