// Our server and Aravis as its client: two implementations that have nothing in common.
#include <arv.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>

#include "capture/serve/gige_registers.h"
#include "tests/capture/serve/gige_serving.h"

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Unref {
    void operator()(void* object) const { g_object_unref(object); }
};
template <typename T>
using Owned = std::unique_ptr<T, Unref>;

/// The message of an Aravis error, which it frees; empty without one.
std::string take(GError*& error) {
    const std::string text = error == nullptr ? "" : error->message;
    g_clear_error(&error);
    return text;
}

/// What Aravis made of a block.
struct Received {
    ArvBufferStatus status = ARV_BUFFER_STATUS_UNKNOWN;
    std::uint64_t id = 0;
    std::uint64_t stamp = 0;
    Bytes bytes;
    std::map<std::string, std::int64_t> chunks;
};

class GigeAravisTest : public ::testing::Test {
  protected:
    void open(GigeServerOptions options = {}) {
        serving_ = std::make_unique<GigeServing>(*source_, options);
        if (!serving_->failure().empty()) GTEST_SKIP() << serving_->failure();
        GError* error = nullptr;
        camera_.reset(arv_camera_new(ipv4_text(serving_->address()).c_str(), &error));
        ASSERT_TRUE(camera_) << take(error);
        device_ = arv_camera_get_device(camera_.get());
        // Frames go over UDP sockets, with root's rights or without.
        arv_gv_device_set_stream_options(ARV_GV_DEVICE(device_),
                                         ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
        arv_gv_device_set_packet_size(ARV_GV_DEVICE(device_), 9000, nullptr);
    }

    void set(const char* feature, const char* value) {
        GError* error = nullptr;
        arv_device_set_features_from_string(device_, (std::string(feature) + "=" + value).c_str(),
                                            &error);
        ASSERT_EQ(take(error), "") << feature;
    }

    /// All that comes until `frames` buffers are back, or nothing for two seconds.
    std::vector<Received> stream(std::size_t frames, const std::vector<std::string>& chunks = {}) {
        GError* error = nullptr;
        const Owned<ArvStream> stream(
            arv_camera_create_stream(camera_.get(), nullptr, nullptr, &error));
        EXPECT_EQ(take(error), "");
        if (!stream) return {};
        // Where the machine pauses this client and the socket overflows, all that is missing is
        // asked for again, and waited for.
        g_object_set(stream.get(), "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED,
                     "socket-buffer-size", 4 << 20, "packet-request-ratio", 1.0, "frame-retention",
                     500'000, nullptr);
        const Owned<ArvChunkParser> parser(arv_camera_create_chunk_parser(camera_.get()));
        const auto payload = arv_camera_get_payload(camera_.get(), &error);
        for (int i = 0; i < 50; ++i)
            arv_stream_push_buffer(stream.get(), arv_buffer_new_allocate(payload));
        arv_camera_start_acquisition(camera_.get(), &error);
        EXPECT_EQ(take(error), "");
        std::vector<Received> received;
        while (received.size() < frames) {
            ArvBuffer* buffer = arv_stream_timeout_pop_buffer(stream.get(), 2'000'000);
            if (buffer == nullptr) break;
            received.push_back(content_of(buffer, parser.get(), chunks));
            arv_stream_push_buffer(stream.get(), buffer);
        }
        arv_camera_stop_acquisition(camera_.get(), &error);
        EXPECT_EQ(take(error), "");
        resent_ = arv_stream_get_info_uint64_by_name(stream.get(), "n_resent_packets");
        return received;
    }

    static Received content_of(ArvBuffer* buffer, ArvChunkParser* parser,
                               const std::vector<std::string>& chunks) {
        Received received;
        received.status = arv_buffer_get_status(buffer);
        received.id = arv_buffer_get_frame_id(buffer);
        received.stamp = arv_buffer_get_timestamp(buffer);
        if (received.status != ARV_BUFFER_STATUS_SUCCESS) return received;
        std::size_t size = 0;
        const auto* data = static_cast<const std::uint8_t*>(arv_buffer_get_data(buffer, &size));
        received.bytes.assign(data, data + size);
        for (const std::string& chunk : chunks) {
            GError* error = nullptr;
            received.chunks[chunk] =
                arv_chunk_parser_get_integer_value(parser, buffer, chunk.c_str(), &error);
            EXPECT_EQ(take(error), "") << chunk;
        }
        return received;
    }

    void expect_bit_exact(const std::vector<Received>& received, std::size_t frames,
                          const char* format) {
        EXPECT_EQ(received.size(), frames);
        std::size_t good = 0;
        for (const Received& frame : received) {
            const bool same =
                frame.status == ARV_BUFFER_STATUS_SUCCESS &&
                frame.bytes == source_->bytes(frame.id - 1, *pixel_format_named(format));
            good += same ? 1U : 0U;
        }
        EXPECT_EQ(good, frames) << format;
    }

    // So small that a socket holds a dozen frames, whatever the machine's limit.
    std::unique_ptr<NoiseFrames> source_ = std::make_unique<NoiseFrames>(
        128, 64, std::vector<std::string>{"Mono8", "Mono10p", "Mono12p", "Mono16"}, 40);
    std::unique_ptr<GigeServing> serving_;
    Owned<ArvCamera> camera_;
    ArvDevice* device_ = nullptr;
    std::uint64_t resent_ = 0;
};

class GigeAravisFormatTest : public GigeAravisTest,
                             public ::testing::WithParamInterface<const char*> {};

TEST_P(GigeAravisFormatTest, FramesAreBitExact) {
    if (pixel_format_named(GetParam()) == nullptr) GTEST_SKIP() << "not among the pixel formats";
    open();
    set("PixelFormat", GetParam());
    expect_bit_exact(stream(40), 40, GetParam());
}

INSTANTIATE_TEST_SUITE_P(, GigeAravisFormatTest,
                         ::testing::Values("Mono8", "Mono10p", "Mono12p", "Mono16"),
                         [](const auto& format) { return std::string(format.param); });

TEST_F(GigeAravisTest, DroppedPacketsAreAskedForAndComeAgain) {
    GigeServerOptions options;
    options.faults.drop = 0.05;
    open(options);
    arv_gv_device_set_packet_size(ARV_GV_DEVICE(device_), 1500, nullptr);
    expect_bit_exact(stream(40), 40, "Mono8");
    EXPECT_GT(resent_, 0U);
}

TEST_F(GigeAravisTest, ReorderedAndDoubledPacketsMakeWholeFrames) {
    GigeServerOptions options;
    options.faults.reorder = true;
    options.faults.duplicate = 0.1;
    open(options);
    arv_gv_device_set_packet_size(ARV_GV_DEVICE(device_), 1500, nullptr);
    expect_bit_exact(stream(40), 40, "Mono8");
}

TEST_F(GigeAravisTest, PacketsLostForGoodMakeIncompleteFrames) {
    GigeServerOptions options;
    options.faults.lose = 0.05;
    open(options);
    arv_gv_device_set_packet_size(ARV_GV_DEVICE(device_), 1500, nullptr);
    std::size_t incomplete = 0;
    for (const Received& frame : stream(40))
        if (frame.status != ARV_BUFFER_STATUS_SUCCESS) ++incomplete;
    EXPECT_GT(incomplete, 5U);
}

TEST_F(GigeAravisTest, ChunksAreReadByTheirNames) {
    open();
    GError* error = nullptr;
    arv_camera_set_chunks(camera_.get(), "Slot,ExposureMapID,Timestamp", &error);
    ASSERT_EQ(take(error), "");
    const auto received = stream(40, {"ChunkSlot", "ChunkExposureMapID", "ChunkTimestamp"});
    ASSERT_EQ(received.size(), 40U);
    for (const Received& frame : received) {
        EXPECT_EQ(frame.status, ARV_BUFFER_STATUS_SUCCESS);
        EXPECT_EQ(frame.chunks.at("ChunkSlot"), static_cast<std::int64_t>(frame.id - 1));
        EXPECT_EQ(frame.chunks.at("ChunkExposureMapID"), 0);
        EXPECT_EQ(frame.chunks.at("ChunkTimestamp"), static_cast<std::int64_t>(frame.stamp));
    }
}

TEST_F(GigeAravisTest, ARegionCanBeSetAndIsCutOut) {
    open();
    set("PixelFormat", "Mono16");
    GError* error = nullptr;
    arv_camera_set_region(camera_.get(), 8, 10, 64, 20, &error);
    ASSERT_EQ(take(error), "");
    const auto received = stream(40);
    ASSERT_EQ(received.size(), 40U);
    const Bytes full = source_->bytes(received[5].id - 1, *pixel_format_named("Mono16"));
    Bytes region;
    for (std::ptrdiff_t row = 10; row < 30; ++row)
        region.insert(region.end(), full.begin() + row * 256 + 16, full.begin() + row * 256 + 144);
    EXPECT_EQ(received[5].bytes, region);
}

TEST_F(GigeAravisTest, TheLayoutIsLockedWhileItStreams) {
    open();
    GError* error = nullptr;
    arv_camera_start_acquisition(camera_.get(), &error);
    ASSERT_EQ(take(error), "");
    arv_camera_set_region(camera_.get(), 0, 0, 64, 20, &error);
    EXPECT_NE(take(error), "");
}

TEST_F(GigeAravisTest, ThePacketSizeIsFoundByTestPackets) {
    open();
    GError* error = nullptr;
    // Loopback takes up to 65536 bytes; Aravis tries up to 16384.
    EXPECT_GE(arv_gv_device_auto_packet_size(ARV_GV_DEVICE(device_), &error), 9000U);
    EXPECT_EQ(take(error), "");
}

TEST_F(GigeAravisTest, AllFeaturesOfTheXmlCanBeRead) {
    open();
    for (const char* feature :
         {"SensorWidth", "WidthMax", "Width", "Height", "OffsetX", "PayloadSize",
          "GevHeartbeatTimeout", "GevTimestampTickFrequency", "GevSCPSPacketSize", "GevSCPD",
          "AcquisitionFrameCount", "TLParamsLocked", "SourceFrameCount", "ExposureMapID"}) {
        GError* error = nullptr;
        static_cast<void>(arv_device_get_integer_feature_value(device_, feature, &error));
        EXPECT_EQ(take(error), "") << feature;
    }
    GError* error = nullptr;
    EXPECT_STREQ(arv_camera_get_vendor_name(camera_.get(), &error), "Stipple");
    EXPECT_EQ(arv_camera_get_frame_rate(camera_.get(), &error), 200);
    EXPECT_EQ(take(error), "");
}

TEST_F(GigeAravisTest, ASecondProgramCannotStream) {
    open();
    GError* error = nullptr;
    const Owned<ArvCamera> second(arv_camera_new(ipv4_text(serving_->address()).c_str(), &error));
    g_clear_error(&error);
    if (!second) return;
    const Owned<ArvStream> stream(arv_camera_create_stream(second.get(), nullptr, nullptr, &error));
    EXPECT_FALSE(stream);
    EXPECT_NE(take(error), "");
}

}  // namespace
}  // namespace stipple
