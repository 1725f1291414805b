#include "study/scenes/embedded_scenes.h"
#include "study/scenes/surfaces.h"

namespace stipple {

namespace {

constexpr float kVanishing = -0.35F;  // height at which the boards would meet
constexpr Vec2 kBulb{0.07F, -0.345F};
constexpr Rgb kDaylight{0.40F, 0.42F, 0.46F};
constexpr Rgb kSunlight{1.15F, 0.98F, 0.70F};
constexpr Rgb kBulbLight{1.3F, 0.80F, 0.38F};

/// 1 in the panes of a leaning window's patch of sun, p in panes; soft by `blur`.
float window_patch(Vec2 p, float blur) {
    const auto bar = [blur](float x, float size) {
        const float inside = smooth_step(-blur, blur, x) * smooth_step(size + blur, size - blur, x);
        return inside * smooth_step(0.04F - blur, 0.04F + blur, std::abs(x - 0.5F * size));
    };
    return bar(p.x, 2) * bar(p.y, 3);
}

}  // namespace

Rgb RollScene::ground(Vec2 point, float shadow) const noexcept {
    const float scale = (point.y - kVanishing) / (kFloorLine - kVanishing);
    const Vec2 p{point.x / scale, 1.2F / scale};
    const float sun =
        window_patch({(p.x + 0.52F + 0.5F * (p.y - 0.7F)) / 0.21F, (p.y - 0.66F) / 0.125F}, 0.06F);
    const Rgb light = shadow * (kDaylight + sun * kSunlight);
    const Rgb board = planks(*textures_, {p.x + 3, p.y}, 0.115F);
    const float corner = smooth_step(0, 0.03F, point.y - kFloorLine);
    return mix(0.45F, 1, corner) * (board * light);
}

Rgb RollScene::wall(Vec2 point, float shadow) const noexcept {
    const float grain = textures_->coarse.at(point.x, point.y);
    const Vec2 bulb = point - kBulb;
    if (dot(bulb, bulb) < square(0.015F)) return {13, 9.5F, 5.5F};
    const Rgb halo = 0.9F * light_pool(dot(bulb, bulb), 0.035F) * kBulbLight;
    if (std::abs(bulb.x) < 0.0025F && bulb.y < 0) return {0.015F, 0.013F, 0.011F};
    // A doorway into a dark cellar: the deepest shadow of the image.
    const Vec2 door{std::abs(point.x - 0.36F), kFloorLine - point.y};
    if (door.x < 0.085F && door.y < 0.40F) {
        const float stairs = fraction(door.y / 0.045F) < 0.2F ? 2.0F : 1.0F;
        return (2.5e-4F + 0.006F * square(clamp01(1 - door.y / 0.10F))) * stairs *
               (1 + 0.3F * grain) * Rgb{1, 0.9F, 0.75F};
    }
    const float sun = window_patch(
        {(point.x + 0.60F + 0.35F * point.y) / 0.16F, (point.y + 0.46F + 0.25F * point.x) / 0.145F},
        0.035F);
    const Rgb light = shadow * (mix(0.75F, 1.0F, smooth_step(0.4F, -0.3F, point.x)) * kDaylight +
                                sun * kSunlight) +
                      light_pool(dot(bulb, bulb), 0.22F) * kBulbLight;
    if (door.x < 0.105F && door.y < 0.42F)
        return (door.x > 0.099F || door.x < 0.088F ? 0.6F : 1.0F) *
               (Rgb{0.42F, 0.40F, 0.36F} * light);
    if (door.y < 0.055F) {  // skirting board
        const float profile = door.y > 0.047F                      ? 1.25F
                              : std::abs(door.y - 0.038F) < 0.002F ? 0.5F
                                                                   : 1;
        return profile * (1 + 0.05F * grain) * (Rgb{0.52F, 0.49F, 0.43F} * light);
    }
    // Wallpaper: stripes, fine lines and a lozenge in every second stripe.
    const float column = point.x / 0.058F + 40;
    const bool wide = (floor_int(column) & 1) != 0;
    Rgb paper = wide ? Rgb{0.42F, 0.50F, 0.38F} : Rgb{0.58F, 0.60F, 0.46F};
    if (std::abs(fraction(column) - 0.06F) < 0.02F) paper = {0.62F, 0.50F, 0.24F};
    const Vec2 lozenge{
        std::abs(fraction(column) - 0.53F),
        fraction(point.y / 0.075F + 0.25F * static_cast<float>(floor_int(column) & 3)) - 0.5F};
    if (!wide && 1.6F * lozenge.x + 0.9F * std::abs(lozenge.y) < 0.26F)
        paper = 1.6F * lozenge.x + 0.9F * std::abs(lozenge.y) < 0.10F ? Rgb{0.62F, 0.50F, 0.24F}
                                                                      : Rgb{0.33F, 0.17F, 0.13F};
    const float stain = textures_->smooth.at(point.x + 0.3F, point.y);
    return (1 + 0.09F * grain + 0.06F * stain) * (paper * light) + halo;
}

}  // namespace stipple
