#pragma once

/// Many sensors, schedules and decoders on one clip (docs/explore.md):
///
///     std::ofstream("space.toml") << "[axes]\nfootage = 'scene.npy'\nsensor = 'lux1310'\n"
///                                    "method = ['naive', 'fast']\n";
///     stipple::Exploration trials("space.toml", "results", {}, [] { return true; });
///     while (trials.next_rung())
///         for (const std::uint64_t number : trials.due())
///             if (const stipple::Trial* trial = trials.begin(number))
///                 trials.put(number, stipple::run_trial(*trial, trials.light(), "trial.stipple",
///                                                       [] { return true; }));
///     for (const std::uint64_t point : trials.best_first())
///         std::cout << point << "\n";
#include "study/explore/exploration.h"
