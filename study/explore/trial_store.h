#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/explore/trial.h"

namespace stipple {

/// The folder of results: a table, a page, and for each trial its figures and its picture, named
/// after the hash of all that determines it.
class TrialStore {
  public:
    /// Makes the folder if it is missing. \throws InputError if it holds something else, a link or
    /// the results of another version, DeviceError if it cannot be written.
    explicit TrialStore(std::filesystem::path folder);

    /// The figures of a trial that was run before; nothing if its file is damaged.
    [[nodiscard]] std::optional<TrialFigures> find(const std::string& identity) const;
    /// The name of a trial: the first 64 bits of the SHA-256 of its identity, in hexadecimal.
    [[nodiscard]] static std::string address_of(const std::string& identity);
    /// The PNG file of the picture of a trial; empty if there is none.
    [[nodiscard]] std::vector<std::uint8_t> picture(const std::string& address) const;
    /// For the stream of a trial while it runs.
    [[nodiscard]] std::filesystem::path stream_of(const std::string& identity) const;

    /// \throws DeviceError.
    void store(const std::string& identity, const TrialOutcome& outcome) const;
    /// Writes the file `name`, whatever it was before. \throws DeviceError.
    void write(const std::string& name, std::string_view text) const;

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  private:
    [[nodiscard]] std::filesystem::path path(const std::string& address,
                                             std::string_view extension) const;

    std::filesystem::path folder_;
};

}  // namespace stipple
