#pragma once

/// Synthetic scenes in linear light, of more than 14 stops (docs/scenes.md):
///
///     stipple::Scene scene(stipple::SceneName::kPan,
///                          {.slots = 60, .shape = {.rows = 48, .cols = 64, .planes = 1}});
///     stipple::FrameWriter file("scene.npy", scene.options().shape, {.force = true});
///     std::vector<float> light(scene.options().shape.sites());
///     for (int slot = 0; slot < scene.options().slots; ++slot) {
///         scene.render(slot, light);
///         file.write(light);
///     }
///     file.finish();
#include "stipple/video.h"
#include "study/scenes/scene.h"
