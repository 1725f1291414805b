#include "session/measurement_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/index.h"
#include "core/memory_limit.h"
#include "decoder/measurements.h"
#include "io/mat_volume.h"

namespace stipple {
namespace {

/// Reads the packets of one window of slots after the other.
class WindowReader {
  public:
    WindowReader(StreamReader& stream, std::int64_t first_slot) : stream_(stream) {
        stream.seek(first_slot);
        more_ = stream.next(packet_);
    }

    /// The packets in [first, end) of those that are left. False if the stream may end before
    /// `end`, or `progress` stops.
    bool read(std::int64_t first, std::int64_t end, const ProgressCallback& progress) {
        packets_.clear();
        for (; more_ && packet_.slot < end; more_ = stream_.next(packet_)) {
            if (!progress(static_cast<double>(packet_.slot))) {
                stopped_ = true;
                return false;
            }
            if (packet_.slot >= first) packets_.push_back(packet_);
        }
        return more_ || stream_.report().slots >= end;
    }

    [[nodiscard]] std::span<const SamplePacket> packets() const { return packets_; }
    [[nodiscard]] bool stopped() const { return stopped_; }

  private:
    StreamReader& stream_;
    SamplePacket packet_;
    bool more_ = false;
    bool stopped_ = false;
    std::vector<SamplePacket> packets_;
};

/// Calls visit(k, slot, pixel, voxel) for the open voxels of a window, k counting the exposures of
/// the pixel by their first slot; by slot. Returns the max number of exposures of a pixel.
template <typename Visit>
int visit_open_voxels(const Measurements& samples, const Visit& visit) {
    const std::size_t pixels = samples.shape.pixels();
    std::vector<std::array<int, 2>> current(pixels);  // of each chain
    std::vector<int> begun(pixels);
    for (int slot = 0; slot < samples.slots; ++slot)
        for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
            const std::size_t voxel = index(slot) * pixels + pixel;
            const std::uint8_t state = samples.state[voxel];
            if ((state & Measurements::kOpen) == 0) continue;
            int& k = current[pixel][(state & Measurements::kSecond) != 0 ? 1 : 0];
            if ((state & Measurements::kFirst) != 0) k = begun[pixel]++;
            visit(k, slot, pixel, voxel);
        }
    return begun.empty() ? 0 : std::ranges::max(begun);
}

/// The arrays under way. Measurements have `pixels` values each.
class Arrays {
  public:
    Arrays(const StreamHeader& header, std::size_t masks, std::string name)
        : name_(std::move(name)), pixels_(header.shape.pixels()) {
        const std::size_t bytes = header.schedule.weighted() ? sizeof(float) : 1;
        check_memory(masks * pixels_ * bytes, name_, "the masks");
        if (header.schedule.weighted())
            weights_.resize(masks * pixels_);
        else
            open_.resize(masks * pixels_);
    }

    /// Room for so many measurements in all.
    void reserve(std::size_t measurements) {
        const std::size_t values = measurements * pixels_;
        check_memory(values * (2 * sizeof(float) + 2), name_, "the measurements");
        meas_.resize(values);
        variance_.resize(values);
        saturated_.resize(values);
        zero_.resize(values);
    }

    void set_mask(std::size_t at, float weight) {
        if (open_.empty())
            weights_[at] = weight;
        else
            open_[at] = 1;
    }

    /// The sample of an exposure that ends in this voxel.
    void set_sample(std::size_t at, const Measurements& samples, std::size_t voxel) {
        meas_[at] = samples.sum[voxel];
        variance_[at] = samples.variance[voxel];
        saturated_[at] = (samples.state[voxel] & Measurements::kSaturated) != 0;
        zero_[at] = (samples.state[voxel] & Measurements::kZero) != 0;
        ++samples_;
    }

    /// Moves the arrays into `result`, whose sizes are set.
    void finish(MeasurementExport& result, const std::vector<std::size_t>& mask_shape) {
        const std::vector<std::size_t> shape{index(result.measurements), index(result.rows),
                                             index(result.cols)};
        result.samples = samples_;
        result.saturated = static_cast<std::uint64_t>(std::ranges::count(saturated_, 1));
        result.zeros = static_cast<std::uint64_t>(std::ranges::count(zero_, 1));
        if (open_.empty())
            result.arrays.push_back({"mask", mask_shape, std::move(weights_)});
        else
            result.arrays.push_back({"mask", mask_shape, std::move(open_)});
        result.arrays.push_back({"meas", shape, std::move(meas_)});
        result.arrays.push_back({"variance", shape, std::move(variance_)});
        result.arrays.push_back({"saturated", shape, std::move(saturated_)});
        result.arrays.push_back({"zero", shape, std::move(zero_)});
    }

  private:
    std::string name_;  ///< of the stream, for messages
    std::size_t pixels_;
    std::vector<float> weights_;
    std::vector<std::uint8_t> open_;  ///< empty of weights
    std::vector<float> meas_, variance_;
    std::vector<std::uint8_t> saturated_, zero_;
    std::uint64_t samples_ = 0;
};

/// What a decoder needs besides.
void add_numbers(const StreamHeader& header, MeasurementExport& result) {
    const Calibration& c = header.calibration;
    const auto add = [&](const char* name, double value) {
        result.arrays.push_back({name, {}, std::vector<double>{value}});
    };
    add("first_slot", static_cast<double>(result.first_slot));
    add("slot_us", header.slot_us);
    add("electrons_per_unit", c.electrons_per_unit);
    add("read_noise_e", c.read_noise_e);
    add("gain_e_per_dn", c.gain_e_per_dn);
    add("black_level_dn", c.black_level_dn);
    add("bit_depth", c.bit_depth);
    add("full_well_e", c.full_well_e);
    add("dark_e_per_slot", c.dark_e_per_slot);
    add("noise_free", c.noise_free ? 1 : 0);
}

/// \throws InputError if no masks of a period tell the exposures of each period.
void require_shared(const ExposureSchedule& schedule, const std::string& name) {
    const int period = schedule.period_slots();
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col) {
            const auto exposures = schedule.exposures(row, col);
            const bool crosses =
                !exposures.empty() &&
                static_cast<int>(exposures.back().first_slot) + exposures.back().span_slots() >
                    period;
            if (exposures.size() <= 1 && !crosses) continue;
            const std::string fault =
                exposures.size() > 1
                    ? fmt::format("has {} exposures in a period of {} slots", exposures.size(),
                                  period)
                    : fmt::format("has an exposure that goes on in the next period of {} slots",
                                  period);
            throw InputError(name, fmt::format("pixel ({}, {}) {}, so measurements do not share "
                                               "their masks; ",
                                               row, col, fault) +
                                       Parameter{"masks", "own"} + " gives each its own");
        }
}

InputError too_short(const StreamReader& stream, std::int64_t end) {
    return {stream.name(),
            fmt::format("holds {} slots, not {}; export others with ", stream.report().slots, end) +
                Parameter{"slots"}};
}

/// The pixels that have a sample in each period, unless it is missing.
std::vector<bool> measured_pixels(const StreamHeader& header) {
    const ExposureSchedule& schedule = header.schedule;
    std::vector<bool> measured;
    measured.reserve(header.shape.pixels());
    for (int row = 0; row < header.shape.rows; ++row)
        for (int col = 0; col < header.shape.cols; ++col) {
            const bool defect = !header.sites.empty() && header.sites[measured.size()].defect;
            measured.push_back(
                !defect &&
                !schedule.exposures(row % schedule.tile_rows(), col % schedule.tile_cols())
                     .empty());
        }
    return measured;
}

/// The measurements of one period after the other.
class SharedMasks {
  public:
    SharedMasks(const StreamHeader& header, std::string name)
        : header_(header),
          name_(std::move(name)),
          measured_(measured_pixels(header)),
          arrays_(header, index(header.schedule.period_slots()), name_) {}

    /// \throws InputError if a pixel has no sample in it.
    void add_period(std::int64_t first_slot, std::span<const SamplePacket> packets) {
        const int period = header_.schedule.period_slots();
        collect_measurements(header_, packets,
                             {.first_slot = first_slot, .slots = period, .shape = header_.shape},
                             samples_);
        arrays_.reserve(index(measurements_) + 1);
        const std::size_t offset = index(measurements_++) * header_.shape.pixels();
        std::vector<bool> found(header_.shape.pixels());
        visit_open_voxels(samples_, [&](int, int, std::size_t pixel, std::size_t voxel) {
            arrays_.set_mask(voxel, samples_.weight_at(voxel));
            if ((samples_.state[voxel] & Measurements::kLast) == 0) return;
            arrays_.set_sample(offset + pixel, samples_, voxel);
            found[pixel] = true;
        });
        const auto missing = std::ranges::mismatch(measured_, found).in1 - measured_.begin();
        if (missing == static_cast<std::ptrdiff_t>(found.size())) return;
        throw InputError(name_,
                         fmt::format("has no sample of pixel ({}, {}) in slots {} to {}; "
                                     "export others with ",
                                     missing / header_.shape.cols, missing % header_.shape.cols,
                                     first_slot, first_slot + period - 1) +
                             Parameter{"slots"});
    }

    [[nodiscard]] int measurements() const { return measurements_; }

    void finish(MeasurementExport& result) {
        result.measurements = measurements_;
        result.slots = header_.schedule.period_slots();
        arrays_.finish(result, {index(result.slots), index(result.rows), index(result.cols)});
    }

  private:
    const StreamHeader& header_;
    std::string name_;
    std::vector<bool> measured_;
    Arrays arrays_;
    Measurements samples_;
    int measurements_ = 0;
};

/// False if `progress` stops.
bool share_masks(StreamReader& stream, const StreamHeader& header, const FrameRange& slots,
                 const ProgressCallback& progress, MeasurementExport& result) {
    require_shared(header.schedule, stream.name());
    const int period = header.schedule.period_slots();
    if (slots.begin % period != 0 || slots.end.value_or(0) % period != 0)
        throw InputError(Parameter{"slots"}, fmt::format("begin and end are not multiples of the "
                                                         "period of the schedule, {} slots",
                                                         period));
    SharedMasks masks(header, stream.name());
    WindowReader reader(stream, slots.begin);
    std::int64_t first = slots.begin;
    for (; !slots.end || first < *slots.end; first += period) {
        if (!reader.read(first, first + period, progress)) break;
        masks.add_period(first, reader.packets());
    }
    if (reader.stopped()) return false;
    if (masks.measurements() == 0 || first < slots.end.value_or(0))
        throw too_short(stream, slots.end.value_or(slots.begin + period));
    masks.finish(result);
    return true;
}

/// The slots of a stream, which is read through if only its end tells.
std::int64_t count_slots(StreamReader& stream) {
    if (const auto slots = stream.slots()) return *slots;
    SamplePacket packet;
    while (stream.next(packet)) {
    }
    return stream.report().slots;
}

/// False if `progress` stops.
bool separate_masks(StreamReader& stream, const StreamHeader& header, const FrameRange& slots,
                    const ProgressCallback& progress, MeasurementExport& result) {
    const std::int64_t end = slots.end ? *slots.end : count_slots(stream);
    const std::int64_t window_slots = end - slots.begin;
    const std::size_t pixels = header.shape.pixels();
    constexpr std::uint64_t kVoxelBytes = 24;
    if (window_slots < 1) throw too_short(stream, slots.begin + 1);
    check_memory(static_cast<std::uint64_t>(window_slots) * pixels * kVoxelBytes, stream.name(),
                 fmt::format("{} slots", window_slots));
    WindowReader reader(stream, slots.begin);
    if (!reader.read(slots.begin, end, progress)) {
        if (reader.stopped()) return false;
        throw too_short(stream, end);
    }
    const Measurements samples = collect_measurements(header, reader.packets(),
                                                      {.first_slot = slots.begin,
                                                       .slots = static_cast<int>(window_slots),
                                                       .shape = header.shape});
    result.slots = samples.slots;
    result.measurements = visit_open_voxels(samples, [](int, int, std::size_t, std::size_t) {});
    if (result.measurements == 0)
        throw InputError(stream.name(),
                         fmt::format("no exposure lies within the {} slots", window_slots));
    Arrays arrays(header, index(result.measurements) * index(result.slots), stream.name());
    arrays.reserve(index(result.measurements));
    visit_open_voxels(samples, [&](int k, int slot, std::size_t pixel, std::size_t voxel) {
        arrays.set_mask((index(k) * index(result.slots) + index(slot)) * pixels + pixel,
                        samples.weight_at(voxel));
        if ((samples.state[voxel] & Measurements::kLast) != 0)
            arrays.set_sample(index(k) * pixels + pixel, samples, voxel);
    });
    arrays.finish(result, {index(result.measurements), index(result.slots), index(result.rows),
                           index(result.cols)});
    return true;
}

}  // namespace

std::optional<MeasurementExport> export_measurements(StreamReader& stream,
                                                     const ExportOptions& options,
                                                     const ProgressCallback& progress) {
    StreamHeader header = stream.header();
    if (header.shape.planes != 1)
        throw InputError(stream.name(),
                         fmt::format("has {} planes, but measurements are of one; emulate "
                                     "luminance, or a colour filter array",
                                     header.shape.planes));
    header.cfa = ColourFilter::kNone;  // the mosaic as it is
    MeasurementExport result{.arrays = {},
                             .rows = header.shape.rows,
                             .cols = header.shape.cols,
                             .first_slot = options.slots.begin,
                             .weighted = header.schedule.weighted()};
    const auto collect = options.masks == ExportMasks::kShared ? share_masks : separate_masks;
    if (!collect(stream, header, options.slots, progress, result)) return std::nullopt;
    add_numbers(header, result);
    return result;
}

void write_export(const MeasurementExport& result, PendingOutput& output) {
    const std::string where = output.final_path().string();
    OutputFile partial(output.partial(), where);
    const auto write = is_mat(where) ? write_mat : write_npz;
    write(partial, result.arrays, where);
    partial.close();
    output.commit();
}

}  // namespace stipple
