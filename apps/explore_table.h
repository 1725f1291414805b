#pragma once

#include <string>

namespace stipple {

class Exploration;

/// The points with their figures for people, a line each, and what the figures mean.
[[nodiscard]] std::string table_text(const Exploration& exploration);

/// How many points have failed for each of the first reasons, a line each with the first of them;
/// empty if none has.
[[nodiscard]] std::string problems_text(const Exploration& exploration);

}  // namespace stipple
