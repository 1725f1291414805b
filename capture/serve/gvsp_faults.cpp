#include "capture/serve/gvsp_faults.h"

#include <numeric>
#include <utility>

#include "core/philox.h"

namespace stipple {
namespace {

enum class Fault : std::uint32_t { kDrop = 0x100, kLose, kDuplicate };

bool happens(const GvspFaults& faults, double share, Fault fault, std::uint64_t number,
             std::uint32_t index) {
    if (share <= 0) return false;
    const PhiloxCounter words = philox4x32(
        {index, static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(fault), 0},
        faults.seed);
    return words[0] < share * 4294967296.0;
}

}  // namespace

bool is_lost(const GvspFaults& faults, std::uint64_t number, std::uint32_t index) {
    return happens(faults, faults.lose, Fault::kLose, number, index);
}

std::vector<std::uint32_t> packets_to_send(const GvspFaults& faults, std::uint64_t number,
                                           std::uint32_t packets) {
    std::vector<std::uint32_t> order(packets);
    std::iota(order.begin(), order.end(), 0U);
    if (faults.reorder)
        for (std::size_t i = 1; i + 2 < order.size(); i += 4) std::swap(order[i], order[i + 1]);
    std::vector<std::uint32_t> sent;
    sent.reserve(packets);
    for (const std::uint32_t index : order) {
        if (is_lost(faults, number, index)) continue;
        if (happens(faults, faults.drop, Fault::kDrop, number, index)) continue;
        sent.push_back(index);
        if (happens(faults, faults.duplicate, Fault::kDuplicate, number, index))
            sent.push_back(index);
    }
    return sent;
}

std::uint64_t number_with_gap(const GvspFaults& faults, std::uint64_t number) {
    return faults.gap_at && number >= *faults.gap_at ? number + faults.gap_frames : number;
}

}  // namespace stipple
