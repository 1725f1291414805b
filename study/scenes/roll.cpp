#include "study/scenes/embedded_scenes.h"

#include <algorithm>

#include "study/scenes/surfaces.h"

namespace stipple {

namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr double kRearShare = 0.8;  // the rear disc's way against the front one's
constexpr float kThickness = 0.028F;
constexpr double kSpeed = 3.2 / 240;  // greatest speed of a centre; the top of a disc has twice it
constexpr Rgb kBrass{0.62F, 0.42F, 0.16F};

/// A disc that swings to and fro by `amplitude` without slipping.
RollScene::Disc rolling(double amplitude, double phase_turns, float foot, float radius) {
    const double x = amplitude * static_cast<double>(wave(phase_turns));
    RollScene::Disc disc;
    disc.radius = radius;
    disc.centre = {static_cast<float>(x), foot - radius};
    disc.turn = direction(x / (kTwoPi * static_cast<double>(radius)));
    return disc;
}

}  // namespace

RollScene::RollScene(const SceneTextures& textures, float aspect)
    : textures_(&textures),
      amplitude_(static_cast<double>(std::clamp(0.5F * aspect - 0.30F, 0.12F, 0.40F))),
      phase_(textures.random.between(-0.16F, -0.08F, 0, 0x20000U)) {}

RollScene::Instant RollScene::at(double time) const {
    const double turns = time * kSpeed / (kTwoPi * amplitude_) + static_cast<double>(phase_);
    Instant instant;
    instant.scene = this;
    instant.discs = {rolling(amplitude_, turns, 0.39F, 0.255F),
                     rolling(-kRearShare * amplitude_, turns * 0.85 + 0.06, 0.225F, 0.115F)};
    instant.discs[0].ivory = {0.86F, 0.78F, 0.60F};
    instant.discs[0].dark = {0.035F, 0.06F, 0.14F};
    instant.discs[1].ivory = {0.80F, 0.72F, 0.30F};
    instant.discs[1].dark = {0.30F, 0.04F, 0.03F};
    return instant;
}

float RollScene::Instant::wall_shadow(Vec2 point) const noexcept {
    float light = 1;
    for (const Disc& disc : discs) {
        const float depth = disc.foot() - kFloorLine;  // from the wall, as seen on the floor
        const Vec2 away = point - disc.centre - Vec2{0.10F + 0.5F * depth, 0.01F - 0.6F * depth};
        const float blur = 0.012F + 0.22F * depth;
        light *= 1 - 0.6F * smooth_step(disc.radius + blur, disc.radius - blur,
                                        std::sqrt(dot(away, away)));
    }
    return light;
}

float RollScene::Instant::floor_shadow(Vec2 point) const noexcept {
    float light = 1;
    for (const Disc& disc : discs) {
        const Vec2 away = point - Vec2{disc.centre.x + 0.03F, disc.foot() - 0.004F};
        const float wide = away.x / disc.radius;
        const float contact = light_pool(square(wide * 2.2F) + square(away.y / 0.02F), 1);
        const float streak = light_pool(
            square(1.2F * wide - 0.35F) + square((away.y + 0.12F * disc.radius * wide) / 0.05F), 1);
        light *= (1 - 0.9F * contact) * (1 - 0.55F * streak);
    }
    return light;
}

Rgb RollScene::Instant::radiance(Vec2 point, Vec2 /*stratum*/) const noexcept {
    for (const Disc& disc : discs) {
        const Vec2 away = point - disc.centre;
        const float r2 = square(disc.radius);
        if (dot(away, away) < r2) return scene->face(disc, away);
        const Vec2 behind = away - Vec2{kThickness * disc.radius * 4, -0.012F};
        if (dot(behind, behind) < r2) return scene->tread(disc, behind);
    }
    if (point.y > kFloorLine) return scene->ground(point, floor_shadow(point));
    return scene->wall(point, wall_shadow(point));
}

Rgb RollScene::tread(const Disc& disc, Vec2 from_centre) const noexcept {
    const float turns = turns_of(
        {dot(disc.turn, from_centre), disc.turn.x * from_centre.y - disc.turn.y * from_centre.x});
    const float rib = fraction(turns * 60) < 0.5F ? 1.0F : 0.45F;
    const float up = 0.5F - 0.5F * from_centre.y / disc.radius;
    return rib * (0.04F + 0.45F * up * up) * kBrass;
}

Rgb RollScene::inlay(const Disc& disc, Vec2 local, float rho) const noexcept {
    const float turns = turns_of(local) + 1;
    const float grain = textures_->coarse.at(1.6F * local.x, 1.6F * local.y);
    const float veins = textures_->smooth.at(2 * local.x, 2 * local.y + 0.4F);
    const auto is_odd = [](float x) { return (floor_int(x) & 1) != 0; };
    Rgb albedo;
    if (rho > 0.93F) {  // knurled rim
        albedo = (fraction(90 * turns) < 0.5F ? 1.1F : 0.35F) * kBrass;
    } else if (rho > 0.80F) {  // a scale of fine lines, every fifth one longer
        const float line = fraction(120 * turns);
        const bool longer = floor_int(120 * turns) % 5 == 0;
        const bool mark = line < 0.38F && rho > (longer ? 0.815F : 0.865F);
        albedo = mark ? disc.dark : (1 + 0.07F * grain) * disc.ivory;
    } else if (rho > 0.60F) {  // chequers with marbling
        albedo = is_odd(24 * turns) != is_odd((rho - 0.60F) / 0.0667F) ? disc.ivory : disc.dark;
        albedo = (1 + 0.18F * grain) * albedo;
    } else if (rho > 0.57F || rho < 0.20F) {
        albedo = kBrass;
    } else {  // a star of two woods
        const float point = std::abs(2 * fraction(8 * turns) - 1);
        const bool star = rho < 0.26F + 0.28F * point;
        albedo = star ? Rgb{0.62F, 0.20F, 0.08F} : Rgb{0.12F, 0.34F, 0.32F};
        albedo = (1 + 0.20F * grain + 0.16F * veins) * albedo;
    }
    const Vec2 bolt{rho - 0.14F, 0.14F * 6.2832F * (fraction(6 * turns) - 0.5F) / 6};
    if (dot(bolt, bolt) < square(0.026F)) return {0.004F, 0.003F, 0.002F};
    return albedo;
}

Rgb RollScene::face(const Disc& disc, Vec2 from_centre) const noexcept {
    const Vec2 local{dot(disc.turn, from_centre),
                     disc.turn.x * from_centre.y - disc.turn.y * from_centre.x};
    const float distance = std::sqrt(dot(from_centre, from_centre));
    const float rho = distance / disc.radius;
    const Vec2 unit = 1 / (disc.radius) * from_centre;
    // Light from the upper left; the lacquer is slightly domed.
    const float light = 0.62F - 0.16F * unit.x - 0.26F * unit.y;
    const bool metal = rho > 0.93F || (rho > 0.57F && rho < 0.60F) || rho < 0.20F;
    Rgb out = light * inlay(disc, local, rho);
    // Turned metal shines in two opposite sectors that stay put while it rotates.
    const float along = distance > 0 ? (unit.x * 0.62F + unit.y * 0.78F) / rho : 0;
    if (metal) out = out + 1.1F * power16(along) * kBrass;
    const Vec2 glint = unit - Vec2{-0.07F, -0.08F};
    out = out + 10 * light_pool(dot(glint, glint), 0.02F) * Rgb{1, 0.93F, 0.8F};
    return out;
}

}  // namespace stipple
