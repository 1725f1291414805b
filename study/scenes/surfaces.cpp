#include "study/scenes/surfaces.h"

namespace stipple {

float brick(Vec2 p, float width, float height) noexcept {
    const float course = p.y / height;
    const float along = p.x / width + 0.5F * static_cast<float>(floor_int(course) & 1);
    const bool joint = fraction(course) < 0.18F || fraction(along) < 0.09F;
    const int stone = (floor_int(course) * 7 + floor_int(along) * 13) & 0xFF;
    return joint ? 1.35F : 0.8F + 0.05F * static_cast<float>(stone * stone % 9);
}

Rgb wood(const SceneTextures& textures, Vec2 p) noexcept {
    const float bend = textures.smooth.at(0.5F * p.x, 0.22F * p.y);
    const float fibre = textures.coarse.at(1.3F * p.x, 0.11F * p.y);
    const float ring = std::abs(2 * fraction(9 * p.x + 0.9F * bend) - 1);
    const float tone = clamp01(0.45F + 0.3F * ring + 0.16F * fibre);
    return mix(Rgb{0.25F, 0.125F, 0.055F}, {0.62F, 0.40F, 0.20F}, tone);
}

Rgb planks(const SceneTextures& textures, Vec2 p, float width) noexcept {
    const float board = p.x / width;
    const auto index = static_cast<float>(floor_int(board) & 15);
    const float across = fraction(board);
    const float end = fraction(p.y / 1.1F + 0.37F * index);
    const float joint = across < 0.03F || end < 0.004F ? 0.25F : across < 0.06F ? 1.2F : 1.0F;
    const float tone = 0.8F + 0.4F * fraction(0.618F * index);
    return joint * tone * wood(textures, p + Vec2{0.173F * index, 0.31F * index});
}

}  // namespace stipple
