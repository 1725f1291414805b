#include "view/stream_timeline.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/index.h"
#include "core/parallel.h"
#include "decoder/pixel_response.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMaxBins = 1024;
constexpr std::size_t kMaxDamage = 100;
constexpr std::chrono::milliseconds kWait{200};

}  // namespace

StreamTimeline::StreamTimeline(const std::filesystem::path& file) : reader_(file) {
    reader_.follow_switches();
    thread_ = std::thread([this] { run_on_this_thread([this] { run(); }); });
}

StreamTimeline::~StreamTimeline() {
    ended_ = true;
    thread_.join();
}

void StreamTimeline::run() {
    try {
        SaturatedSamples counts(reader_.header());
        for (SamplePacket packet; !ended_;) {
            if (!reader_.next(packet)) {
                if (wait_for_more()) continue;
                return;
            }
            const std::uint64_t before = counts.saturated();
            counts.add(packet);
            add(packet, counts.saturated() - before);
        }
    } catch (const std::exception& e) {
        const std::lock_guard lock(mutex_);
        failure_ = e.what();
    }
}

bool StreamTimeline::wait_for_more() {
    {
        const std::lock_guard lock(mutex_);
        report_ = reader_.report();
        if (report_.complete) return false;
    }
    std::this_thread::sleep_for(kWait);
    return true;
}

void StreamTimeline::add(const SamplePacket& packet, std::uint64_t saturated) {
    const std::lock_guard lock(mutex_);
    report_ = reader_.report();
    while (index(packet.slot / slots_per_bin_) >= kMaxBins) {
        for (std::size_t i = 0; i < bins_.size(); ++i) {
            const Bin bin = std::exchange(bins_[i], {});
            Bin& to = bins_[i / 2];
            to.samples += bin.samples;
            to.saturated += bin.saturated;
            to.whole_slots += bin.whole_slots;
            to.dropped += bin.dropped;
        }
        bins_.resize((bins_.size() + 1) / 2);
        slots_per_bin_ *= 2;
    }
    const std::size_t at = index(packet.slot / slots_per_bin_);
    if (at >= bins_.size()) bins_.resize(at + 1);
    bins_[at].samples += packet.dn.size();
    bins_[at].saturated += saturated;
    bins_[at].dropped += (packet.flags & SamplePacket::kDropped) != 0 ? 1 : 0;
    if (packet.first_row + packet.rows == reader_.header().shape.rows) ++bins_[at].whole_slots;
}

ordered_json StreamTimeline::json() const {
    const std::lock_guard lock(mutex_);
    ordered_json samples = ordered_json::array(), saturated = samples, missing = samples,
                 dropped = samples, damage = samples;
    for (std::size_t i = 0; i < bins_.size(); ++i) {
        const auto first = static_cast<std::int64_t>(i) * slots_per_bin_;
        samples.push_back(bins_[i].samples);
        saturated.push_back(bins_[i].saturated);
        const std::int64_t there = std::min(slots_per_bin_, report_.slots - first);
        missing.push_back(std::max<std::int64_t>(there - bins_[i].whole_slots, 0));
        dropped.push_back(bins_[i].dropped);
    }
    for (const StreamDamage& place : report_.damage)
        if (damage.size() < kMaxDamage)
            damage.push_back({{"byte", place.offset}, {"cause", place.cause}});
    return {{"slots", report_.slots},
            {"complete", report_.complete || !failure_.empty()},
            {"slots_per_bin", slots_per_bin_},
            {"samples", samples},
            {"saturated", saturated},
            {"missing", missing},
            {"dropped", dropped},
            {"damage", damage},
            {"failure", failure_}};
}

}  // namespace stipple
