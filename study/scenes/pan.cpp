#include "study/scenes/embedded_scenes.h"

namespace stipple {

namespace {

constexpr double kPeriod = 8;         // of everything along the street
constexpr double kSpeed = 2.5 / 240;  // of the camera, X per slot: 2.5 px at the houses
constexpr float kHorizon = 0.02F;
constexpr float kHillScale = 0.4F;  // 1 px per slot
constexpr float kCloudScale = 0.125F;

constexpr Rgb kHaze{0.62F, 0.40F, 0.33F};
constexpr Vec2 kSun{-0.36F, -0.19F};

}  // namespace

PanScene::Instant PanScene::at(double time) const {
    Instant instant;
    instant.scene = this;
    instant.camera = static_cast<float>(wrapped(time * kSpeed, kPeriod));
    instant.eye = 0.2F + 0.006F * wave(time / 70);
    instant.tilt = direction(0.004 * static_cast<double>(wave(time / 110)));
    return instant;
}

Vec2 PanScene::Instant::world(Vec2 point, float scale) const noexcept {
    return {point.x / scale + camera, eye + (kHorizon - point.y) / scale};
}

Rgb PanScene::Instant::radiance(Vec2 point, Vec2 /*stratum*/) const noexcept {
    const Vec2 p{tilt.x * point.x - tilt.y * point.y, tilt.y * point.x + tilt.x * point.y};
    if (const auto hit = scene->railing(world(p, kRailingScale))) return *hit;
    if (const auto hit = scene->lamp(world(p, kLampScale))) return *hit;
    if (const auto hit = scene->tree(world(p, kTreeScale))) return *hit;
    if (const auto hit = scene->house(world(p, kHouseScale))) return *hit;
    if (p.y > kHorizon + eye * kHouseScale) return street(p);
    if (const auto hit = scene->hills(world(p, kHillScale))) return *hit;
    return sky(p);
}

Rgb PanScene::Instant::street(Vec2 point) const noexcept {
    const float scale = (point.y - kHorizon) / eye;
    return scene->ground(world(point, scale), scale);
}

Rgb PanScene::Instant::sky(Vec2 point) const noexcept {
    const float height = clamp01((0.15F - point.y) / 0.65F);
    const Rgb clear = mix(mix({0.95F, 0.50F, 0.24F}, {0.52F, 0.36F, 0.40F}, clamp01(2.5F * height)),
                          {0.13F, 0.21F, 0.42F}, smooth_step(0.15F, 1, height));
    const Vec2 cloud = world(point, kCloudScale);
    const NoiseTexture& noise = scene->textures_->smooth;
    const float density = noise.at(0.125F * cloud.x, 0.5F * cloud.y) +
                          0.4F * scene->textures_->coarse.at(0.25F * cloud.x, 0.6F * cloud.y);
    const Rgb lit = mix(Rgb{1.05F, 0.60F, 0.38F}, {0.40F, 0.33F, 0.40F}, height);
    const Rgb air = mix(clear, lit, 0.75F * smooth_step(0.1F, 1.8F, density));
    const Vec2 away = point - kSun;
    const float distance2 = dot(away, away);
    if (distance2 < square(0.02F)) return {16, 11, 6};
    return air + 0.9F / (1 + distance2 / square(0.05F)) * Rgb{1, 0.62F, 0.28F};
}

std::optional<Rgb> PanScene::hills(Vec2 world) const noexcept {
    const float far_top = 0.28F + 0.05F * textures_->smooth.at(0.25F * world.x, 0.3F);
    if (world.y > far_top) return {};
    const float near_top = 0.21F + 0.035F * textures_->smooth.at(0.5F * world.x, 0.7F) +
                           0.006F * textures_->coarse.at(world.x, 0.1F);
    const bool near = world.y < near_top;
    const float forest = 1 + 0.35F * textures_->coarse.at(world.x, 1.5F * world.y);
    const Rgb albedo = forest * (near ? Rgb{0.10F, 0.13F, 0.06F} : Rgb{0.14F, 0.14F, 0.13F});
    return mix(albedo, kHaze, near ? 0.25F : 0.6F);
}

}  // namespace stipple
