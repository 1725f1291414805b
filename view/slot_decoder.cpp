#include "view/slot_decoder.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "decoder/block_partition.h"
#include "decoder/measurements.h"
#include "study/report/report_page.h"

namespace stipple {
namespace {

using Clock = std::chrono::steady_clock;

/// So few cores are for the emulation alone, but one.
constexpr int kFewCores = 3;

/// A viewer that has not asked for so long is gone.
constexpr std::chrono::seconds kForgetAfter{15};
/// A slot that has been looked at for so long is not just passed by.
constexpr std::chrono::milliseconds kPassing{150};
constexpr std::size_t kMaxBytes = std::size_t{192} << 20U;

std::size_t index_of(SlotDecoder::Level level) {
    return static_cast<std::size_t>(level);
}

/// The calling thread gets little of a processor that others want too.
void yield_to_others() {
    constexpr int kNice = 10;
    static_cast<void>(setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice));
}

}  // namespace

SlotDecoder::SlotDecoder(ViewedStream& stream, const std::filesystem::path& file,
                         const DecodeSetup& setup, const CalibrationChoice& calibration)
    : stream_(stream),
      method_(setup.options.method),
      options_(setup.options),
      session_(std::in_place, file, setup, calibration) {
    options_.fill_gaps = true;
    start();
    threads_[2] = std::thread([this] { run(Level::kBlock); });
}

SlotDecoder::SlotDecoder(ViewedStream& stream) : stream_(stream), method_(DecodeMethod::kFast) {
    start();
}

void SlotDecoder::start() {
    for (const Level level : {Level::kLive, Level::kFast}) decoder_of(level, stream_.header());
    threads_[0] = std::thread([this] { run(Level::kLive); });
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
        case Level::kLive:
            return named(live_method_).name;
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
    for (const Level level : {Level::kBlock, Level::kFast, Level::kLive})
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
    Wish& asked = wishes_[viewer];
    if (asked.slot != slot || asked.asked == Clock::time_point{}) asked.since = Clock::now();
    asked.slot = slot;
    asked.asked = Clock::now();
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
        if (level > Level::kLive && Clock::now() - wish.since < kPassing) continue;
        if (level == Level::kBlock && (there < Level::kFast || !whole_block(wish.slot))) continue;
        if (next && wish.asked < asked) continue;
        next = {wish.slot, level};
        asked = wish.asked;
    }
    return next;
}

bool SlotDecoder::first_wanted() {
    return next_task(Level::kLive).has_value();
}

bool SlotDecoder::wanted(const Task& task) const {
    return !ended_ && std::ranges::any_of(wishes_, [&](const auto& wish) {
        return wish.second.slot == task.slot ||
               (task.level == Level::kBlock &&
                wish.second.slot / kCoreSlots == task.slot / kCoreSlots);
    });
}

bool SlotDecoder::goes_on(const Task& task) {
    std::unique_lock lock(mutex_);
    if (task.level > Level::kLive)
        changed_.wait(lock, [&] { return !wanted(task) || !first_wanted(); });
    return wanted(task);
}

void SlotDecoder::run(Level level) {
    if (level > Level::kLive || on_camera()) yield_to_others();
    while (!ended_) {
        std::optional<Task> task;
        {
            std::unique_lock lock(mutex_);
            if (level == Level::kLive || !first_wanted()) task = next_task(level);
            if (!task) {
                changed_.wait_for(lock, kPassing / 3);
                continue;
            }
        }
        try {
            const bool spares_cores = on_camera() && thread_count() <= kFewCores;
            spares_cores ? run_on_this_thread([&] { work(*task); }) : work(*task);
            if (level > Level::kLive) malloc_trim(0);  // some hundred MB
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

PreviewDecoder& SlotDecoder::decoder_of(Level level,
                                        const std::shared_ptr<const StreamHeader>& header) {
    auto& [used, decoder] = decodings_[index_of(level) - 1];
    if (used == header) return *decoder;
    const auto method = level == Level::kLive ? DecodeMethod::kLive : DecodeMethod::kFast;
    used = header;
    decoder.emplace(*header, PreviewOptions{.method = method, .size = decoded_shape(*header)});
    if (level == Level::kLive) live_method_ = decoder->method();
    return *decoder;
}

void SlotDecoder::decode_slot(const Task& task) {
    for (;;) {
        const auto header = stream_.header();
        PreviewDecoder& decoder = decoder_of(task.level, header);
        const PreviewSlots slots = decoder.around(task.slot, stream_.slots());
        const auto found = stream_.packets(slots.range.begin, slots.range.end);
        if (found.header != header) continue;  // the schedule has changed meanwhile
        const auto frame =
            decoder.decode(slots, found.packets, [&](double) { return goes_on(task); });
        if (frame) store(task.slot, task.level, frame->light);
        return;
    }
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
        [&](double) { return goes_on(task); });
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
