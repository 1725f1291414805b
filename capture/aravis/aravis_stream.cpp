#include "capture/aravis/aravis_stream.h"

#include <arv.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>

#include "capture/aravis/aravis_call.h"
#include "capture/aravis/gige_link.h"
#include "capture/frame_payload.h"
#include "capture/frame_record.h"
#include "core/error.h"
#include "core/memory_limit.h"

namespace stipple {
namespace {

constexpr std::size_t kMaxPayloadBytes = std::size_t{1} << 30U;
using BufferMemory = std::vector<std::uint8_t>;

/// What `push_buffers` gave it.
BufferMemory& memory_of(ArvBuffer* buffer) {
    return *static_cast<BufferMemory*>(const_cast<void*>(arv_buffer_get_user_data(buffer)));
}

/// Aravis stamps the first packet of a frame with the host's realtime; where that packet was lost,
/// the frame arrived before now. A thread that waits for its core between two clocks reads them
/// again. No frame arrives before the last one, or later than now, whatever the realtime clock
/// does.
void stamp_arrival(ArvBuffer* buffer, FrameRecord& record, std::int64_t last_monotonic_ns) {
    std::int64_t now_ns = 0, realtime_now_ns = 0;
    for (int tries = 0; tries < 5; ++tries) {
        now_ns = monotonic_ns();
        realtime_now_ns = realtime_ns();
        if (monotonic_ns() - now_ns < 1000) break;
    }
    const auto first_ns = static_cast<std::int64_t>(arv_buffer_get_system_timestamp(buffer));
    record.host_realtime_ns = first_ns != 0 ? first_ns : realtime_now_ns;
    record.host_monotonic_ns =
        std::clamp(now_ns - (realtime_now_ns - record.host_realtime_ns), last_monotonic_ns, now_ns);
}

/// A frame whose leader was lost keeps what its buffer said before: this.
constexpr std::uint64_t kNoId = ~std::uint64_t{0};

FrameStatus status_of(ArvBufferStatus status) {
    switch (status) {
        case ARV_BUFFER_STATUS_SUCCESS:
            return FrameStatus::kComplete;
        case ARV_BUFFER_STATUS_TIMEOUT:
        case ARV_BUFFER_STATUS_MISSING_PACKETS:
        case ARV_BUFFER_STATUS_WRONG_PACKET_ID:
            return FrameStatus::kMissingPackets;
        case ARV_BUFFER_STATUS_SIZE_MISMATCH:
            return FrameStatus::kSizeMismatch;
        default:
            return FrameStatus::kDeviceError;
    }
}

}  // namespace

struct AravisStream::Impl {
    AravisDevice& device;
    FrameLayout layout;
    CameraBuffers buffers;
    ArvCamera* camera;
    ArvStream* stream = nullptr;
    ArvChunkParser* chunks = nullptr;
    std::size_t buffer_bytes = 0;
    std::uint64_t mismatches_seen = 0;
    std::uint64_t cut_frames = 0;
    ArvBuffer* held_back = nullptr;  ///< of the last frame, if that was incomplete
    std::uint64_t last_wire_id = 0;
    std::int64_t last_arrival_ns = 0;  ///< monotonic
    bool running = false;
    std::int64_t started_ns = 0;
    std::atomic<bool> lost = false;
    gulong lost_handler = 0;
    std::optional<GigeLink> link;  ///< empty: USB3 Vision

    Impl(AravisDevice& opened, FrameLayout first_layout, CameraBuffers wanted)
        : device(opened),
          layout(first_layout),
          buffers(wanted),
          camera(static_cast<ArvCamera*>(opened.native())) {}
    ~Impl();
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    void create(std::optional<int> packet_bytes);
    void open_stream();
    void prepare_socket();
    void check_buffers() const;
    void push_buffers();
    void hand_back(ArvBuffer* buffer, bool complete);
    void reuse(ArvBuffer* buffer) const;
    void rebuild();
    [[nodiscard]] std::size_t wanted_bytes() const;
    [[nodiscard]] bool has_room_for(std::size_t bytes) const;
    [[nodiscard]] bool is_credible(const FrameLayout& said, std::size_t came) const;
    [[nodiscard]] std::uint64_t mismatches() const;
    [[nodiscard]] std::uint64_t info(const char* name) const;
    [[nodiscard]] CapturedFrame frame_from(ArvBuffer* buffer, FramePool& pool);
    [[nodiscard]] FrameLayout layout_of(ArvBuffer* buffer) const;
    void read_chunks(ArvBuffer* buffer, FrameRecord& record) const;
};

AravisStream::Impl::~Impl() {
    if (lost_handler != 0) g_signal_handler_disconnect(arv_camera_get_device(camera), lost_handler);
    g_clear_object(&held_back);
    g_clear_object(&stream);
    g_clear_object(&chunks);
}

void AravisStream::Impl::create(std::optional<int> packet_bytes) {
    if (device.is_gige()) link.emplace(device, packet_bytes);
    check_buffers();
    open_stream();
    chunks = arv_camera_create_chunk_parser(camera);
    const auto on_lost = +[](ArvDevice*, std::atomic<bool>* flag) { *flag = true; };
    lost_handler = g_signal_connect(arv_camera_get_device(camera), "control-lost",
                                    reinterpret_cast<GCallback>(on_lost), &lost);
}

void AravisStream::Impl::open_stream() {
    // The thread that receives calls this before it reads the socket.
    const ArvStreamCallback prepare = [](void* self, ArvStreamCallbackType type, ArvBuffer*) {
        if (type == ARV_STREAM_CALLBACK_TYPE_INIT) static_cast<Impl*>(self)->prepare_socket();
    };
    buffer_bytes = wanted_bytes();
    GlibError error;
    stream = arv_camera_create_stream(camera, prepare, this, error.slot());
    error.check_answer(device.address());
    if (stream == nullptr)
        throw DeviceError(device.address(), fmt::format("gives no stream: {}", error.text()));
    if (link) link->check(stream);
    push_buffers();
}

void AravisStream::Impl::prepare_socket() {
    if (link) link->prepare_socket(buffer_bytes, layout.payload_bytes(), buffers.socket_frames);
}

/// What a buffer must hold.
std::size_t AravisStream::Impl::wanted_bytes() const {
    const std::size_t payload = arv_camera_get_payload(camera, nullptr);
    // By USB as much is asked for as a buffer holds: no more than the camera sends.
    const bool exactly = !link && payload > 0;
    return std::max(exactly ? payload : std::max(payload, layout.payload_bytes()), std::size_t{1});
}

/// Whether buffers of so many bytes can be had.
bool AravisStream::Impl::has_room_for(std::size_t bytes) const {
    return bytes <=
           std::min(kMaxPayloadBytes, max_memory() / static_cast<std::size_t>(buffers.frames));
}

void AravisStream::Impl::check_buffers() const {
    const std::size_t bytes = wanted_bytes();
    if (has_room_for(bytes)) return;
    throw InputError(
        fmt::format("{}: PayloadSize", device.address()),
        fmt::format("{} buffers of {} bytes are too large: together they may have {} bytes (",
                    buffers.frames, bytes, max_memory()) +
            Parameter{"max_memory"} + fmt::format("), and each {}; set fewer ", kMaxPayloadBytes) +
            Parameter{"buffers"} + ", or a smaller Width and Height");
}

/// A leader may be forged: its size is trusted up to the bytes that came, or up to the size that
/// the camera itself states.
bool AravisStream::Impl::is_credible(const FrameLayout& said, std::size_t came) const {
    if (said.format == nullptr || said.width <= 0 || said.height <= 0) return false;
    const std::size_t bytes = said.payload_bytes();
    return said == layout || bytes <= came ||
           (bytes <= arv_camera_get_payload(camera, nullptr) && has_room_for(bytes));
}

void AravisStream::Impl::push_buffers() {
    for (int i = 0; i < buffers.frames; ++i) {
        auto* const memory = new BufferMemory(buffer_bytes);
        reuse(arv_buffer_new_full(buffer_bytes, memory->data(), memory,
                                  [](void* old) { delete static_cast<BufferMemory*>(old); }));
    }
}

/// Where the trailer of a USB3 Vision frame was lost, the leader of the next one may lie in its
/// buffer, and Aravis (0.8.26) reads that leader after it has handed the buffer out.
void AravisStream::Impl::hand_back(ArvBuffer* buffer, bool complete) {
    if (!link) {
        if (held_back != nullptr) reuse(held_back);
        held_back = complete ? nullptr : buffer;
        if (!complete) return;
    }
    reuse(buffer);
}

void AravisStream::Impl::reuse(ArvBuffer* buffer) const {
    mark_unwritten(memory_of(buffer));
    arv_buffer_set_timestamp(buffer, 0);
    arv_buffer_set_system_timestamp(buffer, 0);
    arv_buffer_set_frame_id(buffer, kNoId);
    arv_stream_push_buffer(stream, buffer);
}

std::uint64_t AravisStream::Impl::info(const char* name) const {
    if (stream == nullptr) return 0;
    for (guint i = 0; i < arv_stream_get_n_infos(stream); ++i)
        if (std::strcmp(arv_stream_get_info_name(stream, i), name) == 0)
            return arv_stream_get_info_uint64(stream, i);
    return 0;  // not counted by this transport
}

/// Frames that did not fit into their buffers, or did not fill them.
std::uint64_t AravisStream::Impl::mismatches() const {
    return link ? info("n_size_mismatch_errors") : cut_frames;
}

/// Makes buffers of the size that the camera sends now.
void AravisStream::Impl::rebuild() {
    if (running) arv_camera_stop_acquisition(camera, nullptr);
    g_clear_object(&held_back);
    arv_stream_stop_thread(stream, TRUE);
    buffer_bytes = wanted_bytes();
    push_buffers();
    arv_stream_start_thread(stream);
    if (running) arv_camera_start_acquisition(camera, nullptr);
}

FrameLayout AravisStream::Impl::layout_of(ArvBuffer* buffer) const {
    FrameLayout found;
    const ArvBufferPayloadType type = arv_buffer_get_payload_type(buffer);
    if ((type != ARV_BUFFER_PAYLOAD_TYPE_IMAGE &&
         type != ARV_BUFFER_PAYLOAD_TYPE_EXTENDED_CHUNK_DATA) ||
        arv_buffer_get_n_parts(buffer) == 0)
        return found;
    const auto* format = pixel_format_of_pfnc(arv_buffer_get_image_pixel_format(buffer));
    found.format = format;
    arv_buffer_get_image_region(buffer, &found.offset_x, &found.offset_y, &found.width,
                                &found.height);
    int padding = 0;
    int rows_padding = 0;
    arv_buffer_get_image_padding(buffer, &padding, &rows_padding);
    if (format != nullptr && found.width > 0)
        found.stride_bytes =
            format->row_bytes(found.width) + static_cast<std::size_t>(std::max(padding, 0));
    return found;
}

void AravisStream::Impl::read_chunks(ArvBuffer* buffer, FrameRecord& record) const {
    const auto number = [&](const char* name) -> std::optional<double> {
        if (arv_device_get_feature(arv_camera_get_device(camera), name) == nullptr)
            return std::nullopt;
        GlibError error;
        const double value = arv_chunk_parser_get_float_value(chunks, buffer, name, error.slot());
        return error.any() ? std::nullopt : std::optional(value);
    };
    record.exposure_us = number("ChunkExposureTime");
    record.gain = number("ChunkGain");
    record.black_level_dn = number("ChunkBlackLevel");
}

CapturedFrame AravisStream::Impl::frame_from(ArvBuffer* buffer, FramePool& pool) {
    CapturedFrame frame;
    frame.payload = pool.take();
    FrameRecord& record = frame.record;
    const ArvBufferStatus status = arv_buffer_get_status(buffer);
    const BufferMemory& memory = memory_of(buffer);
    const bool has_leader = arv_buffer_get_frame_id(buffer) != kNoId;
    // Frames come in order, so the least that it can be is the next one.
    record.wire_id = has_leader ? arv_buffer_get_frame_id(buffer)
                     : link     ? last_wire_id % 65535 + 1
                                : last_wire_id + 1;
    last_wire_id = record.wire_id;
    record.status = status_of(status);
    record.device_ns = static_cast<std::int64_t>(arv_buffer_get_timestamp(buffer));
    record.stamp_source = record.device_ns != 0 ? StampSource::kDeviceClock : StampSource::kNone;
    stamp_arrival(buffer, record, last_arrival_ns);
    last_arrival_ns = record.host_monotonic_ns;
    std::size_t came = memory.size();
    if (!has_leader &&
        (status == ARV_BUFFER_STATUS_SUCCESS || status == ARV_BUFFER_STATUS_CLEARED)) {
        // For what is no image Aravis (0.8.26) hands out a buffer with the status of before.
        record.status = FrameStatus::kOtherLayout;
    } else if (status == ARV_BUFFER_STATUS_SUCCESS) {
        arv_buffer_get_data(buffer, &came);
        const FrameLayout now = layout_of(buffer);
        const bool credible = is_credible(now, std::min(came, memory.size()));
        if (credible) layout = now;
        if (!credible) record.status = FrameStatus::kOtherLayout;
        if (arv_buffer_has_chunks(buffer) != FALSE) read_chunks(buffer, record);
    }
    record.layout = layout;
    const std::size_t wanted = layout.payload_bytes();
    const std::size_t kept = std::min(wanted, memory.size());
    frame.payload.assign(memory.begin(), memory.begin() + static_cast<std::ptrdiff_t>(kept));
    record.bytes_received = kept;
    if (came < wanted && record.status == FrameStatus::kComplete)
        record.status = FrameStatus::kSizeMismatch;
    if (record.status == FrameStatus::kSizeMismatch) ++cut_frames;
    if (record.status != FrameStatus::kComplete) {
        if (!link) erase_usb_packets(frame.payload, record.wire_id);
        frame.holes = clear_holes(frame.payload);
        for (const auto& [begin, end] : frame.holes) record.bytes_received -= end - begin;
        // Only the trailer was lost: every byte of the image is there.
        if (has_leader && record.status == FrameStatus::kMissingPackets &&
            record.bytes_received == wanted)
            record.status = FrameStatus::kComplete;
    }
    if (kept < wanted) {
        frame.payload.resize(wanted);
        frame.holes.emplace_back(kept, wanted);
    }
    return frame;
}

AravisStream::AravisStream(AravisDevice& device, const FrameLayout& layout,
                           const CameraBuffers& buffers, std::optional<int> packet_bytes)
    : impl_(std::make_unique<Impl>(device, layout, buffers)) {
    impl_->create(packet_bytes);
}

AravisStream::~AravisStream() {
    stop();
}

const FrameLayout& AravisStream::layout() const {
    return impl_->layout;
}

std::size_t AravisStream::buffer_bytes() const {
    return impl_->buffer_bytes * static_cast<std::size_t>(impl_->buffers.frames);
}

std::map<std::string, std::string> AravisStream::facts() const {
    return impl_->link ? impl_->link->facts() : std::map<std::string, std::string>();
}

std::vector<Message> AravisStream::warnings() const {
    return impl_->link ? impl_->link->warnings() : std::vector<Message>();
}

TransportCounts AravisStream::counts() const {
    TransportCounts counts;
    counts.underruns = impl_->info("n_underruns");
    counts.packets_resent = impl_->info("n_resent_packets");
    counts.packets_missing = impl_->info("n_missing_packets");
    counts.size_mismatches = impl_->mismatches();
    if (impl_->link) impl_->link->count(impl_->stream, counts);
    return counts;
}

void AravisStream::start() {
    GlibError error;
    arv_camera_set_acquisition_mode(impl_->camera, ARV_ACQUISITION_MODE_CONTINUOUS, nullptr);
    impl_->started_ns = monotonic_ns();
    arv_camera_start_acquisition(impl_->camera, error.slot());
    if (error.any())
        throw DeviceError(impl_->device.address(), fmt::format("does not start: {}", error.text()));
    impl_->running = true;
}

std::int64_t AravisStream::started_ns() const {
    return impl_->started_ns;
}

Arrival AravisStream::wait(std::chrono::milliseconds timeout, FramePool& pool) {
    const auto us = static_cast<guint64>(std::max<std::int64_t>(timeout.count(), 0)) * 1000;
    ArvBuffer* buffer = arv_stream_timeout_pop_buffer(impl_->stream, us);
    if (buffer == nullptr) {
        if (impl_->lost) return DeviceLost{"the camera no longer answers"};
        return NoFrame{};
    }
    CapturedFrame frame = impl_->frame_from(buffer, pool);
    impl_->hand_back(buffer, frame.record.status == FrameStatus::kComplete);
    if (const std::uint64_t mismatches = impl_->mismatches();
        mismatches != impl_->mismatches_seen) {
        impl_->mismatches_seen = mismatches;
        const std::size_t wanted = impl_->wanted_bytes();
        const bool other =
            impl_->link ? wanted > impl_->buffer_bytes : wanted != impl_->buffer_bytes;
        if (other && impl_->has_room_for(wanted)) impl_->rebuild();
    }
    return frame;
}

void AravisStream::stop() noexcept {
    // The wait for a lost camera would not end.
    if (impl_->running && !impl_->lost) arv_camera_stop_acquisition(impl_->camera, nullptr);
    impl_->running = false;
}

}  // namespace stipple
