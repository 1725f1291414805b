#include <algorithm>

#include "study/scenes/embedded_scenes.h"

namespace stipple {

namespace {

constexpr float kLampPitch = 0.5F;
constexpr float kLampOffset = 0.22F;
constexpr float kLanternHeight = 0.37F;
constexpr Rgb kIron{0.030F, 0.032F, 0.036F};

/// Distance along the street to the nearest of things that stand `pitch` apart.
float nearest(float x, float pitch, float offset) {
    return pitch * (fraction((x - offset) / pitch + 0.5F) - 0.5F);
}

}  // namespace

std::optional<Rgb> PanScene::railing(Vec2 world) const noexcept {
    constexpr float kTop = 0.075F;
    if (world.y > 0.11F) return {};
    const float pillar = std::abs(nearest(world.x, 0.8F, 0.1F));
    if (pillar < 0.027F || (pillar < 0.033F && world.y > 0.095F)) {
        const float grain = textures_->coarse.at(world.x * 1.5F, world.y * 1.5F);
        const float lit = mix(1.25F, 0.35F, clamp01((pillar + 0.027F) / 0.054F));
        return (lit * (1 + 0.25F * grain)) * Rgb{0.26F, 0.23F, 0.22F};
    }
    const float bar = nearest(world.x, 0.0235294F, 0);  // 340 bars in a period
    const float width = world.y < kTop ? 0.0022F
                        : world.y < kTop + 0.018F
                            ? 0.005F * std::min(1.0F, (kTop + 0.018F - world.y) / 0.011F)
                            : 0.0F;
    const bool rail = std::abs(world.y - 0.064F) < 0.0032F || std::abs(world.y - 0.012F) < 0.003F;
    if (std::abs(bar) > width && !rail) return {};
    const bool edge = rail ? std::abs(world.y - 0.065F) < 0.0016F : bar < -0.3F * width;
    return edge ? Rgb{0.20F, 0.15F, 0.13F} : kIron;
}

std::optional<Rgb> PanScene::lamp(Vec2 world) const noexcept {
    const float x = nearest(world.x, kLampPitch, kLampOffset);
    if (std::abs(x) > 0.05F || world.y > kLanternHeight + 0.06F) return {};
    const float up = world.y - kLanternHeight;
    const float glass = 0.017F + 0.22F * up;  // a lantern wider at its top
    if (up > -0.022F && up < 0.028F && std::abs(x) < glass) {
        const Vec2 bulb{x, up + 0.002F};
        if (dot(bulb, bulb) < square(0.0085F)) return Rgb{12, 8.5F, 5};
        const bool frame = std::abs(x) > glass - 0.0025F || std::abs(x) < 0.001F || up < -0.019F;
        if (frame) return Rgb{0.10F, 0.07F, 0.05F};
        return 1 / (1 + dot(bulb, bulb) / square(0.016F)) * Rgb{2.6F, 1.75F, 0.85F};
    }
    const bool hood = up >= 0.028F && up < 0.05F && std::abs(x) < 0.028F - (up - 0.028F) * 1.1F;
    const bool arm = std::abs(up + 0.045F) < 0.002F && std::abs(x) < 0.02F;
    const float thick = world.y < 0.05F ? 0.011F : world.y < 0.06F ? 0.013F : 0.0042F;
    const bool pole = up <= -0.022F && std::abs(x) < thick && world.y >= 0;
    if (!hood && !arm && !pole) return {};
    const float glint = pole && x < -0.35F * thick ? 4.0F : 1.0F;
    const float glow = 1 + 3 / (1 + square(up / 0.05F));
    return glint * glow * kIron;
}

std::optional<Rgb> PanScene::tree(Vec2 world) const noexcept {
    const float cell = static_cast<float>(floor_int(world.x)) + 0.5F;
    const auto item = static_cast<std::uint32_t>(floor_int(world.x) & 7);
    const float lean = 0.05F * static_cast<float>(item * 5 % 8) - 0.18F;  // spread along the street
    const Vec2 p{world.x - cell - lean, world.y};
    if (std::abs(p.x) > 0.2F || p.y < 0) return {};
    const Vec2 crown{p.x, (p.y - 0.33F) / 1.05F};
    const float outline = 0.118F + 0.013F * textures_->coarse.at(world.x, world.y) +
                          0.012F * textures_->smooth.at(1.5F * world.x, 1.5F * world.y);
    const float radius2 = dot(crown, crown);
    const float leaf = textures_->coarse.at(2 * world.x, 2 * world.y + 0.37F);
    if (radius2 < square(outline) && leaf > -1.7F) {
        const float side = 0.55F - 2.6F * crown.x + 2.6F * crown.y;
        const float light = std::max(0.06F, side) * (1 + 0.42F * leaf);
        return std::max(0.02F, light) * Rgb{0.26F, 0.24F, 0.075F};
    }
    const float trunk = 0.011F + 0.004F * square(clamp01(1 - p.y / 0.05F));
    if (std::abs(p.x) > trunk || p.y > 0.32F) return {};
    const float bark = textures_->coarse.at(3 * world.x, 0.6F * world.y);
    return (mix(1.3F, 0.3F, clamp01((p.x + trunk) / (2 * trunk))) * (1 + 0.3F * bark)) *
           Rgb{0.15F, 0.11F, 0.085F};
}

Rgb PanScene::ground(Vec2 world, float scale) const noexcept {
    const float depth = 1 / scale;  // 1 at the houses, 0.42 at the railing
    // Light of the lanterns: a pool around the foot of each.
    const Vec2 away{nearest(world.x, kLampPitch, kLampOffset), 1.6F * (depth - 1 / kLampScale)};
    const float pool = 1 / square(1 + dot(away, away) / square(0.11F));
    const Rgb light = Rgb{0.50F, 0.46F, 0.52F} + pool * Rgb{1.9F, 1.2F, 0.6F};
    const Vec2 p{world.x, 1.25F * depth};
    const float grain = textures_->coarse.at(p.x, p.y);
    if (depth > 0.93F || depth < 0.50F) {  // pavement of large slabs
        const bool joint = fraction(p.x / 0.125F) < 0.025F || std::abs(depth - 0.93F) < 0.006F;
        return (joint ? 0.5F : 1.0F) * (1 + 0.13F * grain) * (Rgb{0.42F, 0.39F, 0.36F} * light);
    }
    // Cobbles: rows of rounded stones, each with its own shade.
    const float row = p.y / 0.0225F;
    const float along = p.x / 0.03125F + 0.5F * static_cast<float>(floor_int(row) & 1);
    const int stone = (floor_int(row) * 31 + floor_int(along) * 17) & 63;
    const Vec2 in{2 * fraction(along) - 1, 2 * fraction(row) - 1};
    const float dome = clamp01(1.5F - square(square(in.x)) - square(square(in.y)));
    const float shade = 0.65F + 0.012F * static_cast<float>(stone * stone % 61);
    return (0.25F + 0.75F * dome * shade) * (1 + 0.16F * grain) *
           (Rgb{0.33F, 0.29F, 0.28F} * light);
}

}  // namespace stipple
