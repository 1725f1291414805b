#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "apps/shared_folder.h"
#include "stream/stream_header.h"

namespace stipple {

/// A folder with a stream in pieces of kPieceSlots slots, each a complete file
/// `piece_000000.stipple` or absent. A piece is a stream that lacks the slots before it.
/// `emulation.json` holds the identity: the provenance, line by line, and the CRC of the header.
class PieceFolder {
  public:
    /// Makes the folder if it is missing. `count_slots` is called if nobody has counted the slots
    /// of the footage yet. \throws as claim_folder and `count_slots`.
    PieceFolder(std::filesystem::path folder, const StreamHeader& header,
                const std::function<std::int64_t()>& count_slots);
    /// Opens the folder of an emulation. \throws InputError if it is none, or of another version.
    explicit PieceFolder(std::filesystem::path folder);

    [[nodiscard]] std::int64_t slots() const { return slots_; }
    /// The slots of a piece: [begin_slot, end_slot).
    [[nodiscard]] std::int64_t begin_slot(std::int64_t number) const;
    [[nodiscard]] std::int64_t end_slot(std::int64_t number) const;
    /// The file of a piece.
    [[nodiscard]] std::filesystem::path piece(std::int64_t number) const;
    /// All of them, while this object lives.
    [[nodiscard]] NumberedParts pieces() const;

  private:
    [[nodiscard]] bool holds(std::int64_t number) const;

    std::filesystem::path folder_;
    std::uint32_t header_crc_ = 0;
    std::int64_t slots_ = 0;
};

/// Slots of a piece: some megabytes of VGA.
inline constexpr std::int64_t kPieceSlots = 64;

/// Whether a folder holds pieces.
[[nodiscard]] bool is_piece_folder(const std::filesystem::path& folder);

}  // namespace stipple
