#include "capture/v4l2/v4l2_buffers.h"

#include <fmt/format.h>
#include <linux/videodev2.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/error.h"

namespace stipple {
namespace {

/// A v4l2_buffer with its one plane, in either API.
struct Request {
    Request(const V4l2Device& device, V4l2Memory memory, std::size_t index = 0) {
        buffer.type = device.buffer_type();
        buffer.memory = memory == V4l2Memory::kDriver ? V4L2_MEMORY_MMAP : V4L2_MEMORY_USERPTR;
        buffer.index = static_cast<__u32>(index);
        if (!device.multi_planar()) return;
        buffer.m.planes = &plane;
        buffer.length = 1;
    }
    Request(const Request&) = delete;
    Request& operator=(const Request&) = delete;

    v4l2_buffer buffer{};
    v4l2_plane plane{};
};

}  // namespace

V4l2Buffers::V4l2Buffers(const V4l2Device& device, V4l2Memory memory, int frames,
                         std::size_t frame_bytes)
    : device_(device), memory_(memory) {
    v4l2_requestbuffers request{};
    request.count = static_cast<__u32>(frames);
    request.type = device_.buffer_type();
    request.memory = Request(device_, memory_).buffer.memory;
    const int error = device_.call(VIDIOC_REQBUFS, &request);
    if (error == EINVAL && memory_ == V4l2Memory::kOwn)
        throw DeviceError(device_.address(),
                          "its driver fills no memory of ours; leave BufferMemory at driver");
    if (error == EBUSY)
        throw DeviceError(device_.address(), "another program streams from it; close that first");
    if (error != 0)
        throw DeviceError(device_.address(),
                          fmt::format("cannot get {} frame buffers: {}; try fewer", frames,
                                      std::strerror(error)));
    places_.resize(request.count);
    try {
        if (count() < 2)
            throw DeviceError(
                device_.address(),
                fmt::format("the driver gives {} frame buffer of {} bytes, at least 2 "
                            "are needed; choose a smaller Width and Height",
                            count(), frame_bytes));
        for (std::size_t i = 0; i < places_.size(); ++i)
            memory_ == V4l2Memory::kDriver ? map(i) : allocate(i, frame_bytes);
    } catch (...) {
        free_all();
        throw;
    }
}

V4l2Buffers::~V4l2Buffers() {
    free_all();
}

void V4l2Buffers::map(std::size_t index) {
    Request request(device_, memory_, index);
    device_.demand(VIDIOC_QUERYBUF, &request.buffer, "ask where a frame buffer is");
    const bool planes = device_.multi_planar();
    const std::size_t bytes = planes ? request.plane.length : request.buffer.length;
    const std::uint32_t offset = planes ? request.plane.m.mem_offset : request.buffer.m.offset;
    void* const start = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED,
                               device_.descriptor(), static_cast<off_t>(offset));
    if (start == MAP_FAILED)
        throw DeviceError(device_.address(),
                          fmt::format("cannot map a frame buffer of {} bytes: {}; ask for fewer",
                                      bytes, std::strerror(errno)));
    places_[index].memory = {static_cast<std::uint8_t*>(start), bytes};
}

void V4l2Buffers::allocate(std::size_t index, std::size_t bytes) {
    // Whole pages: drivers that fill user memory by DMA need it aligned.
    void* const start =
        ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (start == MAP_FAILED)
        throw DeviceError(device_.address(),
                          fmt::format("no memory for a frame buffer of {} bytes", bytes));
    places_[index].memory = {static_cast<std::uint8_t*>(start), bytes};
}

void V4l2Buffers::free_all() noexcept {
    for (const Place& place : places_)
        if (!place.memory.empty()) ::munmap(place.memory.data(), place.memory.size());
    v4l2_requestbuffers none{};
    none.type = device_.buffer_type();
    none.memory = memory_ == V4l2Memory::kDriver ? V4L2_MEMORY_MMAP : V4L2_MEMORY_USERPTR;
    // A device that is gone refuses; then there is nothing to free.
    static_cast<void>(device_.call(VIDIOC_REQBUFS, &none));
}

int V4l2Buffers::queue(std::size_t index) noexcept {
    Request request(device_, memory_, index);
    const auto memory = places_[index].memory;
    if (memory_ == V4l2Memory::kOwn) {
        const auto address = reinterpret_cast<unsigned long>(memory.data());
        const auto bytes = static_cast<__u32>(memory.size());
        if (device_.multi_planar()) {
            request.plane.m.userptr = address;
            request.plane.length = bytes;
        } else {
            request.buffer.m.userptr = address;
            request.buffer.length = bytes;
        }
    }
    return device_.call(VIDIOC_QBUF, &request.buffer);
}

int V4l2Buffers::queue_all() noexcept {
    int result = 0;
    for (std::size_t i = 0; i < places_.size(); ++i) {
        if (places_[i].queued || places_[i].held) continue;
        if (const int error = queue(i)) {
            result = error;
            continue;
        }
        places_[i].queued = true;
        ++queued_;
    }
    return result;
}

int V4l2Buffers::fetch(Filled& filled) noexcept {
    Request request(device_, memory_);
    if (const int error = device_.call(VIDIOC_DQBUF, &request.buffer)) return error;
    const v4l2_buffer& buffer = request.buffer;
    if (buffer.index >= places_.size()) return EPROTO;
    Place& place = places_[buffer.index];
    if (place.queued) --queued_;
    place.queued = false;
    place.held = true;
    const bool planes = device_.multi_planar();
    const std::size_t begin = planes ? request.plane.data_offset : 0;
    const std::size_t end = planes ? request.plane.bytesused : buffer.bytesused;
    filled.index = static_cast<int>(buffer.index);
    filled.overflow = std::max(begin, end) > place.memory.size();
    const std::size_t last = std::min(end, place.memory.size());
    filled.bytes = place.memory.subspan(std::min(begin, last), last - std::min(begin, last));
    filled.sequence = buffer.sequence;
    filled.flags = buffer.flags;
    filled.stamp_ns =
        buffer.timestamp.tv_sec * std::int64_t{1'000'000'000} + buffer.timestamp.tv_usec * 1000;
    return 0;
}

void V4l2Buffers::all_ours() noexcept {
    for (Place& place : places_) place.queued = place.held = false;
    queued_ = 0;
}

}  // namespace stipple
