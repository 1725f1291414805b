#pragma once

#include <string>
#include <vector>

namespace stipple {

/// One thing that `stipple capture doctor` looked at.
struct DoctorFinding {
    enum class Level { kGood, kWarning, kProblem };
    Level level = Level::kGood;
    std::string subject;  ///< "receive buffer", "group video"
    std::string fact;     ///< what was found, with numbers
    std::string fix;  ///< what to do, a command where there is one; empty if good or said before
};

}  // namespace stipple
