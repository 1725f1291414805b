#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cerrno>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/config.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/footage.h"
#include "view/page_server.h"
#include "view/view_page.h"

namespace stipple::python {
namespace {

/// A page and its server.
class Window {
  public:
    Window(const ViewOptions& options, const PageServerOptions& server)
        : page_(options),
          server_(std::make_unique<PageServer>(
              server, [this](const PageRequest& request) { return page_.answer(request); })),
          url_(server_->url()) {}

    [[nodiscard]] const std::string& url() const { return url_; }
    ~Window() { close(); }
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;
    void close() {
        page_.end();
        server_.reset();
    }

  private:
    ViewPage page_;
    std::unique_ptr<PageServer> server_;  ///< after the page, which it asks
    std::string url_;
};

std::unique_ptr<Window> opened(std::vector<std::filesystem::path> sources,
                               std::filesystem::path truth, const std::string& method,
                               const PageServerOptions& server) {
    std::vector<Message> warnings;
    std::vector<std::filesystem::path> files = sources;
    if (!truth.empty()) files.push_back(truth);
    std::unique_ptr<Window> window;
    try {
        const py::gil_scoped_release release;
        window = std::make_unique<Window>(
            ViewOptions{.sources = std::move(sources),
                        .truth = std::move(truth),
                        .footage = {},
                        .decoding = read_decode_setup(method, Config(std::vector<std::string>{})),
                        .calibration = {},
                        .command = {},
                        .warn = [&](const Message& text) { warnings.push_back(text); }},
            server);
    } catch (const InputError& error) {
        for (const auto& file : files)
            if (!std::filesystem::exists(file) && !file.empty())
                throw FileError(ENOENT, in_python(error.message()));
        throw;
    }
    for (const Message& warning : warnings) warn(warning, 3);
    return window;
}

}  // namespace

void bind_view(py::module_& module) {
    py::class_<Window>(module, "Window")
        .def(py::init([](std::vector<std::filesystem::path> sources, std::filesystem::path truth,
                         const std::string& method, const std::string& address, int port) {
            return opened(std::move(sources), std::move(truth), method, {address, port});
        }))
        .def_property_readonly("url", &Window::url)
        .def("close", &Window::close, py::call_guard<py::gil_scoped_release>());
}

}  // namespace stipple::python
