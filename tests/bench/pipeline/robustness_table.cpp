// What faults of a recording cost: PSNR lost (dB, linear / after 1/2.2) on three clips of the
// footage folder, 256 x 256, 32 slots: the table of docs/notes/robustness.md. `bench_robustness
// [METHOD]` (fast).
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "core/error.h"
#include "decoder/reconstruct.h"
#include "decoder/schedule_check/schedule_check.h"
#include "readout/coded_sensor.h"
#include "readout/schedules/tiled_schedule.h"
#include "stream/stream_writer.h"
#include "study/metrics/video_quality.h"
#include "tests/pipeline/clip.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr int kBandRows = 16;  ///< a packet holds a sixteenth of a slot
constexpr double kBrightest = 2;

/// A recording on its way to the decoder, and what the decoder is told of it.
struct Case {
    StreamHeader header;
    std::vector<SamplePacket> packets;
    std::vector<bool> lost;  ///< by packet
};

using Fault = std::function<void(Case&)>;

/// Cuts the packet of a slot into bands of rows.
void add_bands(const SamplePacket& whole, const StreamHeader& header,
               std::vector<SamplePacket>& bands) {
    auto dn = whole.dn.begin();
    for (int row = 0; row < header.shape.rows; row += kBandRows) {
        const int rows = std::min(kBandRows, header.shape.rows - row);
        const auto count = static_cast<std::ptrdiff_t>(
            count_due(header.schedule, whole.slot, row, rows, header.shape.cols));
        bands.push_back({whole.slot, row, rows, 0, {dn, dn + count}});
        dn += count;
    }
}

Case record(const FluxVideo& video, const ExposureSchedule& schedule) {
    const SensorParams params;
    Case result{{.shape = video.shape(),
                 .slot_us = params.slot_us,
                 .calibration = calibration_of(params),
                 .schedule = schedule,
                 .schedule_source = {},
                 .schedule_name = "robustness",
                 .provenance = ""},
                {},
                {}};
    CodedSensor sensor(params, video.shape(), schedule, 1);
    SamplePacket packet;
    for (int slot = 0; slot < video.slots(); ++slot) {
        sensor.expose(video.frame(slot), packet);
        add_bands(packet, result.header, result.packets);
    }
    result.lost.assign(result.packets.size(), false);
    return result;
}

/// Loses about `fraction` of the packets, in runs of `burst`.
Fault lose(double fraction, std::size_t burst) {
    return [=](Case& recording) {
        std::mt19937 random(1);
        const auto wanted = static_cast<std::size_t>(
            std::max(1.0, fraction * static_cast<double>(recording.lost.size()) + 0.5));
        std::size_t lost = 0;
        while (lost < wanted) {
            const std::size_t begin = random() % (recording.lost.size() - burst + 1);
            for (std::size_t i = begin; i < begin + std::min(burst, wanted - lost); ++i)
                recording.lost[i] = true;
            lost = static_cast<std::size_t>(
                std::count(recording.lost.begin(), recording.lost.end(), true));
        }
    };
}

/// Changes samples by their place: `change(row, col, dn)`.
Fault change(const std::function<void(int, int, std::uint16_t&)>& change_dn) {
    return [=](Case& recording) {
        for (SamplePacket& packet : recording.packets) {
            auto dn = packet.dn.begin();
            for (int row = packet.first_row; row < packet.first_row + packet.rows; ++row)
                for_each_readout(recording.header.schedule, packet.slot, row,
                                 recording.header.shape.cols,
                                 [&](int col, int) { change_dn(row, col, *dn++); });
        }
    };
}

Fault hot_pixels(double fraction) {
    return change([=](int row, int col, std::uint16_t& dn) {
        std::mt19937 random(static_cast<std::uint32_t>(row * 65536 + col));
        random.discard(10);
        if (static_cast<double>(random()) < fraction * 4294967296.0) dn = 255;
    });
}

Fault wrong_header(const std::function<void(Calibration&)>& change_calibration) {
    return [=](Case& recording) { change_calibration(recording.header.calibration); };
}

Fault wrong_schedule(const ScheduleShift& shift) {
    return [=](Case& recording) {
        recording.header.schedule = shifted_schedule(recording.header.schedule, shift);
    };
}

/// Writes the packets that are left. The writer would insist on all, so the lost ones are cut out.
void write_stream(const Case& recording, const ExposureSchedule& run,
                  const std::filesystem::path& file) {
    StreamHeader header = recording.header;
    header.schedule = run;  // what the writer checks the packets against
    std::vector<std::uint64_t> begins;
    {
        StreamWriter writer(file, header);
        for (const SamplePacket& packet : recording.packets) {
            begins.push_back(writer.bytes_written());
            writer.write(packet);
        }
        begins.push_back(writer.bytes_written());
        writer.finish();
    }
    const std::string bytes = read_text(file);
    std::string kept = bytes.substr(0, begins.front());
    for (std::size_t i = 0; i < recording.packets.size(); ++i)
        if (!recording.lost[i]) kept += bytes.substr(begins[i], begins[i + 1] - begins[i]);
    write_text(file, kept + bytes.substr(begins.back()));
}

VideoQuality quality_with(const FluxVideo& video, const ExposureSchedule& schedule,
                          const Fault& fault, DecodeMethod method) {
    Case recording = record(video, schedule);
    fault(recording);
    const TemporaryFolder folder;
    write_stream(recording, schedule, folder / "clip.stipple");
    StreamReader reader(folder / "clip.stipple");
    reader.use_schedule(recording.header.schedule);
    QualityMeter meter(video.shape(), {.margin = 4, .max_value = kBrightest});
    const FluxVideo nothing(1, video.shape());
    std::int64_t frames = decode(reader, method, [&](std::int64_t slot, std::span<const float> f) {
                              meter.add(f, video.frame(static_cast<int>(slot)));
                              return true;
                          }).slots;
    for (; frames < video.slots(); ++frames)
        meter.add(nothing.frame(0), video.frame(static_cast<int>(frames)));
    return meter.quality();
}

struct Row {
    std::string name;
    Fault fault;
};

std::vector<Row> faults() {
    std::vector<Row> rows;
    for (const double fraction : {0.001, 0.01, 0.1})
        rows.push_back({fmt::format("{:g} % of the packets lost, each by itself", 100 * fraction),
                        lose(fraction, 1)});
    for (const double fraction : {0.001, 0.01, 0.1})
        rows.push_back(
            {fmt::format("{:g} % lost in bursts of 32 packets (two slots)", 100 * fraction),
             lose(fraction, 32)});
    rows.push_back({"a dead column, which reads 0",
                    change([](int, int col, std::uint16_t& dn) { dn = col == 128 ? 0 : dn; })});
    for (const double fraction : {0.0001, 0.001, 0.01})
        rows.push_back({fmt::format("{:g} % hot pixels, which read full scale", 100 * fraction),
                        hot_pixels(fraction)});
    for (const double factor : {0.8, 1.2}) {
        rows.push_back({fmt::format("read noise in the header x {:g}", factor),
                        wrong_header([=](Calibration& c) { c.read_noise_e *= factor; })});
        rows.push_back({fmt::format("gain in the header x {:g}", factor),
                        wrong_header([=](Calibration& c) { c.gain_e_per_dn *= factor; })});
    }
    rows.push_back({"schedule off by one slot", wrong_schedule({1, 0, 0})});
    rows.push_back({"schedule off by one row", wrong_schedule({0, 1, 0})});
    rows.push_back({"schedule off by one column", wrong_schedule({0, 0, 1})});
    return rows;
}

void print_table(const std::string& name, const std::string& wanted) {
    const DecodeMethod method = decode_method_from_name(name);
    const ExposureSchedule schedule = tiled_schedule(16, 16, kPaperExposureSlots, 1);
    std::vector<FluxVideo> clips;
    std::vector<VideoQuality> intact;
    std::string head = fmt::format("| {} |", name);
    std::string first = "| intact, PSNR |";
    for (const char* clip : {"mouse250_a", "nat30_coffee", "hdr_desk"}) {
        auto video = luminance_clip(clip);
        if (!video) throw InputError(clip, "is not in the footage folder");
        clips.push_back(std::move(*video));
        intact.push_back(quality_with(
            clips.back(), schedule, [](Case&) {}, method));
        head += fmt::format(" {} |", clip);
        first +=
            fmt::format(" {:.2f}/{:.2f} |", intact.back().psnr_db, intact.back().psnr_gamma_db);
    }
    fmt::print("{}\n|---|---|---|---|\n{}\n", head, first);
    for (const Row& row : faults()) {
        if (row.name.find(wanted) == std::string::npos) continue;
        fmt::print("| {} |", row.name);
        for (std::size_t i = 0; i < clips.size(); ++i) {
            const VideoQuality quality = quality_with(clips[i], schedule, row.fault, method);
            fmt::print(" {:.2f}/{:.2f} |", intact[i].psnr_db - quality.psnr_db,
                       intact[i].psnr_gamma_db - quality.psnr_gamma_db);
            std::fflush(stdout);
        }
        fmt::print("\n");
    }
}

}  // namespace
}  // namespace stipple

int main(int argc, char** argv) {
    try {
        stipple::print_table(argc > 1 ? argv[1] : "fast", argc > 2 ? argv[2] : "");
    } catch (const std::exception& e) {
        fmt::print(stderr, "bench_robustness: {}\n", e.what());
        return 1;
    }
    return 0;
}
