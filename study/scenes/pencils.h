#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "study/scenes/noise_texture.h"
#include "study/scenes/vector.h"

namespace stipple {

/// Coloured pencils with individual sliding and turning motions over a desk with squared paper and
/// a deep steel cup, seen from above in low sunlight. Image height = 1 unit, y down, origin in the
/// centre.
class PencilsScene {
  public:
    /// `aspect` is width / height of the image.
    PencilsScene(const SceneTextures& textures, float aspect);

    static constexpr float kCupRadius = 0.135F;
    static constexpr std::size_t kPencils = 128;
    using PencilSet = std::array<std::uint64_t, kPencils / 64>;  ///< one bit each

    /// A pencil and its motion in slots; a `Posed` is the pencil at one instant.
    struct Pencil {
        Vec2 start;
        Vec2 velocity;
        float start_turns = 0;
        float turns_per_slot = 0;
        float half_length = 0;
        float half_width = 0;
        Rgb colour;
        bool plain = false;  ///< a round stick without tip and ferrule
    };
    struct Posed {
        Vec2 centre;
        Vec2 axis;                     ///< (cos, sin); the tip points along it
        std::array<float, 3> edge{};   ///< of the hexagon, -1..1 across the pencil
        std::array<float, 4> light{};  ///< on the facets between the edges
        std::array<float, 4> highlight{};
    };

    /// The scene at one instant.
    struct Instant {
        [[nodiscard]] Rgb radiance(Vec2 point, Vec2 stratum) const noexcept;

        const PencilsScene* scene = nullptr;
        std::array<Posed, kPencils> posed;
        std::vector<PencilSet> near;  ///< per tile: pencils that may cover or shadow it
    };

    [[nodiscard]] Instant at(double time) const;

  private:
    Pencil random_pencil(std::uint32_t item) const;
    Posed pose(const Pencil& pencil, double time) const;
    std::vector<PencilSet> near_tiles(const std::array<Posed, kPencils>& posed) const;
    const PencilSet& near_point(const Instant& instant, Vec2 point) const noexcept;

    Rgb pencil_light(const Pencil& pencil, const Posed& posed, Vec2 local) const noexcept;
    Rgb desk(Vec2 point) const noexcept;
    Rgb cup(Vec2 from_centre) const noexcept;

    const SceneTextures* textures_;
    Vec2 extent_;  ///< the area in which pencils wrap around, larger than the image
    int tile_cols_;
    std::array<Pencil, kPencils> pencils_;
};

}  // namespace stipple
