#pragma once

#include <string>
#include <vector>

namespace stipple {

/// One result of `stipple capture doctor`.
struct DoctorFinding {
    enum class Level { kFact, kGood, kWarning, kProblem };
    Level level = Level::kGood;
    std::string subject;  ///< "receive buffer", "group video"
    std::string fact;     ///< finding, with numbers
    std::string fix;      ///< advice, if possible a command; empty if none is needed here
};

}  // namespace stipple
