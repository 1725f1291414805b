#include "io/footage_warnings.h"

#include <fmt/format.h>

#include <numeric>
#include <utility>

#include "core/error.h"

namespace stipple {

Transfer transfer_of(const FootageOptions& options, const SourceInfo& traits, bool is_video,
                     const std::string& name) {
    if (options.transfer != Transfer::kAuto) return options.transfer.value_or(Transfer::kLinear);
    if (traits.declared) return *traits.declared;
    if (traits.gamma_coded && (is_video || !traits.curve.empty()))
        throw InputError(name, traits.curve.empty()
                                   ? "declares no transfer function, so " +
                                         Parameter{"transfer", "auto"} + " has none; name it, as " +
                                         Parameter{"transfer", "bt709"} + " of most cameras"
                                   : Message("declares the transfer function " + traits.curve +
                                             ", which is not known; convert it first, e.g. by "
                                             "ffmpeg"));
    return traits.gamma_coded ? Transfer::kSrgb : Transfer::kLinear;
}

std::vector<Message> reading_warnings(const SourceInfo& traits, const FootageOptions& options,
                                      const std::string& name) {
    std::vector<Message> warnings;
    const Transfer transfer = options.transfer.value_or(Transfer::kLinear);
    const bool hdr = traits.declared == Transfer::kPq || traits.declared == Transfer::kHlg;
    if (hdr && transfer != Transfer::kAuto && transfer != traits.declared)
        warnings.push_back(fmt::format("{}: is HDR in the curve {}: add ", name, traits.curve) +
                           Parameter{"transfer", std::string(name_of(*traits.declared))});
    else if (traits.gamma_coded && !options.transfer)
        warnings.push_back(name + ": looks gamma-coded: add " + Parameter{"transfer", "srgb"} +
                           ", or " + Parameter{"transfer", "linear"} +
                           " if its numbers are linear light");
    if (traits.floating && transfer != Transfer::kLinear && transfer != Transfer::kAuto)
        warnings.push_back(name +
                           ": holds floating-point numbers, which are linear light as a rule; " +
                           Parameter{"transfer", std::string(name_of(transfer))} + " bends them");
    constexpr double kMicrosecondsPerSecond = 1e6;
    const double period_us = kMicrosecondsPerSecond / traits.frames_hz.value_or(0);
    if (traits.frames_hz && traits.exposure_us && *traits.exposure_us < period_us / 2)
        warnings.push_back(
            fmt::format("{}: its frames were exposed for {:.4g} of {:.4g} us each; "
                        "the light of the time between is not in them",
                        name, *traits.exposure_us, period_us));
    const auto used = transfer == Transfer::kAuto ? traits.declared : transfer;
    const bool converted = traits.bt2020 && (used == Transfer::kPq || used == Transfer::kHlg);
    if (!traits.primaries.empty() && !converted)
        warnings.push_back(
            fmt::format("{}: declares the primaries {}, which are not converted to those of Rec. "
                        "709; convert it first, as video by ffmpeg -vf colorspace=bt709",
                        name, traits.primaries));
    if (Message text = unequal_times_warning(traits.unequal_times, options, name); !text.empty())
        warnings.push_back(std::move(text));
    for (const Message& text : traits.warnings) warnings.push_back(name + ": " + text);
    if (traits.has_alpha) warnings.emplace_back(name + ": its alpha channel is left out");
    return warnings;
}

Message unequal_times_warning(const std::string& apart, const FootageOptions& options,
                              const std::string& name) {
    if (apart.empty() || (options.at_their_times && !options.frames_hz)) return {};
    const Message remedy = options.at_their_times
                               ? Parameter{"frames_hz"} + " makes them equally long"
                               : "each becomes one slot; " + Parameter{"resample", "blend"} +
                                     " puts them at their times";
    return fmt::format("{}: its frames are {}, but ", name, apart) + remedy;
}

std::string brightness_warning(std::span<const float> light, const std::string& where) {
    constexpr double kFarAboveOne = 10;
    const double mean =
        std::accumulate(light.begin(), light.end(), 0.0) / static_cast<double>(light.size());
    if (!(mean > kFarAboveOne)) return {};
    return fmt::format(
        "{}: the mean light is {:.3g}, where the brightest of integers is 1.0; divide "
        "digital numbers by their full scale first",
        where, mean);
}

}  // namespace stipple
