#include "view/page_server.h"

#include <fmt/format.h>
#include <httplib.h>
#include <openssl/rand.h>
#include <sys/socket.h>

#include <array>
#include <atomic>
#include <charconv>
#include <chrono>
#include <exception>
#include <string_view>
#include <thread>
#include <utility>

#include "core/error.h"

namespace stipple {
namespace {

constexpr std::size_t kThreads = 64;
constexpr std::size_t kMaxBody = 64 * 1024;
constexpr int kWaitSeconds = 5;
constexpr int kKeepAliveSeconds = 1;  // for so long the server may take to end

std::string random_token() {
    std::array<unsigned char, 16> bytes{};
    if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1)
        throw DeviceError("view", "the system has no random numbers for the address of the page");
    std::string token;
    for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
    return token;
}

/// Whether two texts are equal, in a time that does not tell where they differ.
bool equal_in_constant_time(std::string_view a, std::string_view b) {
    if (a.size() != b.size()) return false;
    unsigned difference = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        difference |= static_cast<unsigned>(a[i]) ^ static_cast<unsigned>(b[i]);
    return difference == 0;
}

bool is_loopback(std::string_view address) {
    return address.starts_with("127.") || address == "localhost" || address == "::1";
}

std::string in_url(const std::string& host) {
    return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

/// Only this program takes the port: SO_REUSEPORT, httplib's default, would share it.
void set_socket_options(socket_t socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
}

}  // namespace

std::optional<std::int64_t> PageRequest::number(const std::string& key) const {
    const auto found = keys.find(key);
    if (found == keys.end()) return {};
    const std::string& text = found->second;
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return {};
    return value;
}

std::string PageRequest::text(const std::string& key) const {
    const auto found = keys.find(key);
    return found == keys.end() ? std::string() : found->second;
}

struct PageServer::Impl {
    Impl(const PageServerOptions& options, Handler answer)
        : address(options.address), handler(std::move(answer)), token(random_token()) {
        server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
        server.set_payload_max_length(kMaxBody);
        server.set_read_timeout(kWaitSeconds);
        server.set_write_timeout(kWaitSeconds);
        server.set_keep_alive_timeout(kKeepAliveSeconds);
        server.set_tcp_nodelay(true);
        server.set_socket_options(set_socket_options);
        const auto take = [this](const httplib::Request& request, httplib::Response& response) {
            respond(request, response);
        };
        server.Get(".*", take);
        server.Post(".*", take);
        server.set_exception_handler([](const auto&, httplib::Response& response, auto failure) {
            describe(failure, response);
        });
        port = options.port;
        const bool bound = port == 0 ? (port = server.bind_to_any_port(address)) > 0
                                     : server.bind_to_port(address, port);
        if (!bound)
            throw DeviceError(fmt::format("{}:{}", in_url(address), options.port),
                              "is no address of this machine, or its port is in use; choose with " +
                                  (Parameter{"address"} + " and " + Parameter{"port"}));
        thread = std::thread([this] {
            server.listen_after_bind();
            ended = true;
        });
    }
    ~Impl() {
        // A server that has not begun would not stop.
        while (!server.is_running() && !ended)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        server.stop();
        thread.join();
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    static void describe(const std::exception_ptr& failure, httplib::Response& response) {
        response.status = 500;
        try {
            std::rethrow_exception(failure);
        } catch (const InputError& e) {
            response.status = 400;
            response.set_content(e.what(), "text/plain; charset=utf-8");
        } catch (const std::exception& e) {
            response.set_content(e.what(), "text/plain; charset=utf-8");
        } catch (...) {
            response.set_content("unknown failure", "text/plain; charset=utf-8");
        }
    }

    /// A page of another place may know the port, but has another origin; a name of another place
    /// that leads here (DNS rebinding) is another host.
    [[nodiscard]] bool is_ours(const httplib::Request& request) const {
        const std::string host = request.get_header_value("Host");
        const auto at_port = [this](const std::string& name) {
            return fmt::format("{}:{}", in_url(name), port);
        };
        if (is_loopback(address) && host != at_port(address) && host != at_port("localhost"))
            return false;
        return !request.has_header("Origin") ||
               request.get_header_value("Origin") == "http://" + host;
    }

    void respond(const httplib::Request& request, httplib::Response& response) const {
        response.set_header("Cache-Control", "no-store");
        response.set_header("Referrer-Policy", "no-referrer");
        response.set_header("X-Content-Type-Options", "nosniff");
        response.set_header("Cross-Origin-Resource-Policy", "same-origin");
        const std::string_view path = request.path;
        const std::string_view after = path.size() > token.size() + 1 ? path.substr(1) : "";
        if (!is_ours(request) || !equal_in_constant_time(after.substr(0, token.size()), token) ||
            after[token.size()] != '/') {
            response.status = 403;
            response.set_content("This address is not that of a page.", "text/plain");
            return;
        }
        PageRequest asked{std::string(after.substr(token.size() + 1)), {}, false};
        for (const auto& [key, value] : request.params) asked.keys.emplace(key, value);
        asked.acts = request.method == "POST";
        const auto answer = handler(asked);
        if (!answer) {
            response.status = 404;
            response.set_content("There is nothing of this name.", "text/plain");
            return;
        }
        for (const auto& [name, value] : answer->fields) response.set_header(name, value);
        response.set_content(answer->body, answer->type);
    }

    std::string address;
    Handler handler;
    std::string token;
    int port = 0;
    httplib::Server server;
    std::atomic<bool> ended = false;
    std::thread thread;
};

PageServer::PageServer(const PageServerOptions& options, Handler handler)
    : impl_(std::make_unique<Impl>(options, std::move(handler))) {}

PageServer::~PageServer() = default;

std::string PageServer::url() const {
    const bool all = impl_->address == "0.0.0.0" || impl_->address == "::";
    return fmt::format("http://{}:{}/{}/", all ? "127.0.0.1" : in_url(impl_->address), impl_->port,
                       impl_->token);
}

}  // namespace stipple
