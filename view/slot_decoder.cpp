#include "view/slot_decoder.h"

#include <algorithm>

#include "core/error.h"
#include "decoder/block_partition.h"
#include "decoder/measurements.h"
#include "study/report/report_page.h"

namespace stipple {
namespace {

using Clock = std::chrono::steady_clock;

/// A viewer that has not asked for so long is gone.
constexpr std::chrono::seconds kForgetAfter{15};
constexpr std::size_t kMaxBytes = std::size_t{192} << 20U;

std::size_t index_of(SlotDecoder::Level level) {
    return static_cast<std::size_t>(level);
}

PreviewDecoder whole_frames(const StreamHeader& header, DecodeMethod method) {
    return {header, {.method = method, .size = decoded_shape(header)}};
}

/// The block in which `decode` decodes a slot of a stream with `slots` slots.
std::int64_t block_of(std::int64_t slot, std::int64_t slots) {
    return std::min(slot / kCoreSlots, std::max<std::int64_t>(block_count(slots), 1) - 1);
}

}  // namespace

SlotDecoder::SlotDecoder(ViewedStream& stream, const std::filesystem::path& file,
                         const DecodeSetup& setup, const CalibrationChoice& calibration)
    : stream_(stream),
      method_(setup.options.method),
      options_(setup.options),
      naive_(whole_frames(stream.header(), DecodeMethod::kNaive)),
      fast_(whole_frames(stream.header(), DecodeMethod::kFast)),
      session_(std::in_place, file, setup, calibration) {
    options_.fill_gaps = true;
    start();
    threads_[2] = std::thread([this] { run(Level::kBlock); });
}

SlotDecoder::SlotDecoder(ViewedStream& stream)
    : stream_(stream),
      method_(DecodeMethod::kFast),
      naive_(whole_frames(stream.header(), DecodeMethod::kNaive)),
      fast_(whole_frames(stream.header(), DecodeMethod::kFast)) {
    start();
}

void SlotDecoder::start() {
    threads_[0] = std::thread([this] { run(Level::kNaive); });
    threads_[1] = std::thread([this] { run(Level::kFast); });
}

SlotDecoder::~SlotDecoder() {
    end();
    for (std::thread& thread : threads_)
        if (thread.joinable()) thread.join();
}

void SlotDecoder::end() {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    changed_.notify_all();
}

std::string_view SlotDecoder::name_of(Level level) const {
    switch (level) {
        case Level::kNone:
            return "";
        case Level::kNaive:
            return named(DecodeMethod::kNaive).name;
        case Level::kFast:
            return named(DecodeMethod::kFast).name;
        case Level::kBlock:
            break;
    }
    return named(method_).name;
}

SlotDecoder::Picture SlotDecoder::best_of(std::int64_t slot) const {
    const auto found = pictures_.find(slot);
    if (found == pictures_.end()) return {};
    for (const Level level : {Level::kBlock, Level::kFast, Level::kNaive})
        if (const Codes& codes = found->second[index_of(level)]) return {level, codes};
    return {};
}

SlotDecoder::Picture SlotDecoder::known(std::int64_t slot) const {
    const std::lock_guard lock(mutex_);
    return best_of(slot);
}

std::optional<SlotDecoder::Picture> SlotDecoder::picture(const std::string& viewer,
                                                         std::int64_t slot, Level than,
                                                         std::chrono::milliseconds wait) {
    const auto end = Clock::now() + wait;
    look_for_more();
    std::unique_lock lock(mutex_);
    wishes_[viewer] = {slot, Clock::now()};
    changed_.notify_all();
    for (;;) {
        const Picture best = best_of(slot);
        if (best.level > than) return best;
        if (const auto failed = failures_.find(slot); failed != failures_.end())
            throw InputError(stream_.name(), failed->second);
        const auto wish = wishes_.find(viewer);
        const bool other = wish == wishes_.end() || wish->second.slot != slot;
        if (other || ended_ || changed_.wait_until(lock, end) == std::cv_status::timeout)
            return std::nullopt;
    }
}

void SlotDecoder::look_for_more() {
    const SlotExtent extent = stream_.extent();
    const std::lock_guard lock(mutex_);
    if (extent.slots > extent_.slots)
        for (auto at = pictures_.lower_bound(extent_.slots - kMaxHaloSlots); at != pictures_.end();
             at = pictures_.erase(at))
            for (const Codes& old : at->second)
                if (old) bytes_ -= 2 * old->size();
    extent_ = extent;
}

/// Of a stream that grows a block can be decoded once all of its exposures are there.
bool SlotDecoder::whole_block(std::int64_t slot) const {
    return extent_.complete ||
           (slot / kCoreSlots + 1) * kCoreSlots + kMaxHaloSlots <= extent_.slots;
}

// Of the viewers that wait for such a picture the one that asked last. A block waits for the
// quicker pictures of its slot.
std::optional<SlotDecoder::Task> SlotDecoder::next_task(Level level) {
    std::erase_if(wishes_,
                  [](const auto& wish) { return Clock::now() - wish.second.asked > kForgetAfter; });
    std::optional<Task> next;
    Clock::time_point asked;
    for (const auto& [viewer, wish] : wishes_) {
        const Level there = best_of(wish.slot).level;
        if (there >= level || failures_.contains(wish.slot)) continue;
        if (level == Level::kBlock && (there < Level::kFast || !whole_block(wish.slot))) continue;
        if (next && wish.asked < asked) continue;
        next = {wish.slot, level};
        asked = wish.asked;
    }
    return next;
}

bool SlotDecoder::wanted(const Task& task) {
    const std::lock_guard lock(mutex_);
    if (ended_) return false;
    return std::ranges::any_of(wishes_, [&](const auto& wish) {
        return wish.second.slot == task.slot ||
               (task.level == Level::kBlock &&
                wish.second.slot / kCoreSlots == task.slot / kCoreSlots);
    });
}

void SlotDecoder::run(Level level) {
    while (!ended_) {
        std::optional<Task> task;
        {
            std::unique_lock lock(mutex_);
            task = next_task(level);
            if (!task) {
                changed_.wait_for(lock, std::chrono::seconds(1));
                continue;
            }
        }
        try {
            work(*task);
        } catch (const std::exception& e) {
            const std::lock_guard lock(mutex_);
            failures_[task->slot] = e.what();
            changed_.notify_all();
        }
    }
}

void SlotDecoder::work(const Task& task) {
    if (task.level == Level::kBlock)
        decode_block_of(task.slot);
    else
        decode_slot(task);
}

void SlotDecoder::decode_slot(const Task& task) {
    const PreviewDecoder& decoder = task.level == Level::kNaive ? naive_ : fast_;
    const std::int64_t last_first = std::max<std::int64_t>(stream_.slots() - decoder.slots(), 0);
    const std::int64_t first =
        std::clamp<std::int64_t>(task.slot - decoder.shown_slot(), 0, last_first);
    const auto packets = stream_.packets(first, first + decoder.slots());
    const auto frame = decoder.decode(
        first, packets, [&](double) { return wanted(task); }, static_cast<int>(task.slot - first));
    if (frame) store(task.slot, task.level, frame->light);
}

void SlotDecoder::decode_block_of(std::int64_t slot) {
    const SlotExtent extent = stream_.extent();
    const std::int64_t block = block_of(slot, extent.slots);
    const bool last = extent.complete && block + 1 == block_count(extent.slots);
    const std::int64_t end = last ? extent.slots : block_begin(block + 1);
    StreamReader& reader = session_->streams().front();
    reader.seek(0);
    options_.first_slot = block_begin(block);
    const Task task{slot, Level::kBlock};
    decode(
        reader, options_,
        [&](std::int64_t at, std::span<const float> light) {
            store(at, Level::kBlock, light);
            return at + 1 < end;
        },
        [&](double) { return wanted(task); });
}

void SlotDecoder::store(std::int64_t slot, Level level, std::span<const float> light) {
    auto codes = std::make_shared<const std::vector<std::uint16_t>>(light_codes(light));
    const std::lock_guard lock(mutex_);
    const std::size_t bytes = 2 * light.size();
    while (bytes_ + bytes > kMaxBytes && !pictures_.empty()) {
        // What lies farthest from the slot that is stored is the last to be looked at.
        const auto first = pictures_.begin(), last = std::prev(pictures_.end());
        const auto away = slot - first->first > last->first - slot ? first : last;
        for (const Codes& old : away->second)
            if (old) bytes_ -= 2 * old->size();
        pictures_.erase(away);
    }
    Codes& place = pictures_[slot][index_of(level)];
    if (!place) bytes_ += bytes;
    place = std::move(codes);
    changed_.notify_all();
}

}  // namespace stipple
