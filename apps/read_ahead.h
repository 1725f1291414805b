#pragma once

#include <future>
#include <optional>
#include <span>
#include <vector>

#include "core/footage_reader.h"

namespace stipple {

/// Footage whose next frame is read in the background while one is worked on.
class ReadAhead {
  public:
    /// \throws InputError as FootageReader.
    ReadAhead(const std::filesystem::path& source, const FootageOptions& options);
    ~ReadAhead() = default;
    ReadAhead(const ReadAhead&) = delete;
    ReadAhead& operator=(const ReadAhead&) = delete;

    [[nodiscard]] FrameShape shape() const { return reader_.shape(); }
    [[nodiscard]] std::optional<int> slots() const { return reader_.slots(); }

    /// The next frame, valid until the next call, or an empty span at the end.
    /// \throws InputError as FootageReader::read.
    std::span<const float> next();

  private:
    void start_reading();

    FootageReader reader_;
    std::vector<float> current_;
    std::vector<float> coming_;
    std::future<bool> reading_;  ///< last: waits for the reader before its memory goes
};

}  // namespace stipple
