#pragma once

#include <optional>

#include "study/scenes/noise_texture.h"
#include "study/scenes/vector.h"

namespace stipple {

/// A quiet room seen by a hand-held camera: a bright window with the sun, a hanging lamp, shelves
/// with deep shadows, a table. All motion is below about a pixel per slot. Image height = 1 unit, y
/// down, origin in the centre.
class StillScene {
  public:
    static constexpr float kTableEdge = 0.245F;  ///< height of the far edge of the table

    explicit StillScene(const SceneTextures& textures);

    /// The scene at one instant.
    struct Instant {
        [[nodiscard]] Rgb radiance(Vec2 point, Vec2 stratum) const noexcept;

        const StillScene* scene = nullptr;
        Vec2 sway;         ///< of the camera, for objects at the distance of the wall
        Vec2 lamp;         ///< position of the lamp, on the scale of the wall
        Vec2 lamp_axis;    ///< (cos, sin) of its swing
        float breeze = 0;  ///< -1..1, moves curtain and leaves
        float leaf_turn = 0;

        [[nodiscard]] std::optional<Rgb> plant(Vec2 point) const noexcept;
        [[nodiscard]] std::optional<Rgb> hanging_lamp(Vec2 point) const noexcept;
        [[nodiscard]] std::optional<Rgb> curtain(Vec2 point) const noexcept;
        [[nodiscard]] Rgb outside(Vec2 point) const noexcept;
        [[nodiscard]] Rgb table(Vec2 point) const noexcept;
        [[nodiscard]] Rgb room_light(Vec2 point) const noexcept;
        [[nodiscard]] Rgb wall(Vec2 point) const noexcept;
    };

    [[nodiscard]] Instant at(double time) const;

  private:
    std::optional<Rgb> shelf(Vec2 point) const noexcept;
    Rgb books(int row, Vec2 in_row) const noexcept;

    const SceneTextures* textures_;
};

}  // namespace stipple
