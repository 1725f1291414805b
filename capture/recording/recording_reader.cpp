#include "capture/recording/recording_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "capture/frame_payload.h"
#include "core/error.h"
#include "stream/buffered_reader.h"
#include "stream/crc32c.h"
#include "stream/little_endian.h"

namespace stipple {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kSearchBytes = std::size_t{1} << 18U;

std::string_view text_of(Bytes bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Offset in `bytes` of the first good block header from `from` on; nothing if there is none.
std::optional<std::size_t> find_block(Bytes bytes, std::size_t from) {
    for (; from + kBlockHeaderBytes <= bytes.size(); ++from) {
        const auto rest = bytes.subspan(from);
        if (rest[0] == kBlockSync[0] && decode_block_header(rest)) return from;
    }
    return std::nullopt;
}

}  // namespace

struct RecordingReader::Impl {
    explicit Impl(const std::filesystem::path& path) : where(path.string()), file(path) {
        const Bytes magic = file.peek(kRecordingMagic.size());
        const std::size_t fixed = kRecordingVersionOffset;
        if (magic.size() < kRecordingMagic.size() ||
            !std::equal(magic.begin(), magic.begin() + fixed, kRecordingMagic.begin()))
            throw InputError(where, "is not a recording of \"stipple capture record\"");
        if (const auto version = load<std::uint32_t>(&magic[fixed]);
            version != kRecordingMagic[fixed])
            throw InputError(where, "has format version " + std::to_string(version) +
                                        "; this program reads version 1");
        file.skip(kRecordingMagic.size());
        if (read_block(BlockKind::kSession, nullptr) != Found::kSession)
            note(file.offset(), 0, "there is no session record at the beginning");
    }

    enum class Found { kNothing, kSession, kFrame, kEnd };

    /// Reads up to the next block that is good. `frame`, unless null, takes a frame; with null, a
    /// block of another kind than `wanted` is left where it is.
    Found read_block(BlockKind wanted, CapturedFrame* frame);

    void note(std::uint64_t offset, std::uint64_t bytes, std::string cause);
    /// Skips at least one byte, up to the next good header or the end of what there is.
    void skip_damage(std::string cause, std::size_t from = 1);
    /// Counts bytes that will be scanned again. Blocks that claim to overlap would take time
    /// without end. A file that kept a sixteenth of its bytes stays below the limit.
    void limit_rescans(std::uint64_t bytes);
    bool whole_block(const BlockHeader& header, Bytes block);
    void count_number(std::uint32_t number);
    std::string take(const BlockHeader& header, Bytes block, CapturedFrame* frame);

    std::string where;
    BufferedReader file;
    SessionRecord session;
    std::optional<RecordingEnd> end;
    RecordingReport report;
    std::uint32_t next_number = 0;
    std::uint64_t rescan_bytes = 0;
};

void RecordingReader::Impl::note(std::uint64_t offset, std::uint64_t bytes, std::string cause) {
    if (report.damage.size() < RecordingReport::kMaxListedDamage)
        report.damage.push_back({offset, bytes, std::move(cause)});
    else
        ++report.unlisted_damage;
}

void RecordingReader::Impl::skip_damage(std::string cause, std::size_t from) {
    const std::uint64_t start = file.offset();
    for (;;) {
        const Bytes bytes = file.peek(kSearchBytes);
        const auto found = find_block(bytes, from);
        if (found) {
            file.skip(*found);
            break;
        }
        const bool last = bytes.size() < kSearchBytes;
        file.skip(last ? bytes.size() : bytes.size() - kBlockHeaderBytes + 1);
        if (last) break;
        from = 0;
    }
    note(start, file.offset() - start, std::move(cause));
}

void RecordingReader::Impl::limit_rescans(std::uint64_t bytes) {
    rescan_bytes += bytes;
    if (rescan_bytes > std::uint64_t{1} << 32U && rescan_bytes / 16 > file.bytes_read())
        throw InputError(where, "is made of blocks that overlap; it is not a recording");
}

/// True if the file has all bytes of the block; else either the file ends here (the rest is its
/// tail), or some of the block's bytes are missing and the next block is found.
bool RecordingReader::Impl::whole_block(const BlockHeader& header, Bytes block) {
    if (block.size() == header.block_bytes()) return true;
    limit_rescans(block.size());
    if (find_block(block, 1))
        skip_damage("bytes of a block are missing");
    else
        report.tail_bytes = block.size();
    return false;
}

void RecordingReader::Impl::count_number(std::uint32_t number) {
    const std::uint32_t missing = number - next_number;
    next_number = number + 1;
    if (missing == 0) return;
    const bool forward = missing < 0x80000000U;
    if (forward) report.missing_blocks += missing;
    note(file.offset(), 0,
         forward ? std::to_string(missing) + " blocks are missing before this one"
                 : "a block comes twice or out of order");
}

std::string RecordingReader::Impl::take(const BlockHeader& header, Bytes block,
                                        CapturedFrame* frame) {
    const Bytes record = block.subspan(kBlockHeaderBytes, header.record_bytes);
    const Bytes payload = block.subspan(kBlockHeaderBytes + header.record_bytes);
    if (crc32c(record) != header.record_crc) return "the CRC of a record is wrong";
    try {
        if (header.kind == BlockKind::kSession) session = decode_session(text_of(record), where);
        if (header.kind == BlockKind::kEnd) end = decode_end(text_of(record), where);
    } catch (const InputError& e) {
        return e.what();
    }
    if (header.kind != BlockKind::kFrame) return {};
    if (std::string problem = decode_frame_record(record, payload.size(), *frame); !problem.empty())
        return "a frame has " + problem;
    if (payload_hash(payload) != frame->record.payload_hash)
        return "the hash of a frame's payload is wrong";
    frame->payload.assign(payload.begin(), payload.end());
    return {};
}

RecordingReader::Impl::Found RecordingReader::Impl::read_block(BlockKind wanted,
                                                               CapturedFrame* frame) {
    for (;;) {
        const Bytes start = file.peek(kBlockHeaderBytes);
        report.tail_bytes = 0;
        if (start.size() < kBlockHeaderBytes) {
            if (end && !start.empty())
                skip_damage("bytes behind the end");
            else
                report.tail_bytes = start.size();
            return Found::kNothing;
        }
        const auto header = decode_block_header(start);
        if (!header) {
            skip_damage("there is no block");
            continue;
        }
        if (frame == nullptr && header->kind != wanted) return Found::kNothing;
        const std::uint64_t total = header->block_bytes();
        const Bytes block = file.peek(total);
        if (!whole_block(*header, block)) {
            if (report.tail_bytes > 0) return Found::kNothing;
            continue;
        }
        if (std::string problem = take(*header, block, frame); !problem.empty()) {
            limit_rescans(total);
            skip_damage(std::move(problem));
            continue;
        }
        count_number(header->number);
        file.skip(total);
        switch (header->kind) {
            case BlockKind::kSession:
                return Found::kSession;
            case BlockKind::kFrame:
                return Found::kFrame;
            case BlockKind::kEnd:
                return Found::kEnd;
        }
        note(file.offset() - total, total, "a block of a kind that is not known");
    }
}

bool is_recording(const std::filesystem::path& path) {
    std::error_code error;  // the reader of the file says what it is
    if (!std::filesystem::is_regular_file(path, error)) return false;
    BufferedReader file(path);
    const Bytes start = file.peek(kRecordingVersionOffset);
    return std::equal(start.begin(), start.end(), kRecordingMagic.begin(),
                      kRecordingMagic.begin() + kRecordingVersionOffset);
}

RecordingReader::RecordingReader(std::filesystem::path file)
    : file_(std::move(file)), impl_(std::make_unique<Impl>(file_)) {}
RecordingReader::~RecordingReader() = default;
RecordingReader::RecordingReader(RecordingReader&&) noexcept = default;
RecordingReader& RecordingReader::operator=(RecordingReader&&) noexcept = default;

const SessionRecord& RecordingReader::session() const {
    return impl_->session;
}

const std::optional<RecordingEnd>& RecordingReader::end() const {
    return impl_->end;
}

const RecordingReport& RecordingReader::report() const {
    return impl_->report;
}

std::vector<std::string> RecordingReader::faults() const {
    std::vector<std::string> faults;
    if (!report().damage.empty())
        faults.push_back(
            fmt::format("is damaged ({} of its blocks cannot be read)", report().missing_blocks));
    if (!end()) faults.emplace_back("was cut off before its end");
    return faults;
}

bool RecordingReader::next(CapturedFrame& frame) {
    for (;;) {
        const auto found = impl_->read_block(BlockKind::kFrame, &frame);
        if (found == Impl::Found::kNothing) return false;
        if (found != Impl::Found::kFrame) continue;
        ++impl_->report.frames;
        return true;
    }
}

void RecordingReader::rewind() {
    impl_ = std::make_unique<Impl>(file_);
}

}  // namespace stipple
