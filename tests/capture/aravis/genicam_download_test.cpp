#include "capture/aravis/genicam_description.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <thread>

#include "capture/network.h"
#include "capture/serve/big_endian.h"
#include "capture/serve/gige_registers.h"
#include "capture/serve/gvcp_codec.h"
#include "capture/serve/udp_socket.h"
#include "core/error.h"
#include "tests/capture/aravis/zip_of.h"
#include "tests/support/private_network.h"

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint32_t kCamera = 0x7F000009;
constexpr std::uint32_t kPlace = 0x10000;
const std::string kXml = "<?xml version=\"1.0\"?>\n<RegisterDescription></RegisterDescription>";

/// Answers READMEM from a URL and a description, whatever is at work on it.
class DescribedBy {
  public:
    DescribedBy(const std::string& url, Bytes content, bool pending_only = false)
        : url_(bytes_of(url)), content_(std::move(content)), pending_only_(pending_only) {
        url_.resize(512);
    }

  private:
    void serve(const std::stop_token& stop) const {
        while (!stop.stop_requested()) {
            pollfd readable{socket_.descriptor(), POLLIN, 0};
            if (poll(&readable, 1, 20) <= 0) continue;
            const auto command = socket_.receive();
            const std::uint8_t* const data = command->bytes.data();
            const auto address = load_be<std::uint32_t>(data + 8);
            const auto bytes = load_be<std::uint32_t>(data + 12);
            Bytes answer(2);
            append_be(answer, static_cast<std::uint16_t>(pending_only_ ? 0x89 : 0x85));
            append_be(answer, static_cast<std::uint16_t>(4 + bytes));
            append_be(answer, load_be<std::uint16_t>(data + 6));
            append_be(answer, address);
            const bool is_url = address < kPlace;
            const Bytes& memory = is_url ? url_ : content_;
            for (std::uint32_t i = 0; i < bytes; ++i) {
                const std::size_t at = address - (is_url ? gige::kXmlUrl : kPlace) + i;
                answer.push_back(at < memory.size() ? memory[at] : 0);
            }
            socket_.send(command->from, answer);
        }
    }

    Bytes url_;
    Bytes content_;
    bool pending_only_;
    UdpSocket socket_{{kCamera, kGvcpPort}};
    std::jthread thread_{[this](const std::stop_token& stop) { serve(stop); }};
};

class GenicamDownloadTest : public testing::Test {
  protected:
    void SetUp() override {
        if (const std::string why = enter_private_network(); !why.empty()) GTEST_SKIP() << why;
    }
    static std::string problem() {
        try {
            check_genicam_download("gige:c", kCamera);
        } catch (const DeviceError& e) {
            return e.what();
        }
        return {};
    }
    /// Of a camera with this URL; its size is that of `content` unless it is given.
    static std::string problem_of(const std::string& url, const Bytes& content) {
        const DescribedBy camera(url, content);
        return problem();
    }
    static std::string local(const std::string& name, std::size_t bytes) {
        std::string hex;
        for (; bytes > 0; bytes /= 16) hex.insert(0, 1, "0123456789ABCDEF"[bytes % 16]);
        return "Local:" + name + ";10000;" + hex;
    }
};

TEST_F(GenicamDownloadTest, ADescriptionInTheCameraIsTaken) {
    EXPECT_EQ(problem_of(local("c.xml", kXml.size()), bytes_of(kXml)), "");
    EXPECT_EQ(problem_of("LOCAL:///c.xml;0x10000;41?SchemaVersion=1.1.0",
                         bytes_of(kXml + std::string(0x41 - kXml.size(), ' '))),
              "");
    const Bytes zip = zip_of(bytes_of(kXml + std::string(5000, ' ')), true);
    EXPECT_EQ(problem_of(local("c.zip", zip.size()), zip), "");
}

TEST_F(GenicamDownloadTest, ADescriptionElsewhereIsRefused) {
    for (const char* url : {"file:///dev/zero", "File:c.xml", "http:c.xml", "", "x"})
        EXPECT_NE(problem_of(url, {}).find("which is not in the camera"), std::string::npos) << url;
    for (const char* url : {"Local:c.xml", "Local:c.xml;10000", "Local:;;", "Local:c.xml;x;10"})
        EXPECT_NE(problem_of(url, {}).find("without address and size"), std::string::npos) << url;
}

TEST_F(GenicamDownloadTest, ADescriptionOfAnySizeIsNotTaken) {
    for (const char* size : {"FFFFFFFFFFFFFFFF", "7FFFFFFF", "1000001", "0"})
        EXPECT_NE(problem_of(std::string("Local:c.xml;10000;") + size, {}).find("are read"),
                  std::string::npos)
            << size;
    const Bytes zip = zip_of(Bytes((1U << 24U) + 1, ' '), true);
    EXPECT_NE(problem_of(local("c.zip", zip.size()), zip).find("more than 16777216 bytes"),
              std::string::npos);
}

TEST_F(GenicamDownloadTest, WhatIsNoXmlIsNamedAsSuch) {
    const std::string text = "Camera Maker-Model 1\n" + kXml;
    EXPECT_NE(problem_of(local("c.xml", text.size()), bytes_of(text)).find("not well-formed XML"),
              std::string::npos);
    EXPECT_NE(problem_of(local("c.xml", 20), Bytes(20)).find("not well-formed XML"),
              std::string::npos);
}

TEST_F(GenicamDownloadTest, ACameraThatIsNotThereOrAlwaysAsksForTimeIsGivenUp) {
    EXPECT_NE(problem().find("no camera answers"), std::string::npos);
    const DescribedBy camera(local("c.xml", kXml.size()), bytes_of(kXml), true);
    EXPECT_NE(problem().find("stops answering"), std::string::npos);
}

}  // namespace
}  // namespace stipple
