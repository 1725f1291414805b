#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace stipple {

/// A share of the work: `number` of `count`, which begin at 1.
struct Shard {
    std::int64_t number = 0;
    std::int64_t count = 0;  ///< 0: all in one run
};

/// Files [begin, end), which are numbered from 0.
struct NumberRange {
    std::int64_t begin = 0;
    std::int64_t end = 0;
};

/// The files of a shard, of `count` files in all. Shards have equal numbers, except for one.
[[nodiscard]] NumberRange range_of(const Shard& shard, std::int64_t count);

/// Numbers that rise, consecutive ones together.
[[nodiscard]] std::vector<NumberRange> ranges_of(const std::vector<std::int64_t>& numbers);

/// Kind of a folder that several runs fill with the parts of one result. A file in it, the
/// identity, holds all that determines the result, so that no part of another one gets in.
struct ShardFolderKind {
    const char* identity;  ///< name of the file
    const char* article;   ///< of the result
    const char* result;    ///< "decoding"
    const char* verb;      ///< "decode"
    const char* parts;     ///< "windows"
};

inline constexpr ShardFolderKind kDecodingFolder{"decoding.json", "a", "decoding", "decode",
                                                 "windows"};
inline constexpr ShardFolderKind kEmulationFolder{"emulation.json", "an", "emulation", "emulate",
                                                  "pieces"};

/// The parts of a folder, numbered from 0: their files, and whether a file is there and complete.
struct NumberedFiles {
    std::int64_t count = 0;
    std::function<std::filesystem::path(std::int64_t)> file;
    std::function<bool(std::int64_t)> holds;

    /// Those of a range that are not there.
    [[nodiscard]] std::vector<std::int64_t> missing(const NumberRange& range) const;
    /// \throws InputError naming the files that are missing.
    void require_all(const std::filesystem::path& folder, const ShardFolderKind& kind) const;
};

}  // namespace stipple
