#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/image.h"
#include "io/npy_header.h"

namespace stipple {

/// Reads a .npy video frame by frame.
class NpyReader {
  public:
    /// \throws InputError as parse_npy_header, or if the file is missing or unreadable.
    explicit NpyReader(const std::filesystem::path& file);

    [[nodiscard]] FrameShape shape() const { return header_.shape; }
    [[nodiscard]] int slots() const { return header_.slots; }
    /// The type of the stored numbers.
    [[nodiscard]] SourceInfo traits() const;
    /// The file and the last frame read, for messages.
    [[nodiscard]] std::string where() const;

    /// The next frame, order (plane, row, col), integers scaled to 0..1; false at the end.
    /// \throws InputError.
    bool read(std::span<float> frame);
    /// Leaves out the next `frames` frames. \throws InputError.
    void skip(int frames);

  private:
    struct Closer {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };

    std::string name_;
    std::unique_ptr<std::FILE, Closer> file_;
    NpyHeader header_;
    int next_slot_ = 0;
    std::vector<std::byte> bytes_;
};

}  // namespace stipple
