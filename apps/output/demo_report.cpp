#include "apps/demo_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "study/explore/trial.h"
#include "study/report/quality_metrics.h"

namespace stipple {

nlohmann::ordered_json trials_json(const std::vector<TrialResult>& results) {
    auto json = nlohmann::ordered_json::array();
    for (const TrialResult& result : results) {
        nlohmann::ordered_json entry{{"name", result.name},
                                     {"schedule", result.schedule},
                                     {"text", result.text},
                                     {"compression_ratio", result.size.compression_ratio},
                                     {"payload_bits", result.size.payload_bits},
                                     {"megabits_per_second", result.size.megabits_per_second}};
        entry.update(quality_json(result.quality));
        json.push_back(entry);
    }
    return json;
}

std::string trials_table(const std::vector<TrialResult>& results) {
    constexpr auto kLine = "{:<16}{:>13}{:>9}{:>9}{:>10}{:>10}{:>10}{:>8}\n";
    const auto number = [](double value, int digits) {
        return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
    };
    std::string text = fmt::format(kLine, "", "compression", "Mbit", "Mbit/s", "PSNR dB",
                                   "gamma dB", "PU21 dB", "SSIM");
    for (const TrialResult& result : results)
        text += fmt::format(
            kLine, result.name,
            result.size.payload_bits > 0 ? number(result.size.compression_ratio, 2) + " : 1"
                                         : "no sample",
            number(static_cast<double>(result.size.payload_bits) / 1e6, 1),
            number(result.size.megabits_per_second, 1), number(result.quality.psnr_db, 2),
            number(result.quality.psnr_gamma_db, 2), number(result.quality.pu21_psnr_db, 2),
            number(result.quality.ssim, 3));
    for (const TrialResult& result : results)
        text += fmt::format("{:<16}{}\n", result.name, result.text);
    const auto read = std::ranges::find_if(
        results, [](const TrialResult& result) { return result.size.payload_bits > 0; });
    if (read != results.end())
        text += fmt::format("Every pixel read in every slot would be {:.1f} Mbit/s. ",
                            read->size.megabits_per_second * read->size.compression_ratio);
    return text + fmt::format(
                      "Light is compared up to {:.1f}.\n"
                      "\"stipple decode\" alone takes the method best, which is slower and better.",
                      kBrightestLight);
}

}  // namespace stipple
