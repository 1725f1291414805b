#include "tests/support/simd_targets.h"

#include <hwy/targets.h>

#include <algorithm>
#include <cstdint>

namespace stipple {

void for_each_simd_target(const std::function<void(const std::string&)>& body) {
    auto targets = hwy::SupportedAndGeneratedTargets();  // the best one first
    std::ranges::reverse(targets);
    for (const std::int64_t target : targets) {
        hwy::GetChosenTarget().Update(target);
        body(hwy::TargetName(target));
    }
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace stipple
