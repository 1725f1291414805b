#pragma once

#include <dlfcn.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>

// What the libraries that tests preload have in common.

/// The function that the library stands before.
template <typename Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

/// A stream that calls the write(), lseek64() and close() of the library, which one of the C
/// library does not.
inline FILE* stream_of(int file, const char* mode) {
    static constexpr auto file_of = [](void* cookie) {
        return static_cast<int>(reinterpret_cast<std::intptr_t>(cookie));
    };
    const auto write_all = [](void* cookie, const char* bytes, std::size_t size) {
        std::size_t done = 0;
        for (ssize_t some = 1; some > 0 && done < size; done += static_cast<std::size_t>(some))
            some = std::max<ssize_t>(write(file_of(cookie), bytes + done, size - done), 0);
        return static_cast<ssize_t>(done);
    };
    const auto seek = [](void* cookie, off64_t* offset, int whence) {
        *offset = lseek64(file_of(cookie), *offset, whence);
        return *offset < 0 ? -1 : 0;
    };
    const auto close_file = [](void* cookie) { return close(file_of(cookie)); };
    return fopencookie(reinterpret_cast<void*>(static_cast<std::intptr_t>(file)), mode,
                       {nullptr, write_all, seek, close_file});
}
