#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "io/output_file.h"
#include "io/output_names.h"
#include "io/pending_output.h"
#include "python/call_progress.h"
#include "python/errors.h"
#include "python/stream.h"
#include "stream/schedule_switch.h"

namespace stipple::python {
namespace fs = std::filesystem;
namespace py = pybind11;
namespace {

/// A row of the array of samples.
struct SampleRow {
    std::uint16_t row, col;
    std::uint8_t plane, exposure_slots, light_slots;
    std::uint8_t zero;  ///< no field, but the same bytes for the same samples
    std::uint16_t dn;
};

/// What a pixel has collected that is due after a switch; 0 slots if that is unknown.
DuePixel across_switches(std::span<const SchedulePart> parts, const PixelSlot& at, DuePixel pixel) {
    const auto read = read_exposure(parts, at);
    const std::uint64_t open_slots = read ? read->open_slots : 0;
    pixel.span_slots = static_cast<std::uint8_t>(std::bit_width(open_slots));
    pixel.light_slots = static_cast<std::uint8_t>(std::popcount(open_slots));
    return pixel;
}

void add_rows(const SamplePacket& packet, const StreamHeader& header,
              std::vector<SampleRow>& rows) {
    auto dn = packet.dn.begin();
    if (packet.dn.empty()) return;
    const auto parts = schedule_parts(header);
    const SchedulePart part = schedule_at(header, packet.slot);
    const std::int64_t slot = readout_slot(part, packet.slot);
    for (int row = packet.first_row; row < packet.first_row + packet.rows; ++row)
        visit_due_pixels(*part.schedule, slot, row, header.shape.cols,
                         [&](int col, DuePixel pixel) {
                             if (part.first_slot > 0)
                                 pixel = across_switches(parts, {packet.slot, row, col}, pixel);
                             for (int plane = 0; plane < header.shape.planes; ++plane)
                                 rows.push_back({static_cast<std::uint16_t>(row),
                                                 static_cast<std::uint16_t>(col),
                                                 static_cast<std::uint8_t>(plane), pixel.span_slots,
                                                 pixel.light_slots, 0, *dn++});
                         });
}

[[noreturn]] void fail(const fs::path& path, std::string_view done) {
    throw DeviceError(path.string(), fmt::format("cannot be {}: {}", done,
                                                 std::generic_category().message(errno)));
}

}  // namespace

TemporaryFile::TemporaryFile() {
    std::string folder = (fs::temp_directory_path() / "stipple_XXXXXX").string();
    if (::mkdtemp(folder.data()) == nullptr) fail(folder, "created");
    folder_ = folder;
    path_ = folder_ / "stream.stipple";
}

TemporaryFile::~TemporaryFile() {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
    if (descriptor_ >= 0) ::close(descriptor_);
}

void TemporaryFile::unname() {
    descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail(path_, "opened");
    fs::remove_all(std::exchange(folder_, {}));
    path_ = fmt::format("/proc/self/fd/{}", descriptor_);
}

StreamFile::StreamFile(fs::path file, py::object figures)
    : is_temporary_(false),
      path_(std::move(file)),
      figures_(std::move(figures)),
      reader_(reading(path_, [&] { return StreamReader(path_); })) {
    reader_->follow_switches();
}

StreamFile::StreamFile(std::unique_ptr<TemporaryFile> file, py::object figures)
    : temporary_(std::move(file)),
      is_temporary_(true),
      path_(temporary_->path()),
      figures_(std::move(figures)),
      reader_(path_) {
    reader_->follow_switches();
}

fs::path StreamFile::saved_path() const {
    if (is_temporary_)
        throw InputError(name(),
                         "is in a temporary file, which other processes cannot open; give "
                         "it a name by save or output, and open that");
    return fs::absolute(path_);
}

const StreamReader& StreamFile::opened() const {
    if (!reader_) throw InputError(name(), "is closed");
    return *reader_;
}

void StreamFile::close() {
    reader_.reset();
    temporary_.reset();
}

StreamReader StreamFile::reader(ReadPolicy policy) const {
    static_cast<void>(opened());
    StreamReader reader = reading(path_, [&] { return StreamReader(path_, policy); });
    reader.use_name(name());
    reader.follow_switches();
    return reader;
}

std::string StreamFile::name() const {
    return is_temporary() ? "stream" : path_.string();
}

bool StreamFile::advance() {
    static_cast<void>(opened());
    has_packet_ = reader_->next(packet_);
    return has_packet_;
}

StreamReport StreamFile::read_through() const {
    StreamReader all = reader();
    CallProgress progress(py::none(), std::nullopt);
    {
        const py::gil_scoped_release released;
        SamplePacket packet;
        while (all.next(packet) && progress.reach(0)) {
        }
    }
    progress.finish();
    return all.report();
}

std::int64_t StreamFile::slots() {
    if (!slots_) slots_ = opened().slots();
    if (!slots_) slots_ = read_through().slots;
    return *slots_;
}

py::array StreamFile::samples(std::int64_t slot) {
    if (slot < 0 || slot >= slots())
        throw py::index_error(fmt::format("slot {}: the stream holds {}", slot, slots()));
    if (!has_packet_ || packet_.slot > slot) {
        reader_ = reader();
        advance();
    }
    while (has_packet_ && packet_.slot < slot) {
        check_signals();
        advance();
    }
    std::vector<SampleRow> rows;
    for (; has_packet_ && packet_.slot == slot; advance()) add_rows(packet_, header(), rows);
    return py::array_t<SampleRow>(static_cast<py::ssize_t>(rows.size()), rows.data());
}

void StreamFile::save(const fs::path& file, bool force) const {
    static_cast<void>(opened());
    check_name(file, kStreamName);
    creating(file, [&] {
        PendingOutput pending(file, force);
        OutputFile output(pending.partial(), file.string());
        std::ifstream input(path_, std::ios::binary);
        std::vector<char> bytes(std::size_t{1} << 20U);
        while (input) {
            input.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
            output.write(
                std::as_bytes(std::span(bytes.data(), static_cast<std::size_t>(input.gcount()))));
        }
        if (!input.eof()) throw InputError(name(), "cannot be read");
        output.close();
        pending.commit();
    });
}

void bind_sample_rows() {
    PYBIND11_NUMPY_DTYPE(SampleRow, row, col, plane, exposure_slots, light_slots, dn);
}

}  // namespace stipple::python
