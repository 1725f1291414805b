#include "readout/footage_origin.h"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <memory>
#include <new>
#include <system_error>
#include <vector>

#include "core/error.h"
#include "io/camera_file.h"
#include "io/footage_files.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

/// The regular files of footage, in the order in which they are read; none of a pipe.
std::vector<fs::path> files_of(const fs::path& footage, const FootageOptions& reading) {
    if (fs::is_directory(footage)) return images_in_folder(footage).files;
    if (is_photron_name(footage) && !reading.raw) {
        const PhotronFiles files = photron_files(footage);
        return {files.header, files.frames};
    }
    if (fs::is_regular_file(footage)) return {footage};
    return fs::exists(footage) ? std::vector<fs::path>() : images_of_pattern(footage).files;
}

std::string sha256_of(const std::vector<fs::path>& files, const std::function<void()>& check) {
    // OpenSSL 3.0 uses its own state even if it had no memory for it.
    if (OSSL_LIB_CTX_get0_global_default() == nullptr) throw std::bad_alloc();
    const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> hash(EVP_MD_CTX_new(),
                                                                  EVP_MD_CTX_free);
    if (!hash || EVP_DigestInit_ex(hash.get(), EVP_sha256(), nullptr) != 1) throw std::bad_alloc();
    std::vector<char> bytes(std::size_t{1} << 20U);
    for (const fs::path& path : files) {
        std::ifstream file(path, std::ios::binary);
        while (file) {
            check();
            file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
            EVP_DigestUpdate(hash.get(), bytes.data(), static_cast<std::size_t>(file.gcount()));
        }
        if (!file.eof())
            throw InputError(path.string(),
                             "cannot be read: " + std::generic_category().message(errno));
    }
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned length = 0;
    EVP_DigestFinal_ex(hash.get(), digest.data(), &length);
    std::string text;
    for (unsigned i = 0; i < length; ++i) text += fmt::format("{:02x}", digest[i]);
    return text;
}

}  // namespace

FootageOrigin origin_of(const std::string& footage, const FootageOptions& reading,
                        const std::function<void()>& check) {
    const fs::path path(footage);
    const auto files = files_of(path, reading);
    return {.name = (path.has_filename() ? path : path.parent_path()).filename().string(),
            .sha256 = files.empty() ? "" : sha256_of(files, check),
            .reading = reading};
}

}  // namespace stipple
