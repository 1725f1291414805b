#pragma once

#include <optional>

#include "scenes/noise_texture.h"
#include "scenes/vector.h"

namespace stipple {

/// A quiet room held in the hand: a bright window with the sun in it, a hanging lamp, shelves
/// with deep shadows, a table. Everything moves less than a pixel or so per slot.
/// Picture height = 1 unit, y down, origin in the centre.
class StillScene {
  public:
    static constexpr float kTableEdge = 0.245F;  ///< height of the far edge of the table

    explicit StillScene(const SceneTextures& textures);

    /// The scene at one instant.
    struct Instant {
        [[nodiscard]] Rgb radiance(Vec2 point, Vec2 stratum) const noexcept;

        const StillScene* scene = nullptr;
        Vec2 sway;         ///< of the hand, for things as far as the wall
        Vec2 lamp;         ///< where the lamp hangs, on the wall's scale
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
