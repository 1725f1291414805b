#include "tests/vm/loop_writer.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace stipple {
namespace {

constexpr std::uint32_t kType = V4L2_BUF_TYPE_VIDEO_OUTPUT;

void demand(bool done, const char* what) {
    if (!done)
        throw std::runtime_error(std::string("loop writer: ") + what + ": " + std::strerror(errno));
}

v4l2_buffer mapped_buffer(std::uint32_t index) {
    v4l2_buffer buffer{};
    buffer.type = kType;
    buffer.memory = V4L2_MEMORY_MMAP;
    buffer.index = index;
    return buffer;
}

}  // namespace

LoopWriter::LoopWriter(const std::string& node, std::uint32_t fourcc, int width, int height,
                       std::vector<std::vector<std::uint8_t>> frames)
    : frames_(std::move(frames)) {
    descriptor_ = ::open(node.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    demand(descriptor_ >= 0, "open");
    v4l2_format format{};
    format.type = kType;
    format.fmt.pix.width = static_cast<__u32>(width);
    format.fmt.pix.height = static_cast<__u32>(height);
    format.fmt.pix.pixelformat = fourcc;
    format.fmt.pix.field = V4L2_FIELD_NONE;
    demand(::ioctl(descriptor_, VIDIOC_S_FMT, &format) == 0, "format");
    demand(format.fmt.pix.pixelformat == fourcc && format.fmt.pix.sizeimage == frames_[0].size(),
           "another format");
    v4l2_requestbuffers request{};
    request.count = 4;
    request.type = kType;
    request.memory = V4L2_MEMORY_MMAP;
    demand(::ioctl(descriptor_, VIDIOC_REQBUFS, &request) == 0, "buffers");
    for (std::uint32_t i = 0; i < request.count; ++i) {
        v4l2_buffer buffer = mapped_buffer(i);
        demand(::ioctl(descriptor_, VIDIOC_QUERYBUF, &buffer) == 0, "where a buffer is");
        void* const start = ::mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED,
                                   descriptor_, static_cast<off_t>(buffer.m.offset));
        demand(start != MAP_FAILED, "map");
        buffers_.emplace_back(static_cast<std::uint8_t*>(start), buffer.length);
        demand(put(i, i % frames_.size()), "first frames");
    }
    auto type = static_cast<int>(kType);
    demand(::ioctl(descriptor_, VIDIOC_STREAMON, &type) == 0, "start");
    thread_ = std::jthread([this] { play(); });
}

LoopWriter::~LoopWriter() {
    stop_ = true;
    thread_.join();
    auto type = static_cast<int>(kType);
    ::ioctl(descriptor_, VIDIOC_STREAMOFF, &type);
    for (const auto& buffer : buffers_) ::munmap(buffer.data(), buffer.size());
    ::close(descriptor_);
}

bool LoopWriter::put(std::uint32_t index, std::size_t frame) {
    const auto& content = frames_[frame];
    std::memcpy(buffers_[index].data(), content.data(),
                std::min(content.size(), buffers_[index].size()));
    v4l2_buffer buffer = mapped_buffer(index);
    buffer.bytesused = static_cast<__u32>(content.size());
    buffer.field = V4L2_FIELD_NONE;
    return ::ioctl(descriptor_, VIDIOC_QBUF, &buffer) == 0;
}

void LoopWriter::play() {
    constexpr int kPatienceMs = 200;
    for (std::size_t next = buffers_.size(); !stop_;) {
        pollfd free{descriptor_, POLLOUT, 0};
        if (::poll(&free, 1, kPatienceMs) <= 0) continue;
        v4l2_buffer buffer = mapped_buffer(0);
        if (::ioctl(descriptor_, VIDIOC_DQBUF, &buffer) != 0) continue;
        if (put(buffer.index, next % frames_.size())) ++next;
    }
}

}  // namespace stipple
