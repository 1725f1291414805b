#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/schedule_parts.h"
#include "decoder/pixel_response.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"
#include "study/report/report_page.h"
#include "study/report/report_window.h"

namespace stipple {

/// What the readout of each slot of a stream costs.
class StreamLoads {
  public:
    /// `header` must outlive this.
    explicit StreamLoads(const StreamHeader& header) : header_(header) {}

    /// Memory grows with the slot of the packet.
    void add(const SamplePacket& packet);
    /// 1 + the last slot.
    [[nodiscard]] std::int64_t slots() const { return static_cast<std::int64_t>(flags_.size()); }

    /// By slot `samples` (in the stream), `due` (by the schedule), `payload_bits`, `overrun` and
    /// `dropped`; `full_bits`, the bits of a slot in which every pixel is read. If the provenance
    /// tells the clocks of the sensor also `clocks` (`readout_json`), else null.
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    const StreamHeader& header_;
    std::vector<std::uint64_t> samples_;
    std::vector<std::uint8_t> flags_;
};

/// The clocks of the readout of slots [0, slots): `clock_hz`, `slot_clocks` (the time there is) and
/// by slot `readout`, `convert`, `link`, `link_bits`, `limit`. Null if the provenance does not tell
/// the timing of the sensor.
[[nodiscard]] nlohmann::ordered_json readout_json(const StreamHeader& header, std::int64_t slots);

/// The rows that are read after a slot: `clock_hz`, `slot_clocks` and `rows`, each [row, select,
/// convert, end of the conversion, transfer, end of the transfer] in clocks from the beginning of
/// the slot on. Null as readout_json.
[[nodiscard]] nlohmann::ordered_json readout_lanes_json(const StreamHeader& header,
                                                        std::int64_t slot);

/// The samples of a slot in the shown area, and what a page needs to turn each into light with its
/// standard deviation: the response of each pixel (decoder/pixel_response.h).
class SlotSamples {
  public:
    /// `header` must outlive this. \throws InputError for a calibration tile of more than 4096
    /// pixels.
    SlotSamples(const StreamHeader& header, const PixelArea& area);

    /// The header of the same stream with more switches of the schedule, which must outlive this.
    void use(const StreamHeader& header);

    /// The packets of a slot come by row. \throws InputError if there are more kinds of exposures
    /// than 16 bits can tell apart.
    void add(const SamplePacket& packet);
    /// For another slot.
    void clear();
    /// Makes all kinds of exposures of the schedules known, but for those across a switch. \throws
    /// InputError as `add`.
    void add_kinds();

    /// For each pixel 0, or 1 + the kind of the exposure that is read at the end of the slot.
    [[nodiscard]] std::span<const std::uint16_t> kinds() const { return kinds_; }
    /// The DN of the pixels that are read, pixel by pixel and plane by plane.
    [[nodiscard]] std::span<const std::uint16_t> dn() const { return dn_; }
    /// `exposures`: the kinds of exposures so far, each `span_slots`, `light_slots`, `open`, the
    /// runs of open slots as [first, slots], and `readout`, which of the `responses` it has;
    /// `response_rows`, `response_cols` and `responses`: for each readout, which a switch may
    /// change, and each pixel of the calibration tile `response_json` by light slots.
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    struct Kind {
        std::uint64_t open_slots;
        std::size_t readout;
    };
    struct Readout {
        ReadoutValues values;
        std::unordered_map<std::uint64_t, std::uint16_t> kinds;  ///< by open slots
    };
    struct PacketPart {
        std::size_t part;     ///< of parts_
        std::size_t readout;  ///< of readouts_
    };
    void add_row(const SamplePacket& packet, const PacketPart& of, int row,
                 const std::uint16_t*& dn);
    [[nodiscard]] std::uint16_t kind_of(std::uint64_t open_slots, std::size_t readout);
    /// Open slots of what is read at the end of a slot; nothing if it began in an unknown part.
    [[nodiscard]] std::optional<std::uint64_t> exposure_at(std::size_t part, const PixelSlot& at,
                                                           int span_slots) const;
    [[nodiscard]] std::size_t readout_of(const SchedulePart& part);

    const StreamHeader* header_;
    PixelArea area_;
    std::vector<SchedulePart> parts_;
    std::vector<Kind> all_kinds_;
    std::vector<Readout> readouts_;
    std::vector<std::uint16_t> kinds_;
    std::vector<std::uint16_t> dn_;
};

/// The samples of a stream in the shown area, packed for the page.
class StreamSamples {
  public:
    /// As SlotSamples.
    StreamSamples(const StreamHeader& header, const PixelArea& area)
        : step_(static_cast<std::size_t>(header.shape.planes)), samples_(header, area) {}

    /// Packets come as a StreamReader reads them: by slot, then by row. \throws InputError as
    /// SlotSamples.
    void add(const SamplePacket& packet);
    /// To be called after the last packet.
    void finish();

    /// As SlotSamples.
    [[nodiscard]] nlohmann::ordered_json json() const { return samples_.json(); }
    /// For each slot with samples "k-SLOT", its kinds, and "d-SLOT", its DN.
    [[nodiscard]] const std::vector<PackedPlane>& planes() const { return planes_; }
    /// Of the planes in the page.
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

  private:
    std::size_t step_;  ///< planes of the sensor
    SlotSamples samples_;
    std::int64_t slot_ = 0;  ///< of the samples that are not yet packed
    std::vector<PackedPlane> planes_;
    std::size_t bytes_ = 0;
};

/// The coefficients of light and noise of a pixel whose exposure was open for `light_slots`:
/// `light` = `zero` + `per_dn` DN below `saturated_dn`, from there on `bound`, a lower bound, all
/// of the whole exposure in units of FluxVideo; its variance is `dark_variance` +
/// `variance_per_light` max(light, 0).
[[nodiscard]] nlohmann::ordered_json response_json(const PixelResponse& response, int bit_depth,
                                                   int light_slots);

}  // namespace stipple
