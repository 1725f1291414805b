#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/arguments/common_options.h"
#include "apps/arguments/footage.h"
#include "apps/arguments/sensor.h"
#include "apps/emulate.h"
#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/standard_streams.h"
#include "apps/subcommands.h"
#include "core/error.h"
#include "io/image_file.h"
#include "io/output_names.h"
#include "readout/chip/register_chip.h"
#include "readout/chip/register_map.h"
#include "readout/chip_registers.h"

namespace stipple {
namespace {

struct ChipArguments {
    EmulateArguments emulation;  ///< footage, sensor and output
    bool blank = false;
    FrameShape tile{.rows = 0, .cols = 0, .planes = 1};  ///< 0: that of the schedule
    int depth = 0;                                       ///< 0: at least 16
    int pixel_bits = 0;                                  ///< 0: those of the schedule
};

/// Lines of standard input, up to its end or a signal.
class RequestLines {
  public:
    /// Without the end of the line.
    std::optional<std::string> next() {
        while (true) {
            if (const std::size_t end = text_.find('\n'); end != std::string::npos) {
                std::string line = text_.substr(0, end);
                text_.erase(0, end + 1);
                return line;
            }
            if (text_.size() > kLongest) return std::exchange(text_, {});
            if (!read_more()) return std::nullopt;
        }
    }

  private:
    static constexpr std::size_t kLongest = 1000;

    bool read_more() {
        std::array<char, 4096> bytes{};
        ssize_t count = -1;
        do {
            if (stop_signal() != 0) return false;
            count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
        } while (count < 0 && errno == EINTR);
        if (count <= 0) return false;
        text_.append(bytes.data(), static_cast<std::size_t>(count));
        return true;
    }

    std::string text_;
};

std::vector<std::string> words_of(std::string_view line) {
    constexpr std::string_view kBlanks = " \t\r";
    std::vector<std::string> words;
    for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;
         at = line.find_first_not_of(kBlanks, at)) {
        const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
        words.emplace_back(line.substr(at, end - at));
        at = end;
    }
    return words;
}

/// In steps between which a signal ends it.
void wait(RegisterChip& chip, std::int64_t clocks) {
    constexpr std::int64_t kStep = 4096;
    for (; clocks > 0 && stop_signal() == 0; clocks -= kStep) chip.wait(std::min(clocks, kStep));
}

struct Request {
    char kind = 't';            ///< r, w or t
    std::uint32_t address = 0;  ///< of r and w
    std::uint32_t value = 0;    ///< of w and t
};

/// \throws InputError if a line is none.
Request request_of(const std::vector<std::string>& words) {
    if (words.size() == 2 && words[0] == "r")
        return {.kind = 'r', .address = register_address(words[1])};
    if (words.size() == 3 && words[0] == "w")
        return {'w', register_address(words[1]), register_value(words[2])};
    if (words.size() == 2 && words[0] == "t") return {.value = register_value(words[1])};
    throw InputError("request", "is not r REGISTER, w REGISTER VALUE or t CLOCKS");
}

/// The answer to a request. \throws InputError, DeviceError as RegisterChip.
std::string answer_to(const Request& request, RegisterChip& chip) {
    if (request.kind == 't') {
        wait(chip, request.value);
        return "ok";
    }
    std::optional<std::uint32_t> value;
    if (request.kind == 'r')
        value = chip.read(request.address);
    else if (chip.write(request.address, request.value))
        return "ok";
    return value ? fmt::format("0x{:08X}", *value) : "error " + chip.take_problem();
}

void serve(RegisterChip& chip) {
    RequestLines lines;
    while (const auto line = lines.next()) {
        std::optional<Request> request;
        std::string answer;
        try {
            request = request_of(words_of(*line));
        } catch (const InputError& e) {
            answer = fmt::format("error {}", e.what());
        }
        if (request) answer = answer_to(*request, chip);
        print_text(terminal_text(answer) + "\n");
        flush_output();
        say_warning(chip.take_problem());
    }
}

ChipGeometry geometry_for(const ChipArguments& arguments, const SensorSetup& setup) {
    ChipGeometry geometry = geometry_of(setup);
    if (arguments.tile.rows > 0) {
        geometry.tile_rows = arguments.tile.rows;
        geometry.tile_cols = arguments.tile.cols;
    }
    if (arguments.depth > 0) geometry.depth = arguments.depth;
    if (arguments.pixel_bits > 0) geometry.pixel_bits = arguments.pixel_bits;
    return geometry;
}

/// The footage from its first frame on.
OpenLight light_of(const EmulationSource& source, double slot_us) {
    struct Reading {
        ReadAhead footage;
        ResampledFootage slots;
        Reading(const EmulationSource& source, double slot_us)
            : footage(source.open([](const Message&) {})),
              slots(source.slots_of(footage, slot_us)) {}
    };
    return [&source, slot_us]() -> SlotLight {
        return [reading = std::make_shared<Reading>(source, slot_us)] {
            return reading->slots.next();
        };
    };
}

void run_chip(const ChipArguments& arguments, const RunOptions& run) {
    const EmulateArguments& emulation = arguments.emulation;
    const SensorSetup setup = EmulationInput(emulation).setup();
    const ChipGeometry geometry = geometry_for(arguments, setup);
    JsonFile json(run);
    RegisterChip chip(setup, geometry,
                      {.output = emulation.output,
                       .force = run.force,
                       .footage = emulation.source.origin([] { throw_if_stopped(); }),
                       .open_light = light_of(emulation.source, setup.params.slot_us)});
    if (!arguments.blank) chip.preset();
    serve(chip);
    chip.finish();
    say_warning(chip.take_problem());
    nlohmann::ordered_json captures = nlohmann::ordered_json::array();
    for (const auto& file : chip.outputs()) captures.push_back(file.string());
    json.write({{"clocks", chip.clocks()}, {"captures", captures}});
}

void add_geometry(Command& command, ChipArguments& arguments) {
    command.add_flag("--blank", arguments.blank,
                     "begin as after a reset, with nothing set but what the chip is; else the "
                     "registers and bank 0 are those of sensor and schedule");
    add_size(command, "--tile", arguments.tile, {1, kMaxTileSide}, "tile of the schedule memory")
        .default_text("that of the schedule");
    command.add_option("--depth", arguments.depth, "slots of a bank of the schedule memory")
        .default_text("the schedule's, at least 16")
        .check(whole_check(1, kMaxPeriodSlots))
        .type_name("N");
    command.add_option("--pixel-bits", arguments.pixel_bits, "bits of a pixel in the memory")
        .default_text("those of the schedule")
        .check(whole_check(1, 3))
        .type_name("N");
}

}  // namespace

void add_chip(Command& app, Action& action) {
    Command command = app.add_command("chip", "An emulated chip that is driven through registers");
    const auto options = std::make_shared<ChipArguments>();
    EmulateArguments& emulation = options->emulation;
    command
        .add_option("FOOTAGE", emulation.source.footage,
                    fmt::format("its light, as of \"emulate\": folder or printf pattern of {}, "
                                "video or camera file, .npy; each capture begins with its first "
                                "frame, and after the last one it begins again",
                                image_format_names()))
        .required()
        .input();
    add_output(command, emulation.output,
               "sample stream of the first capture; the next ones are NAME-2, NAME-3, ...",
               kStreamName);
    add_sensor_arguments(command, emulation.sensor);
    add_settings(command, sensor_sections(emulation.sensor),
                 "change a key of the sensor or of the schedule");
    add_geometry(command, *options);
    add_footage_arguments(command, emulation.source.reading);
    add_part_arguments(command, emulation.source.reading);
    add_resample_arguments(command, emulation.source.resampling, emulation.source.reading);
    add_max_value(command, emulation.source.reading.max_value);
    add_threads(command, action.options);
    command.footer(
        "Each line of standard input is a request, and each is answered by a line:\n"
        "  r REGISTER        its value, such as 0x53504C31\n"
        "  w REGISTER VALUE  ok\n"
        "  t CLOCKS          ok, after so many clocks\n"
        "or by \"error TEXT\". REGISTER is a name of docs/chip_registers.md, such as STATUS or\n"
        "BANK_PERIOD[1], or an address. See docs/chip.md.\n"
        "Examples:\n"
        "  printf 'w SLOTS 1\\nw CONTROL 1\\nt 100000\\nr STATUS\\n' |\n"
        "      stipple chip light.npy -o shot.stipple --sensor lux1310 --schedule tiled\n"
        "  firmware -- stipple chip light.npy -o clip.stipple --sensor chip.toml --blank");
    set_action(command, action, options, run_chip, [&action, options] {
        options->emulation.source.reading.at_their_times =
            options->emulation.source.resampling.has_value();
        if (action.options.json == "-")
            throw UsageError("--json", "standard output is for the answers; name a file");
    });
}

}  // namespace stipple
