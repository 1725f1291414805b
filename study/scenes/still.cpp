#include "study/scenes/embedded_scenes.h"

#include <algorithm>

#include "study/scenes/surfaces.h"

namespace stipple {

namespace {

constexpr Vec2 kWindowCentre{-0.30F, -0.13F};
constexpr Vec2 kWindowHalf{0.24F, 0.27F};
constexpr float kFrame = 0.022F;
constexpr Vec2 kHook{0.10F, -0.62F};  // the lamp's cord is fixed above the image
constexpr float kCord = 0.36F;
constexpr Vec2 kSun{-0.40F, -0.27F};
constexpr Rgb kWindowLight{0.85F, 0.92F, 1.0F};
constexpr Rgb kLampLight{1.1F, 0.70F, 0.34F};

}  // namespace

StillScene::StillScene(const SceneTextures& textures) : textures_(&textures) {}

StillScene::Instant StillScene::at(double time) const {
    Instant instant;
    instant.scene = this;
    // Speeds: 2 pi amplitude / period; 0.5 px per slot for the hand, 0.4 for the lamp.
    instant.sway = {0.022F * wave(time / 83) + 0.006F * wave(time / 31 + 0.2),
                    0.012F * wave(time / 61 + 0.4)};
    const float swing = 0.014F * wave(time / 96);
    instant.lamp_axis = direction(static_cast<double>(swing));
    instant.lamp = kHook + kCord * Vec2{instant.lamp_axis.y, instant.lamp_axis.x};
    instant.breeze = wave(time / 74 + 0.1);
    instant.leaf_turn = 0.012F * wave(time / 47);
    return instant;
}

Rgb StillScene::Instant::radiance(Vec2 point, Vec2 /*stratum*/) const noexcept {
    const Vec2 near = point + 1.35F * sway;
    if (const auto hit = plant(near)) return *hit;
    if (near.y > kTableEdge) return table(near);
    const Vec2 p = point + sway;
    if (const auto hit = hanging_lamp(p)) return *hit;
    if (const auto hit = curtain(p)) return *hit;
    const Vec2 in{std::abs(p.x - kWindowCentre.x), std::abs(p.y - kWindowCentre.y)};
    const bool bars = in.x < 0.008F || std::abs(p.y - kWindowCentre.y + 0.07F) < 0.007F;
    if (in.x < kWindowHalf.x && in.y < kWindowHalf.y && !bars) return outside(point + 0.25F * sway);
    if (in.x < kWindowHalf.x + kFrame && in.y < kWindowHalf.y + kFrame) {
        const bool groove = std::abs(in.x - kWindowHalf.x - 0.014F) < 0.0015F ||
                            std::abs(in.y - kWindowHalf.y - 0.014F) < 0.0015F;
        return (bars ? 0.45F : groove ? 0.5F : 1.0F) * Rgb{0.34F, 0.33F, 0.31F};
    }
    if (const auto hit = scene->shelf(p)) return room_light(p) * *hit;
    return wall(p);
}

Rgb StillScene::Instant::outside(Vec2 point) const noexcept {
    const NoiseTexture& smooth = scene->textures_->smooth;
    const NoiseTexture& coarse = scene->textures_->coarse;
    const Vec2 from_sun = point - kSun;
    const float sun2 = dot(from_sun, from_sun);
    // Leaves of a tree in the wind, in front of hills and sky.
    const Vec2 blown =
        point + 0.012F * breeze * Vec2{1, 0.3F * wave(2 * static_cast<double>(point.x))};
    const float leaf = coarse.at(1.2F * blown.x, 1.2F * blown.y);
    const float crown = (blown.x + 0.36F) * 2.2F + 0.5F * smooth.at(blown.x, blown.y) -
                        2.2F * std::abs(blown.y + 0.18F);
    if (crown + 0.55F * leaf > 0.3F)
        return (1 + 0.38F * leaf) *
               mix(Rgb{0.16F, 0.21F, 0.03F}, {0.62F, 0.70F, 0.12F},
                   clamp01(0.35F + 0.4F * smooth.at(2 * blown.x, 2 * blown.y)));
    const float ridge = 0.03F + 0.02F * smooth.at(0.5F * point.x, 0.2F);
    if (point.y > ridge) {
        const float field = coarse.at(0.8F * point.x, 2 * point.y);
        return (1 + 0.2F * field) * mix(Rgb{0.50F, 0.56F, 0.42F}, {0.34F, 0.46F, 0.12F},
                                        smooth_step(ridge, 0.13F, point.y));
    }
    if (sun2 < square(0.016F)) return {18, 16, 12};
    const float cloud = smooth_step(0, 1.6F, smooth.at(point.x, 2 * point.y + 0.3F) + 0.25F * leaf);
    const Rgb clear =
        mix(Rgb{0.62F, 0.85F, 1.25F}, {1.15F, 1.20F, 1.20F}, smooth_step(-0.40F, 0.05F, point.y));
    return mix(clear, {1.45F, 1.42F, 1.38F}, 0.8F * cloud) +
           1.6F * light_pool(sun2, 0.05F) * Rgb{1, 0.9F, 0.7F};
}

std::optional<Rgb> StillScene::Instant::curtain(Vec2 point) const noexcept {
    if (point.y < -0.47F || point.y > 0.20F) return {};
    const float down = (point.y + 0.47F) / 0.67F;  // 0 at the rod
    const float drift = 0.022F * breeze * down * down;
    const float left = point.x - (kWindowCentre.x - kWindowHalf.x - 0.06F);
    const float right = (kWindowCentre.x + kWindowHalf.x + 0.06F) - point.x;
    const bool is_left = left < 0.5F * (left + right);
    const float across =
        (is_left ? left - drift : right + 0.6F * drift) / (0.085F + 0.03F * down * (1 - down));
    if (across < 0 || across > 1) return {};
    const float fold =
        0.5F + 0.5F * wave(static_cast<double>(across * 3.5F + 0.12F * breeze * down));
    const float weave = scene->textures_->coarse.at(2 * point.x, 2 * point.y);
    const bool stripe = fraction(across * 6) < 0.14F;
    // Daylight shines through where the curtain hangs before the panes.
    const float through = smooth_step(0.5F, 0.8F, across) * smooth_step(0.17F, 0.12F, point.y) *
                          smooth_step(-0.42F, -0.38F, point.y);
    const Rgb cloth = stripe ? Rgb{0.50F, 0.16F, 0.10F} : Rgb{0.78F, 0.62F, 0.40F};
    return (0.14F + 0.16F * fold + 0.62F * through * (0.45F + 0.55F * fold)) * (1 + 0.10F * weave) *
           cloth;
}

std::optional<Rgb> StillScene::Instant::hanging_lamp(Vec2 point) const noexcept {
    const Vec2 from_hook = point - kHook;
    const float along = dot(from_hook, {lamp_axis.y, lamp_axis.x});
    const float across = std::abs(from_hook.x * lamp_axis.x - from_hook.y * lamp_axis.y);
    if (along < kCord - 0.06F) {
        if (across < 0.0022F) return Rgb{0.012F, 0.011F, 0.010F};
        return {};
    }
    const float below = along - kCord;  // the shade from -0.06 to 0, the bulb under it
    const Vec2 bulb{across, below - 0.004F};
    if (below < 0 && across < 0.022F + 0.9F * (below + 0.06F)) {
        const float glow = light_pool(square(across) + square(below), 0.05F);
        const bool seam = below > -0.006F;
        return (seam ? 1.6F : 1.0F) * (0.05F + 0.55F * glow) * Rgb{0.80F, 0.36F, 0.16F};
    }
    if (dot(bulb, bulb) < square(0.017F)) return Rgb{9, 6.8F, 4.2F};
    return {};
}

Rgb StillScene::Instant::room_light(Vec2 point) const noexcept {
    const float beside = std::max(0.0F, point.x - kWindowCentre.x - kWindowHalf.x);
    const Vec2 from_lamp = point - lamp;
    const float under = smooth_step(-0.05F, 0.06F, from_lamp.y);  // the shade keeps light down
    return 0.37F / square(1 + beside / 0.40F) * kWindowLight +
           (0.25F + 0.75F * under) * light_pool(dot(from_lamp, from_lamp), 0.30F) * kLampLight;
}

Rgb StillScene::Instant::wall(Vec2 point) const noexcept {
    const float grain = scene->textures_->coarse.at(point.x, point.y);
    const float stain = scene->textures_->smooth.at(point.x, point.y + 0.5F);
    const Vec2 from_lamp = point - lamp;
    const Rgb halo = 0.35F * light_pool(dot(from_lamp, from_lamp), 0.05F) * kLampLight;
    return (1 + 0.08F * grain + 0.08F * stain) * (Rgb{0.46F, 0.50F, 0.44F} * room_light(point)) +
           halo;
}

}  // namespace stipple
