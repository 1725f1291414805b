#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace stipple {

struct PageServerOptions {
    std::string address = "127.0.0.1";  ///< of the network interface; "0.0.0.0" or "::" for all
    int port = 0;                       ///< 0: a free one
};

/// What a browser asks for.
struct PageRequest {
    std::string path;                         ///< without the token, such as "plane/v0-12"
    std::map<std::string, std::string> keys;  ///< after the "?"
    bool acts = false;                        ///< POST: changes something

    /// The whole number of a key; nothing if it is absent, or is not one.
    [[nodiscard]] std::optional<std::int64_t> number(const std::string& key) const;
    /// The text of a key; empty if it is absent.
    [[nodiscard]] std::string text(const std::string& key) const;
};

struct PageAnswer {
    std::string type;                                ///< "text/html; charset=utf-8"
    std::string body = {};                           ///< bytes
    std::map<std::string, std::string> fields = {};  ///< further header fields
};

/// Serves one page, and what it asks for, to browsers that have its address. The address holds a
/// random token of 128 bits; requests without it, of another host or from the pages of others are
/// refused. Each request has a thread, up to 64.
class PageServer {
  public:
    /// Answers a request, by any thread; nothing: there is no such thing. An InputError becomes
    /// status 400 with its text.
    using Handler = std::function<std::optional<PageAnswer>(const PageRequest& request)>;

    /// Serves from now on. \throws DeviceError if the address or the port cannot be used.
    PageServer(const PageServerOptions& options, Handler handler);
    /// Ends the requests under way. The handler must not wait for long.
    ~PageServer();
    PageServer(const PageServer&) = delete;
    PageServer& operator=(const PageServer&) = delete;

    /// The address of the page, with its token.
    [[nodiscard]] std::string url() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
