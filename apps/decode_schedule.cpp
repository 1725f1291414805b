#include "apps/decode.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/interrupt.h"
#include "apps/standard_streams.h"
#include "core/error.h"
#include "study/report/json_figures.h"

namespace stipple {
namespace {

using Verdict = ScheduleCheck::Verdict;

std::string residual_text(const std::optional<double>& residual) {
    return residual ? fmt::format("{:.3f}", *residual) : "none";
}

/// The residuals of the schedule in the header and of others.
std::string evidence(const ScheduleCheck& check) {
    if (check.tried == 0) return "the recording is too short";
    if (!check.best_residual && check.possible > 0)
        return "all of its samples are saturated, or too few";
    const std::string header =
        check.header_residual
            ? fmt::format("residual of the header's schedule {:.3f}", *check.header_residual)
            : "the numbers of samples contradict the header's schedule";
    return fmt::format("{}, best {}, median {}; {} shifts tried, {} possible", header,
                       residual_text(check.best_residual), residual_text(check.median_residual),
                       check.tried, check.possible);
}

std::string shift_text(const ScheduleShift& shift) {
    return fmt::format("{:+} slots, {:+} rows, {:+} columns", shift.slots, shift.rows, shift.cols);
}

}  // namespace

ScheduleCheck checked_schedule(StreamReader& reader, const DecodeArguments& arguments,
                               const RunOptions& run) {
    if (!std::filesystem::is_regular_file(arguments.stream))
        throw InputError(arguments.stream,
                         "cannot be read twice, as --check-schedule needs; record to a file first");
    const ScheduleCheck check = check_schedule(reader);
    throw_if_stopped();
    const std::string why = evidence(check);
    switch (check.verdict) {
        case Verdict::kAgrees:
            run.say(fmt::format("{}: the samples follow the schedule ({})", arguments.stream, why));
            break;
        case Verdict::kCannotTell:
            say_warning(
                "{}: cannot tell whether the samples follow the schedule, decoding "
                "as the header says ({})",
                arguments.stream, why);
            break;
        case Verdict::kShifted:
            if (arguments.check_schedule == CheckSchedule::kRefuseShift)
                throw InputError(arguments.stream,
                                 fmt::format("the samples follow the schedule shifted by {} ({}); "
                                             "--check-schedule=fix decodes with this shift",
                                             shift_text(check.shift), why));
            run.say(fmt::format("{}: decoding with the schedule shifted by {} ({})",
                                arguments.stream, shift_text(check.shift), why));
            break;
        case Verdict::kNoneFits:
            throw InputError(arguments.stream,
                             fmt::format("the samples do not follow the schedule, and no shift of "
                                         "it clearly fits ({}); store the schedule that the chip "
                                         "ran in the header",
                                         why));
    }
    return check;
}

nlohmann::ordered_json check_json(const ScheduleCheck& check) {
    static constexpr const char* kVerdicts[] = {"agrees", "shifted", "cannot_tell", "none_fits"};
    return {{"verdict", kVerdicts[static_cast<std::size_t>(check.verdict)]},
            {"slot_shift", check.shift.slots},
            {"row_shift", check.shift.rows},
            {"col_shift", check.shift.cols},
            {"header_residual", or_null(check.header_residual)},
            {"best_residual", or_null(check.best_residual)},
            {"median_residual", or_null(check.median_residual)},
            {"tried", check.tried},
            {"possible", check.possible}};
}

}  // namespace stipple
