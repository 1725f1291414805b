#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "python/stream_samples.h"
#include "stream/stream_reader.h"

namespace stipple::python {

/// A file in a new folder for temporary files. Both go with it, or before, by `unname`.
class TemporaryFile {
  public:
    /// \throws DeviceError.
    TemporaryFile();
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    /// Where it is to be written, and from `unname` on where it can be read.
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// Takes its name away, so that nothing is left even where the process is killed.
    /// \throws DeviceError. Precondition: the file is there.
    void unname();

  private:
    std::filesystem::path folder_;
    std::filesystem::path path_;
    int descriptor_ = -1;
};

/// A sample stream, in a file of the user or a temporary one, of which Python reads what it wants.
class StreamFile {
  public:
    /// \throws InputError as StreamReader, FileError.
    explicit StreamFile(std::filesystem::path file, pybind11::object figures = pybind11::none());
    StreamFile(std::unique_ptr<TemporaryFile> file, pybind11::object figures);

    /// A reader at its beginning.
    [[nodiscard]] StreamReader reader(ReadPolicy policy = ReadPolicy::kTolerant) const;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] bool is_temporary() const { return is_temporary_; }
    /// Its path, by which other processes can open it. \throws InputError of a temporary file.
    [[nodiscard]] std::filesystem::path saved_path() const;
    /// For messages.
    [[nodiscard]] std::string name() const;
    /// \throws InputError if it is closed, as all that follows but `figures`.
    [[nodiscard]] const StreamHeader& header() const { return opened().header(); }

    /// Of its emulation, a dict; None if it was opened.
    [[nodiscard]] const pybind11::object& figures() const { return figures_; }

    /// Counts and damage of the whole stream. Releases the GIL meanwhile.
    [[nodiscard]] StreamReport read_through() const;
    /// Slots that it holds. Reads it through, once, where no index says so.
    [[nodiscard]] std::int64_t slots();
    /// The samples of a slot: an array of SampleRow. \throws IndexError for a slot that there is
    /// not.
    [[nodiscard]] pybind11::array samples(std::int64_t slot);
    /// Those of the slots [begin, end), by slot. \throws IndexError; InputError as check_memory.
    [[nodiscard]] pybind11::array samples_between(std::int64_t begin, std::int64_t end);
    /// Copies it to a file. \throws FileError, DeviceError.
    void save(const std::filesystem::path& file, bool force) const;

    [[nodiscard]] bool is_open() const { return reader_.has_value(); }
    /// Deletes a temporary file.
    void close();

  private:
    [[nodiscard]] const StreamReader& opened() const;
    bool advance();

    std::unique_ptr<TemporaryFile> temporary_;
    bool is_temporary_;
    std::filesystem::path path_;
    pybind11::object figures_;
    std::optional<StreamReader> reader_;  ///< until it is closed
    SamplePacket packet_;                 ///< that `reader_` has read last
    bool has_packet_ = false;             ///< else `reader_` has read none, or is at the end
    std::optional<std::int64_t> slots_;
};

/// Header and counts of a stream that was read: the keys of `info` in docs/outputs.md.
[[nodiscard]] pybind11::dict header_dict(const StreamHeader& header);

}  // namespace stipple::python
