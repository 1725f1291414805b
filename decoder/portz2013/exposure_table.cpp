#include "decoder/portz2013/exposure_table.h"
#include "decoder/measurements.h"

#include <algorithm>
#include <array>

namespace stipple {

ExposureTable::ExposureTable(const Measurements& measurements)
    : slots_(measurements.slots), shape_(measurements.shape), index_(measurements.voxels(), kNone) {
    const std::size_t sites = shape_.sites();
    const auto slots = static_cast<std::size_t>(slots_);
    weights_.resize(measurements.weight.size());
    for (std::size_t site = 0; site < sites; ++site) {
        std::array<TimedSample, 2> chains{};
        for (int slot = 0; slot < slots_; ++slot) {
            const std::size_t voxel = static_cast<std::size_t>(slot) * sites + site;
            const std::uint8_t state = measurements.state[voxel];
            if ((state & Measurements::kOpen) == 0) continue;
            TimedSample& sample = chains[(state & Measurements::kSecond) != 0 ? 1 : 0];
            if ((state & Measurements::kFirst) != 0) sample = {.first_slot = slot};
            sample.open_slots |= std::uint64_t{1}
                                 << static_cast<unsigned>(slot - sample.first_slot);
            sample.light_slots += measurements.weight_at(voxel);
            if (!weights_.empty())
                weights_[site * slots + static_cast<std::size_t>(slot)] =
                    measurements.weight[voxel];
            if ((state & Measurements::kLast) == 0) continue;
            sample.span_slots = slot - sample.first_slot + 1;
            sample.light = measurements.sum[voxel];
            sample.saturated = (state & Measurements::kSaturated) != 0;
            most_light_slots_ = std::max(most_light_slots_, sample.light_slots);
            for (int i = 0; i < sample.span_slots; ++i)
                if ((sample.open_slots >> static_cast<unsigned>(i) & 1U) != 0)
                    index_[site * slots + static_cast<std::size_t>(sample.first_slot + i)] =
                        static_cast<std::uint32_t>(samples_.size());
            samples_.push_back(sample);
        }
    }
}

}  // namespace stipple
