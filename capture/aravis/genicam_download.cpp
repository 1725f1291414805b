#include "capture/aravis/genicam_description.h"

#include <fmt/format.h>
#include <poll.h>
#include <strings.h>
#include <tinyxml2.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <optional>
#include <string_view>
#include <vector>

#include "capture/doctor/doctor_findings.h"
#include "capture/serve/big_endian.h"
#include "capture/serve/gige_registers.h"
#include "capture/serve/gvcp_codec.h"
#include "capture/serve/udp_socket.h"
#include "core/error.h"
#include "stream/plain_text.h"

namespace stipple {
namespace {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;
using Clock = std::chrono::steady_clock;

/// Descriptions of cameras have some 100 kB, at most 4 MB.
constexpr std::size_t kMaxBytes = std::size_t{16} << 20U;
constexpr auto kMaxTime = 60s;
constexpr auto kAnswerTime = 500ms;
constexpr int kTries = 6;
constexpr std::size_t kUrlBytes = 512;
constexpr std::uint16_t kPendingAck = 0x89;

/// Why a description cannot be used; the caller knows whose it is.
struct Unusable {
    std::string why;
};

/// Reads the memory of a camera. Any program may, whoever controls the camera.
class CameraMemory {
  public:
    explicit CameraMemory(std::uint32_t ip) : camera_{ip, kGvcpPort} {}

    [[nodiscard]] Bytes read(std::uint32_t address, std::size_t bytes) {
        Bytes content;
        while (content.size() < bytes) {
            const std::size_t left = bytes - content.size();
            // In words, as the registers of GigE Vision are.
            const auto piece = static_cast<std::uint32_t>(
                std::min((left + 3) / 4 * 4, std::size_t{kMaxGvcpMemoryBytes}));
            const Bytes part =
                read_piece(address + static_cast<std::uint32_t>(content.size()), piece);
            content.insert(content.end(), part.begin(), part.end());
        }
        content.resize(bytes);
        return content;
    }

  private:
    [[nodiscard]] Bytes read_piece(std::uint32_t address, std::uint32_t bytes) {
        Bytes command;
        append_be(command, address);
        append_be(command, bytes);
        ++id_;
        for (int i = 0; i < kTries && Clock::now() < end_; ++i) {
            socket_.send(camera_, encode_gvcp_command(GvcpCode::kReadMemory, id_, command));
            if (auto answer = wait(bytes)) return std::move(*answer);
        }
        throw Unusable{answered_ ? "stops answering while its description is read" : ""};
    }

    /// The bytes asked for; empty if they do not come in time.
    [[nodiscard]] std::optional<Bytes> wait(std::size_t bytes) {
        auto until = Clock::now() + kAnswerTime;
        while (true) {
            const auto left =
                std::chrono::ceil<std::chrono::milliseconds>(std::min(until, end_) - Clock::now());
            pollfd readable{socket_.descriptor(), POLLIN, 0};
            if (left <= 0ms || poll(&readable, 1, static_cast<int>(left.count())) <= 0) return {};
            const auto answer = socket_.receive();
            if (!answer || answer->from != camera_ || answer->bytes.size() < kGvcpHeaderBytes)
                continue;
            const std::uint8_t* const data = answer->bytes.data();
            if (load_be<std::uint16_t>(data + 6) != id_) continue;
            answered_ = true;
            const auto code = load_be<std::uint16_t>(data + 2);
            if (code == kPendingAck) until = Clock::now() + kAnswerTime;
            if (code != static_cast<std::uint16_t>(GvcpCode::kReadMemory) + 1) continue;
            if (const auto status = load_be<std::uint16_t>(data); status != 0)
                throw Unusable{
                    fmt::format("refuses to be asked for its description (0x{:04x})", status)};
            constexpr std::size_t kHead = kGvcpHeaderBytes + 4;  // with the address
            if (answer->bytes.size() < kHead + bytes) continue;
            return Bytes(data + kHead, data + kHead + bytes);
        }
    }

    UdpEndpoint camera_;
    UdpSocket socket_{{0, 0}};
    Clock::time_point end_ = Clock::now() + kMaxTime;
    std::uint16_t id_ = 0;
    bool answered_ = false;
};

struct Place {
    std::uint32_t address = 0;
    std::size_t bytes = 0;
    bool zipped = false;
};

/// The hex number `text`; empty if it is none.
std::optional<std::uint64_t> hex_number(std::string_view text) {
    if (text.starts_with("0x") || text.starts_with("0X")) text.remove_prefix(2);
    std::uint64_t value = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value, 16);
    if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size()) return {};
    return value;
}

/// Of "Local:NAME;ADDRESS;SIZE", with "?SchemaVersion=..." behind it or not.
Place place_of(const Bytes& memory) {
    const std::string url(memory.begin(), std::find(memory.begin(), memory.end(), 0));
    std::string_view text(url);
    const auto refuse = [&](const std::string& why) {
        throw Unusable{fmt::format("names \"{}\" as its description{}", terminal_text(url), why)};
    };
    if (strncasecmp(url.c_str(), "local:", 6) != 0) refuse(", which is not in the camera");
    text = text.substr(0, text.find('?'));
    const auto second = text.rfind(';');
    const auto first = second == text.npos || second == 0 ? text.npos : text.rfind(';', second - 1);
    if (first == text.npos) refuse(" without address and size");
    const auto address = hex_number(text.substr(first + 1, second - first - 1));
    const auto bytes = hex_number(text.substr(second + 1));
    if (!address || *address > 0xFFFFFFFF || !bytes) refuse(" without address and size");
    if (*bytes == 0 || *bytes > kMaxBytes)
        refuse(fmt::format(" of {} bytes: 1 to {} are read", *bytes, kMaxBytes));
    return {static_cast<std::uint32_t>(*address), *bytes, text.substr(0, first).ends_with(".zip")};
}

void check_description(CameraMemory& memory) {
    const Place place = place_of(memory.read(gige::kXmlUrl, kUrlBytes));
    Bytes xml = memory.read(place.address, place.bytes);
    if (place.zipped) {
        auto content = unzipped_description(xml, kMaxBytes);
        if (!content)
            throw Unusable{
                fmt::format("has a description in a zip file that is damaged, or of "
                            "more than {} bytes",
                            kMaxBytes)};
        xml = std::move(*content);
    }
    tinyxml2::XMLDocument parsed;
    if (parsed.Parse(reinterpret_cast<const char*>(xml.data()), xml.size()) !=
            tinyxml2::XML_SUCCESS ||
        parsed.RootElement() == nullptr)
        throw Unusable{
            fmt::format("describes itself in what is not well-formed XML (line {}): ask "
                        "its maker for another firmware",
                        parsed.ErrorLineNum())};
}

}  // namespace

void check_genicam_download(const std::string& address, std::uint32_t ip) {
    try {
        CameraMemory memory(ip);
        check_description(memory);
    } catch (const Unusable& unusable) {
        if (!unusable.why.empty()) throw DeviceError(address, unusable.why);
        throw DeviceError(
            address, fmt::format("no camera answers: check power, cable and that the address is "
                                 "in the subnet of an interface of this machine{}",
                                 kAskDoctor));
    }
}

}  // namespace stipple
