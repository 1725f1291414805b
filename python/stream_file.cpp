#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/memory_limit.h"
#include "io/output_file.h"
#include "io/output_names.h"
#include "io/pending_output.h"
#include "python/call_progress.h"
#include "python/errors.h"
#include "python/stream.h"

namespace stipple::python {
namespace fs = std::filesystem;
namespace py = pybind11;
namespace {

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
    std::vector<SamplePacket> packets;
    for (; has_packet_ && packet_.slot == slot; advance()) packets.push_back(packet_);
    return sample_rows(header(), packets, name());
}

py::array StreamFile::samples_between(std::int64_t begin, std::int64_t end) {
    if (begin < 0 || end > slots())
        throw py::index_error(
            fmt::format("slots {} to {}: the stream holds {}", begin, end - 1, slots()));
    std::vector<SamplePacket> packets;
    StreamReader reader = this->reader();
    CallProgress progress(py::none(), end - begin);
    {
        const py::gil_scoped_release released;
        std::uint64_t samples = 0;
        reader.seek(begin);
        for (SamplePacket packet; reader.next(packet) && packet.slot < end;) {
            if (!progress.reach(static_cast<double>(packet.slot - begin))) break;
            if (packet.slot < begin) continue;
            samples += packet.dn.size();
            check_memory(samples * (sizeof(SampleRow) + sizeof(packet.dn[0])), name(),
                         "the samples");
            packets.push_back(packet);
        }
    }
    progress.finish();
    return sample_rows(reader.header(), packets, name());
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

}  // namespace stipple::python
