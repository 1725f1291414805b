#include "study/scenes/embedded_scenes.h"

#include <algorithm>
#include <limits>

#include "study/scenes/surfaces.h"

namespace stipple {

namespace {

constexpr Vec3 kEye{0, -1.22F, 1.60F};
constexpr Vec3 kTarget{0, 0.05F, 0.06F};
constexpr float kFocal = 1.72F;
constexpr Vec3 kLamp{-1.1F, -0.15F, 2.1F};
constexpr float kLampSize = 0.30F;
constexpr float kBallRadius = DiceScene::kBall.z;

/// Distance to the first point of a sphere, or nothing.
std::optional<float> hit_sphere(const DiceScene::Ray& ray, Vec3 centre, float radius) {
    const Vec3 to = centre - ray.origin;
    const float along = dot(to, ray.direction);
    const float inside = square(radius) - (dot(to, to) - square(along));
    if (inside < 0 || along < 0) return {};
    return along - std::sqrt(inside);
}

}  // namespace

DiceScene::DiceScene(const SceneTextures& textures) : textures_(&textures) {
    camera_.z = normalized(kTarget - kEye);
    camera_.y = cross(camera_.z, camera_.x);
    const Rgb ivory{0.56F, 0.52F, 0.42F};
    const Rgb black{0.004F, 0.004F, 0.005F};
    dice_ = {
        {{0.126F, {-0.36F, -0.12F}, {0.10F, 0.10F}, 0.16F, 0.00F, ivory, black},
         {0.106F, {0.13F, -0.26F}, {0.14F, 0.06F}, 0.20F, 0.31F, {0.55F, 0.02F, 0.02F}, ivory},
         {0.115F, {0.40F, 0.17F}, {0.09F, 0.10F}, 0.12F, 0.62F, {0.02F, 0.12F, 0.38F}, ivory},
         {0.088F, {-0.02F, 0.16F}, {0.10F, 0.10F}, 0.24F, 0.83F, {0.03F, 0.26F, 0.10F}, ivory},
         {0.076F, {-0.40F, 0.30F}, {0.10F, 0.06F}, 0.15F, 0.47F, {0.70F, 0.36F, 0.03F}, black},
         {0.060F, {0.06F, 0.42F}, {0.16F, 0.03F}, 0.18F, 0.15F, ivory, {0.45F, 0.02F, 0.02F}}}};
    for (std::uint32_t i = 0; i < kDice; ++i)
        dice_[i].start += 0.2F * textures.random.uniform(i, 0x40000U);
}

DiceScene::Posed DiceScene::pose(const Die& die, double time) const {
    const auto start = static_cast<double>(die.start);
    const double bounce = wrapped(time / 44 + start * 3, 1);
    const double pace = 0.085 / static_cast<double>(die.half + 0.02F);  // small dice turn faster
    Posed posed;
    posed.centre = {die.home.x + die.sweep.x * wave(time / 110 + start),
                    die.home.y + die.sweep.y * wave(time / 150 + start * 2),
                    1.74F * die.half + die.hop * static_cast<float>(4 * bounce * (1 - bounce))};
    const Vec2 a = direction(pace * time / 62 + start);
    const Vec2 b = direction(pace * time / 91 + start * 5);
    const Vec2 c = direction(pace * time / 140 + start * 7);
    const Rotation about_x{{1, 0, 0}, {0, a.x, -a.y}, {0, a.y, a.x}};
    const Rotation about_y{{b.x, 0, b.y}, {0, 1, 0}, {-b.y, 0, b.x}};
    const Rotation about_z{{c.x, -c.y, 0}, {c.y, c.x, 0}, {0, 0, 1}};
    const auto turned = [&](Vec3 axis) {
        return about_x.apply(about_y.apply(about_z.apply(axis)));
    };
    posed.turn = {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})};
    return posed;
}

DiceScene::Instant DiceScene::at(double time) const {
    Instant instant;
    instant.scene = this;
    for (std::size_t i = 0; i < kDice; ++i) instant.posed[i] = pose(dice_[i], time);
    return instant;
}

std::optional<DiceScene::Hit> DiceScene::Instant::nearest_die(const Ray& ray) const noexcept {
    std::optional<Hit> nearest;
    for (std::size_t i = 0; i < kDice; ++i) {
        const float half = scene->dice_[i].half;
        const Vec3 to = posed[i].centre - ray.origin;
        const float along = dot(to, ray.direction);
        if (along < 0 || dot(to, to) - square(along) > 3 * square(half)) continue;
        const Vec3 from = posed[i].turn.apply(-1 * to);
        const Vec3 way = posed[i].turn.apply(ray.direction);
        // Slabs: enter through the last of the three near planes, before any far plane.
        const float start[3] = {from.x, from.y, from.z};
        const float step[3] = {way.x, way.y, way.z};
        float enter = 0;
        float leave = std::numeric_limits<float>::max();
        int axis = -1;
        for (int k = 0; k < 3; ++k) {
            const float inverse = 1 / (std::abs(step[k]) < 1e-12F ? 1e-12F : step[k]);
            const float near = (step[k] > 0 ? -half - start[k] : half - start[k]) * inverse;
            const float far = (step[k] > 0 ? half - start[k] : -half - start[k]) * inverse;
            if (near > enter) {
                enter = near;
                axis = k;
            }
            leave = std::min(leave, far);
        }
        if (axis < 0 || enter >= leave || (nearest && enter >= nearest->distance)) continue;
        nearest = Hit{enter, i, 1 / half * (from + enter * way), axis};
    }
    return nearest;
}

bool DiceScene::Instant::shadowed(Vec3 point, Vec3 to_lamp) const noexcept {
    const Ray ray{point, normalized(to_lamp)};
    return hit_sphere(ray, kBall, kBallRadius).has_value() || nearest_die(ray).has_value();
}

Rgb DiceScene::Instant::radiance(Vec2 point, Vec2 stratum) const noexcept {
    const Ray ray{kEye, normalized(scene->camera_.apply_inverse({point.x, point.y, kFocal}))};
    const Vec3 lamp = kLamp + kLampSize * Vec3{stratum.x - 0.5F, 0.5F - stratum.y, 0};
    const auto hit = nearest_die(ray);
    const auto ball = hit_sphere(ray, kBall, kBallRadius);
    if (ball && (!hit || *ball < hit->distance)) return ball_light(ray, *ball, lamp);
    if (hit) return die_light(ray, *hit, lamp);
    return board_light(ray, lamp);
}

}  // namespace stipple
