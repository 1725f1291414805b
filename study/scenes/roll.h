#pragma once

#include <array>

#include "study/scenes/noise_texture.h"
#include "study/scenes/vector.h"

namespace stipple {

/// Two inlaid discs that roll to and fro on the floor boards of a sunlit room, in opposite
/// directions. Image height = 1 unit, y down, origin in the centre.
class RollScene {
  public:
    static constexpr float kFloorLine = 0.14F;  ///< edge between wall and floor

    /// `aspect` is width / height of the image.
    RollScene(const SceneTextures& textures, float aspect);

    struct Disc {
        Vec2 centre;
        float radius = 0;
        Vec2 turn;  ///< (cos, sin) of its rotation
        Rgb ivory;  ///< its light inlay
        Rgb dark;   ///< its dark inlay
        [[nodiscard]] float foot() const { return centre.y + radius; }
    };

    /// The scene at one instant.
    struct Instant {
        [[nodiscard]] Rgb radiance(Vec2 point, Vec2 stratum) const noexcept;

        const RollScene* scene = nullptr;
        std::array<Disc, 2> discs;  ///< front first
        [[nodiscard]] float wall_shadow(Vec2 point) const noexcept;
        [[nodiscard]] float floor_shadow(Vec2 point) const noexcept;
    };

    [[nodiscard]] Instant at(double time) const;

  private:
    Rgb face(const Disc& disc, Vec2 from_centre) const noexcept;
    Rgb inlay(const Disc& disc, Vec2 local, float rho) const noexcept;
    Rgb tread(const Disc& disc, Vec2 from_centre) const noexcept;
    Rgb wall(Vec2 point, float shadow) const noexcept;
    Rgb ground(Vec2 point, float shadow) const noexcept;

    const SceneTextures* textures_;
    double amplitude_;  // of the path of the front disc
    float phase_;
};

}  // namespace stipple
