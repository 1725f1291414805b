#include "tests/capture/v4l2/emulated_v4l2.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <umockdev.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace stipple {
namespace {

constexpr std::uint32_t kPage = 4096;

/// Fills a text field of a kernel struct; some of those are packed, which rules out references.
void put_text(void* field, std::size_t size, std::string_view text) {
    std::memset(field, 0, size);
    std::memcpy(field, text.data(), std::min(text.size(), size - 1));
}

}  // namespace

EmulatedV4l2::EmulatedV4l2(EmulatedDriver driver)
    : driver_(std::move(driver)), fourcc_(driver_.formats.at(0)) {
    testbed_ = umockdev_testbed_new();
    // A node with contents is a regular file, which clients can map.
    constexpr const char* kDevice =
        "P: /devices/platform/emulated/video4linux/video0\nN: video0=00\n"
        "E: SUBSYSTEM=video4linux\nE: DEVNAME=/dev/video0\nE: MAJOR=81\nE: MINOR=0\n";
    GError* error = nullptr;
    if (!umockdev_testbed_add_from_string(testbed_, kDevice, &error))
        throw std::runtime_error(error->message);
    char* const root = umockdev_testbed_get_root_dir(testbed_);
    const std::string node = std::string(root) + "/dev/video0";
    g_free(root);
    const int file = ::open(node.c_str(), O_RDWR);
    const std::size_t bytes = std::size_t{buffer_span()} * driver_.max_buffers;
    if (file < 0 || ::ftruncate(file, static_cast<off_t>(bytes)) != 0)
        throw std::runtime_error("cannot make " + node);
    void* const start = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    ::close(file);
    file_ = {static_cast<std::uint8_t*>(start), bytes};
    handler_ = umockdev_ioctl_base_new();
    g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(on_ioctl), this);
    if (!umockdev_testbed_attach_ioctl(testbed_, "/dev/video0", handler_, &error))
        throw std::runtime_error(error->message);
}

EmulatedV4l2::~EmulatedV4l2() {
    umockdev_testbed_detach_ioctl(testbed_, "/dev/video0", nullptr);
    g_object_unref(handler_);
    g_object_unref(testbed_);
    ::munmap(file_.data(), file_.size());
}

void EmulatedV4l2::push(EmulatedFrame frame) {
    const std::scoped_lock lock(mutex_);
    frames_.push_back(std::move(frame));
}

void EmulatedV4l2::fail(unsigned long request, std::deque<int> errors) {
    const std::scoped_lock lock(mutex_);
    failures_[request] = std::move(errors);
}

int EmulatedV4l2::calls(unsigned long request) const {
    const std::scoped_lock lock(mutex_);
    const auto found = calls_.find(request);
    return found == calls_.end() ? 0 : found->second;
}

bool EmulatedV4l2::streaming() const {
    const std::scoped_lock lock(mutex_);
    return streaming_;
}

std::size_t EmulatedV4l2::queued() const {
    const std::scoped_lock lock(mutex_);
    return queue_.size();
}

std::int64_t EmulatedV4l2::control(std::uint32_t id) const {
    const std::scoped_lock lock(mutex_);
    for (const auto& control : driver_.controls)
        if (control.about.id == id) return control.value;
    throw std::runtime_error("no such control");
}

/// Runs on umockdev's thread. The client is this process, so its structs are at hand.
gboolean EmulatedV4l2::on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
    auto* const emulated = static_cast<EmulatedV4l2*>(self);
    const gulong request = umockdev_ioctl_client_get_request(client);
    UMockdevIoctlData* const data = umockdev_ioctl_client_get_arg(client);
    void* argument = nullptr;
    std::memcpy(&argument, data->data, sizeof argument);
    const int error = emulated->answer(request, argument);
    umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
    return TRUE;
}

int EmulatedV4l2::answer(unsigned long request, void* argument) {
    const std::scoped_lock lock(mutex_);
    ++calls_[request];
    if (auto& failures = failures_[request]; !failures.empty()) {
        const int error = failures.front();
        failures.pop_front();
        if (error != 0) return error;
    }
    switch (request) {
        case VIDIOC_QUERYCAP:
            return capability(*static_cast<v4l2_capability*>(argument));
        case VIDIOC_ENUM_FMT:
            return list_format(*static_cast<v4l2_fmtdesc*>(argument));
        case VIDIOC_G_FMT:
            return format(*static_cast<v4l2_format*>(argument), false);
        case VIDIOC_S_FMT:
            return format(*static_cast<v4l2_format*>(argument), true);
        case VIDIOC_G_PARM:
            return rate(*static_cast<v4l2_streamparm*>(argument), false);
        case VIDIOC_S_PARM:
            return rate(*static_cast<v4l2_streamparm*>(argument), true);
        case VIDIOC_G_SELECTION:
            return region(*static_cast<v4l2_selection*>(argument), false);
        case VIDIOC_S_SELECTION:
            return region(*static_cast<v4l2_selection*>(argument), true);
        case VIDIOC_REQBUFS:
            return request_buffers(*static_cast<v4l2_requestbuffers*>(argument));
        case VIDIOC_QUERYBUF:
            return where(*static_cast<v4l2_buffer*>(argument));
        case VIDIOC_QBUF:
            return queue(*static_cast<v4l2_buffer*>(argument));
        case VIDIOC_DQBUF:
            return dequeue(*static_cast<v4l2_buffer*>(argument));
        case VIDIOC_STREAMON:
            streaming_ = true;
            return 0;
        case VIDIOC_STREAMOFF:
            streaming_ = false;
            queue_.clear();
            return 0;
        case VIDIOC_QUERY_EXT_CTRL:
            return list_control(*static_cast<v4l2_query_ext_ctrl*>(argument));
        case VIDIOC_QUERYMENU:
            return list_menu(*static_cast<v4l2_querymenu*>(argument));
        case VIDIOC_G_EXT_CTRLS:
            return values(*static_cast<v4l2_ext_controls*>(argument), false);
        case VIDIOC_S_EXT_CTRLS:
            return values(*static_cast<v4l2_ext_controls*>(argument), true);
        default:
            return ENOTTY;
    }
}

int EmulatedV4l2::capability(v4l2_capability& about) const {
    about = {};
    put_text(about.driver, sizeof about.driver, "emulated");
    put_text(about.card, sizeof about.card, "Emulated camera");
    put_text(about.bus_info, sizeof about.bus_info, "platform:emulated");
    about.version = 6U << 16U | 1U << 8U | 192U;
    about.device_caps = driver_.capabilities | (driver_.multi_planar ? V4L2_CAP_VIDEO_CAPTURE_MPLANE
                                                                     : V4L2_CAP_VIDEO_CAPTURE);
    about.capabilities = about.device_caps | V4L2_CAP_DEVICE_CAPS;
    return 0;
}

int EmulatedV4l2::list_format(v4l2_fmtdesc& entry) const {
    if (entry.index >= driver_.formats.size()) return EINVAL;
    entry.pixelformat = driver_.formats[entry.index];
    return 0;
}

std::uint32_t EmulatedV4l2::stride() const {
    return (driver_.width * driver_.bits_per_pixel + 7) / 8 + driver_.row_padding;
}

std::uint32_t EmulatedV4l2::frame_bytes() const {
    return stride() * driver_.height + driver_.frame_padding;
}

std::uint32_t EmulatedV4l2::buffer_span() const {
    return (frame_bytes() + kPage - 1) / kPage * kPage;
}

int EmulatedV4l2::format(v4l2_format& format, bool set) {
    const std::uint32_t type =
        driver_.multi_planar ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (format.type != type) return EINVAL;
    auto& pix = format.fmt.pix;
    auto& planes = format.fmt.pix_mp;
    if (set) {
        const std::uint32_t wanted = driver_.multi_planar ? planes.pixelformat : pix.pixelformat;
        const auto& known = driver_.formats;
        fourcc_ =
            std::find(known.begin(), known.end(), wanted) == known.end() ? known.front() : wanted;
        if (driver_.any_size) {
            driver_.width = driver_.multi_planar ? planes.width : pix.width;
            driver_.height = driver_.multi_planar ? planes.height : pix.height;
        }
    }
    if (driver_.multi_planar) {
        planes = {};
        planes.width = driver_.width;
        planes.height = driver_.height;
        planes.pixelformat = fourcc_;
        planes.field = driver_.field;
        planes.num_planes = static_cast<std::uint8_t>(driver_.memory_planes);
        planes.plane_fmt[0].bytesperline = stride();
        planes.plane_fmt[0].sizeimage = frame_bytes();
    } else {
        pix = {};
        pix.width = driver_.width;
        pix.height = driver_.height;
        pix.pixelformat = fourcc_;
        pix.field = driver_.field;
        pix.bytesperline = stride();
        pix.sizeimage = frame_bytes();
    }
    return 0;
}

int EmulatedV4l2::rate(v4l2_streamparm& rate, bool set) {
    if (!driver_.rates) return ENOTTY;
    if (set) {
        period_ = rate.parm.capture.timeperframe;
        if (period_.denominator > driver_.highest_rate * period_.numerator)
            period_ = {1000, static_cast<__u32>(std::lround(driver_.highest_rate * 1000))};
    }
    rate.parm.capture.capability = V4L2_CAP_TIMEPERFRAME;
    rate.parm.capture.timeperframe = period_;
    return 0;
}

int EmulatedV4l2::region(v4l2_selection& region, bool set) {
    if (!driver_.selections) return ENOTTY;
    if (region.target != V4L2_SEL_TGT_CROP) return EINVAL;
    if (set) {
        driver_.region = region.r;
        driver_.region.left &= ~1;  // whole Bayer cells
        driver_.region.top &= ~1;
    }
    region.r = driver_.region;
    return 0;
}

int EmulatedV4l2::request_buffers(v4l2_requestbuffers& request) {
    if (request.memory == V4L2_MEMORY_USERPTR && !driver_.user_memory) return EINVAL;
    memory_ = request.memory;
    buffers_ = request.count = std::min(request.count, driver_.max_buffers);
    return 0;
}

int EmulatedV4l2::where(v4l2_buffer& buffer) const {
    if (buffer.index >= buffers_) return EINVAL;
    if (driver_.multi_planar) {
        buffer.m.planes[0].length = frame_bytes();
        buffer.m.planes[0].m.mem_offset = buffer.index * buffer_span();
    } else {
        buffer.length = frame_bytes();
        buffer.m.offset = buffer.index * buffer_span();
    }
    return 0;
}

int EmulatedV4l2::queue(v4l2_buffer& buffer) {
    const bool twice = std::any_of(queue_.begin(), queue_.end(), [&](const Queued& queued) {
        return queued.index == buffer.index;
    });
    if (buffer.index >= buffers_ || buffer.memory != memory_ || twice) return EINVAL;
    const bool user = memory_ == V4L2_MEMORY_USERPTR;
    const auto length = driver_.multi_planar ? buffer.m.planes[0].length : buffer.length;
    if (user && length < frame_bytes()) return EINVAL;
    const auto address = driver_.multi_planar ? buffer.m.planes[0].m.userptr : buffer.m.userptr;
    queue_.push_back({buffer.index, user ? address : 0});
    return 0;
}

int EmulatedV4l2::dequeue(v4l2_buffer& buffer) {
    if (!streaming_) return EINVAL;
    if (queue_.empty() || frames_.empty()) return EAGAIN;
    const Queued place = queue_.front();
    const EmulatedFrame frame = frames_.front();
    queue_.pop_front();
    frames_.pop_front();
    std::uint8_t* const start = place.user != 0
                                    ? reinterpret_cast<std::uint8_t*>(place.user)
                                    : file_.data() + std::size_t{place.index} * buffer_span();
    std::memcpy(start, frame.content.data(),
                std::min<std::size_t>(frame.content.size(), frame_bytes()));
    const auto used = frame.bytes_used.value_or(static_cast<std::uint32_t>(frame.content.size()));
    buffer.index = place.index;
    buffer.sequence = frame.sequence;
    buffer.flags = frame.flags;
    buffer.timestamp = frame.stamp;
    if (driver_.multi_planar) {
        buffer.m.planes[0].bytesused = used;
        buffer.m.planes[0].data_offset = frame.data_offset;
    } else {
        buffer.bytesused = used;
    }
    return 0;
}

int EmulatedV4l2::list_control(v4l2_query_ext_ctrl& query) const {
    constexpr std::uint32_t kNext = V4L2_CTRL_FLAG_NEXT_CTRL | V4L2_CTRL_FLAG_NEXT_COMPOUND;
    const std::uint32_t id = query.id & ~kNext;
    for (const auto& control : driver_.controls) {
        const bool fits = (query.id & kNext) != 0 ? control.about.id > id : control.about.id == id;
        if (!fits) continue;
        query = control.about;
        return 0;
    }
    return EINVAL;
}

int EmulatedV4l2::list_menu(v4l2_querymenu& item) const {
    for (const auto& control : driver_.controls) {
        if (control.about.id != item.id) continue;
        if (item.index >= control.menu.size() || control.menu[item.index].empty()) return EINVAL;
        put_text(item.name, sizeof item.name, control.menu[item.index]);
        return 0;
    }
    return EINVAL;
}

int EmulatedV4l2::values(v4l2_ext_controls& request, bool set) {
    for (std::uint32_t i = 0; i < request.count; ++i) {
        v4l2_ext_control& asked = request.controls[i];
        const auto found =
            std::find_if(driver_.controls.begin(), driver_.controls.end(),
                         [&](const auto& control) { return control.about.id == asked.id; });
        if (found == driver_.controls.end()) return EINVAL;
        const bool wide = found->about.type == V4L2_CTRL_TYPE_INTEGER64;
        if (set) found->value = wide ? asked.value64 : asked.value;
        if (wide)
            asked.value64 = found->value;
        else
            asked.value = static_cast<std::int32_t>(found->value);
    }
    return 0;
}

}  // namespace stipple
