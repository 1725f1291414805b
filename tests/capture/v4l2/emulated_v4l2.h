#pragma once

#include <linux/videodev2.h>

#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

struct _UMockdevTestbed;  // umockdev.h: its types stay in the .cpp file
struct _UMockdevIoctlBase;
struct _UMockdevIoctlClient;

namespace stipple {

/// What the next VIDIOC_DQBUF gives.
struct EmulatedFrame {
    std::vector<std::uint8_t> content;  ///< written into the buffer from its start
    std::uint32_t sequence = 0;
    std::uint32_t flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
    std::optional<std::uint32_t> bytes_used;  ///< the size of `content` unless told
    std::uint32_t data_offset = 0;            ///< of the plane; multi-planar only
    timeval stamp{};
};

struct EmulatedControl {
    v4l2_query_ext_ctrl about{};
    std::int64_t value = 0;
    std::vector<std::string> menu;
};

/// What the emulated driver is like.
struct EmulatedDriver {
    bool multi_planar = false;
    bool user_memory = true;
    bool selections = false;
    bool rates = true;
    std::uint32_t capabilities = V4L2_CAP_STREAMING;  ///< beside that of its API
    std::vector<std::uint32_t> formats{V4L2_PIX_FMT_GREY};
    std::uint32_t width = 16;
    std::uint32_t height = 8;
    std::uint32_t bits_per_pixel = 8;
    std::uint32_t row_padding = 0;    ///< bytes at the end of a row
    std::uint32_t frame_padding = 0;  ///< bytes behind the last row
    std::uint32_t memory_planes = 1;  ///< of a frame, in the multi-planar API
    std::uint32_t field = V4L2_FIELD_NONE;
    bool any_size = false;  ///< else it answers with width and height, whatever it is asked
    double highest_rate = 60;
    std::uint32_t max_buffers = 8;
    v4l2_rect region{};
    std::vector<EmulatedControl> controls;
};

/// The node /dev/video0, answered by this process through umockdev: "emulated ioctl". The structs,
/// mappings and errors are those of the kernel; there is no kernel driver behind them, and poll
/// finds a frame ready at all times.
class EmulatedV4l2 {
  public:
    explicit EmulatedV4l2(EmulatedDriver driver = {});
    ~EmulatedV4l2();
    EmulatedV4l2(const EmulatedV4l2&) = delete;
    EmulatedV4l2& operator=(const EmulatedV4l2&) = delete;

    void push(EmulatedFrame frame);
    /// The next ioctls of this kind fail once each, in this order; 0 lets one pass.
    void fail(unsigned long request, std::deque<int> errors);
    [[nodiscard]] int calls(unsigned long request) const;
    [[nodiscard]] bool streaming() const;
    [[nodiscard]] std::size_t queued() const;
    [[nodiscard]] std::int64_t control(std::uint32_t id) const;

    /// The signal handler of umockdev: gboolean (base, client, user data).
    static int on_ioctl(_UMockdevIoctlBase* base, _UMockdevIoctlClient* client, void* self);

  private:
    int answer(unsigned long request, void* argument);
    int capability(v4l2_capability& about) const;
    int list_format(v4l2_fmtdesc& entry) const;
    int format(v4l2_format& format, bool set);
    int rate(v4l2_streamparm& rate, bool set);
    int region(v4l2_selection& region, bool set);
    int request_buffers(v4l2_requestbuffers& request);
    int where(v4l2_buffer& buffer) const;
    int queue(v4l2_buffer& buffer);
    int dequeue(v4l2_buffer& buffer);
    int list_control(v4l2_query_ext_ctrl& query) const;
    int list_menu(v4l2_querymenu& item) const;
    int values(v4l2_ext_controls& request, bool set);

    [[nodiscard]] std::uint32_t stride() const;
    [[nodiscard]] std::uint32_t frame_bytes() const;
    [[nodiscard]] std::uint32_t buffer_span() const;

    struct Queued {
        std::uint32_t index = 0;
        unsigned long user = 0;  ///< address of user memory
    };

    mutable std::mutex mutex_;
    EmulatedDriver driver_;
    std::uint32_t fourcc_;
    v4l2_fract period_{1, 25};
    std::uint32_t memory_ = V4L2_MEMORY_MMAP;
    std::uint32_t buffers_ = 0;
    bool streaming_ = false;
    std::deque<Queued> queue_;
    std::deque<EmulatedFrame> frames_;
    std::map<unsigned long, std::deque<int>> failures_;
    std::map<unsigned long, int> calls_;
    _UMockdevTestbed* testbed_ = nullptr;
    _UMockdevIoctlBase* handler_ = nullptr;
    std::span<std::uint8_t> file_;  ///< what clients map
};

}  // namespace stipple
