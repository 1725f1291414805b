// Preloaded (LD_PRELOAD), this makes calls fail that do not fail on a healthy machine. The program
// is started and linked once; for each order that comes through the pipe FAULT_ORDERS its main()
// runs in a process of its own, and how it ended and its numbers of calls go to the pipe
// FAULT_REPORTS.
//
// What is met: calls from the program and its libraries. What is not: calls within the C library,
// such as the write() of fwrite() and the mmap() of malloc(), so fdopen() gives a stream here that
// calls the write() below, and fread() fails as a whole. What runs before and after
// main() is not met: libraries end the process there (GLib). Nor is dlopen(): glibc 2.36 crashes
// where a library is not found and there is no memory for the message.

#include <dirent.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "tests/apps/preloaded.h"

namespace {

// As tests/apps/faults.py has them.
enum Kind : int {
    kAny,
    kOpen,
    kRead,
    kWrite,
    kSync,
    kRename,
    kCut,
    kRemove,
    kMemory,
    kMap,
    kThread
};
constexpr int kKinds = 11;
constexpr int kKill = -1;   ///< in place of an error number: SIGKILL
constexpr int kShort = -2;  ///< half of the bytes are written
constexpr unsigned kSecondsBeforeHang = 60;

struct Order {
    int kind;
    int number;  ///< the call that fails, from 1; 0: none
    int error;
    int lasting;    ///< all further ones fail too
    int min_bytes;  ///< of kMemory, smaller ones neither count nor fail
};

struct Report {
    int status;
    int calls[kKinds];
};

Order order;
std::atomic<int>* calls = nullptr;  ///< shared with the process that waits
std::atomic<bool> in_main{false};
thread_local bool in_dlopen = false;

bool is_due(int kind) {
    const int number = ++calls[kind];
    if (order.kind != kind || order.number == 0) return false;
    return order.lasting != 0 ? number >= order.number : number == order.number;
}

/// Whether this call is to fail, with errno; does not return where it is to end the process.
bool fails(Kind kind) {
    if (!in_main || in_dlopen) return false;
    if (kind != kWrite && is_due(kAny)) kill(getpid(), SIGKILL);
    if (!is_due(kind)) return false;
    if (order.error == kKill) kill(getpid(), SIGKILL);
    errno = order.error;
    return true;
}

void write_whole(int pipe, const void* bytes, std::size_t size) {
    if (next<ssize_t(int, const void*, std::size_t)>("write")(pipe, bytes, size) < 0) std::abort();
}

/// Runs main() in a process of its own for each order, until the pipe is closed.
using Main = int(int, char**, char**);
Main* real_main;

int serve(int argc, char** argv, char** environment) {
    const char* const orders = std::getenv("FAULT_ORDERS");
    if (orders == nullptr) return real_main(argc, argv, environment);
    const int in = std::atoi(orders);
    const int out = std::atoi(std::getenv("FAULT_REPORTS"));
    void* const shared = mmap(nullptr, sizeof(std::atomic<int>) * kKinds, PROT_READ | PROT_WRITE,
                              MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    auto* const counts = static_cast<std::atomic<int>*>(shared);
    while (read(in, &order, sizeof order) == sizeof order) {
        for (int kind = 0; kind < kKinds; ++kind) counts[kind] = 0;
        const pid_t child = fork();
        if (child == 0) {
            close(in);
            close(out);
            alarm(kSecondsBeforeHang);
            calls = counts;
            in_main = true;
            const int code = real_main(argc, argv, environment);
            in_main = false;
            return code;
        }
        Report report{};
        waitpid(child, &report.status, 0);
        for (int kind = 0; kind < kKinds; ++kind) report.calls[kind] = counts[kind];
        write_whole(out, &report, sizeof report);
    }
    _exit(0);
}

/// 0, or the bytes that a write() shall write before it ends the process or returns.
std::size_t cut_short(std::size_t bytes, bool& kills) {
    if (!in_main) return bytes;
    kills = is_due(kAny);
    const bool due = is_due(kWrite);
    kills = kills || (due && order.error == kKill);
    if (kills || (due && order.error == kShort)) return bytes / 2;
    errno = order.error;
    return due ? 0 : bytes;
}

/// `write_some(bytes)` writes so many. Messages are never lost.
template <typename Write>
ssize_t faulty_write(int file, std::size_t bytes, const Write& write_some) {
    if (file <= STDERR_FILENO) return write_some(bytes);
    bool kills = false;
    const std::size_t some = cut_short(bytes, kills);
    const ssize_t written = some == 0 && bytes > 0 && !kills ? -1 : write_some(some);
    if (kills) kill(getpid(), SIGKILL);
    return written;
}

}  // namespace

extern "C" {

int __libc_start_main(Main* main, int argc, char** argv, void (*init)(), void (*fini)(),
                      void (*rtld_fini)(), void* stack_end) {
    real_main = main;
    return next<int(Main*, int, char**, void (*)(), void (*)(), void (*)(), void*)>(
        "__libc_start_main")(serve, argc, argv, init, fini, rtld_fini, stack_end);
}

#define FAULTY_OPEN(NAME)                                                  \
    int NAME(const char* path, int flags, ...) {                           \
        va_list rest;                                                      \
        va_start(rest, flags);                                             \
        const auto mode = va_arg(rest, mode_t);                            \
        va_end(rest);                                                      \
        if (fails(kOpen)) return -1;                                       \
        return next<int(const char*, int, ...)>(#NAME)(path, flags, mode); \
    }
FAULTY_OPEN(open)
FAULTY_OPEN(open64)

#define FAULTY_OPENAT(NAME)                                                             \
    int NAME(int folder, const char* path, int flags, ...) {                            \
        va_list rest;                                                                   \
        va_start(rest, flags);                                                          \
        const auto mode = va_arg(rest, mode_t);                                         \
        va_end(rest);                                                                   \
        if (fails(kOpen)) return -1;                                                    \
        return next<int(int, const char*, int, ...)>(#NAME)(folder, path, flags, mode); \
    }
FAULTY_OPENAT(openat)
FAULTY_OPENAT(openat64)

#define FAULTY(KIND, RESULT, FAILURE, NAME, PARAMETERS, ARGUMENTS) \
    RESULT NAME PARAMETERS {                                       \
        if (fails(KIND)) return FAILURE;                           \
        return next<RESULT PARAMETERS>(#NAME) ARGUMENTS;           \
    }
FAULTY(kOpen, FILE*, nullptr, fopen, (const char* path, const char* mode), (path, mode))
FAULTY(kOpen, FILE*, nullptr, fopen64, (const char* path, const char* mode), (path, mode))
FAULTY(kOpen, DIR*, nullptr, opendir, (const char* path), (path))
FAULTY(kOpen, int, -1, mkdir, (const char* path, mode_t mode) noexcept, (path, mode))
FAULTY(kRead, ssize_t, -1, read, (int file, void* bytes, std::size_t size), (file, bytes, size))
FAULTY(kRead, ssize_t, -1, pread, (int file, void* bytes, std::size_t size, off_t offset),
       (file, bytes, size, offset))
FAULTY(kSync, int, -1, fsync, (int file), (file))
FAULTY(kSync, int, -1, fdatasync, (int file), (file))
FAULTY(kRename, int, -1, rename, (const char* from, const char* to) noexcept, (from, to))
FAULTY(kRename, int, -1, renameat2,
       (int from_folder, const char* from, int to_folder, const char* to, unsigned flags) noexcept,
       (from_folder, from, to_folder, to, flags))
FAULTY(kCut, int, -1, ftruncate, (int file, off_t bytes) noexcept, (file, bytes))
FAULTY(kCut, int, -1, truncate, (const char* path, off_t bytes) noexcept, (path, bytes))
FAULTY(kRemove, int, -1, unlink, (const char* path) noexcept, (path))
FAULTY(kRemove, int, -1, unlinkat, (int folder, const char* path, int flags) noexcept,
       (folder, path, flags))
FAULTY(kRemove, int, -1, remove, (const char* path) noexcept, (path))
FAULTY(kRemove, int, -1, rmdir, (const char* path) noexcept, (path))
FAULTY(kMap, void*, MAP_FAILED, mmap,
       (void* at, std::size_t size, int protection, int flags, int file, off_t offset) noexcept,
       (at, size, protection, flags, file, offset))

std::size_t fread(void* bytes, std::size_t size, std::size_t count, FILE* stream) {
    if (!fails(kRead))
        return next<std::size_t(void*, std::size_t, std::size_t, FILE*)>("fread")(bytes, size,
                                                                                  count, stream);
    stream->_flags |= _IO_ERR_SEEN;
    return 0;
}

ssize_t write(int file, const void* bytes, std::size_t size) {
    return faulty_write(file, size, [&](std::size_t some) {
        return next<ssize_t(int, const void*, std::size_t)>("write")(file, bytes, some);
    });
}

ssize_t pwrite(int file, const void* bytes, std::size_t size, off_t offset) {
    return faulty_write(file, size, [&](std::size_t some) {
        return next<ssize_t(int, const void*, std::size_t, off_t)>("pwrite")(file, bytes, some,
                                                                             offset);
    });
}

/// Of the first part only, as a short write.
ssize_t writev(int file, const iovec* parts, int count) {
    while (count > 1 && parts->iov_len == 0) ++parts, --count;
    return write(file, parts->iov_base, parts->iov_len);
}

FILE* fdopen(int file, const char* mode) noexcept {
    if (!in_main || mode[0] != 'w') return next<FILE*(int, const char*)>("fdopen")(file, mode);
    return stream_of(file, mode);
}

void* dlopen(const char* path, int mode) noexcept {
    in_dlopen = true;
    void* const library = next<void*(const char*, int)>("dlopen")(path, mode);
    in_dlopen = false;
    return library;
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*),
                   void* argument) noexcept {
    if (fails(kThread)) return errno;
    return next<int(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)>("pthread_create")(
        thread, attributes, run, argument);
}

// The allocator of the C library, which needs no look-up.
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* old, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);

static bool memory_fails(std::size_t bytes) {
    return bytes >= static_cast<std::size_t>(order.min_bytes) && fails(kMemory);
}

void* malloc(std::size_t bytes) noexcept {
    return memory_fails(bytes) ? nullptr : __libc_malloc(bytes);
}

void* calloc(std::size_t count, std::size_t bytes) noexcept {
    return memory_fails(count * bytes) ? nullptr : __libc_calloc(count, bytes);
}

void* realloc(void* old, std::size_t bytes) noexcept {
    return memory_fails(bytes) ? nullptr : __libc_realloc(old, bytes);
}

void* memalign(std::size_t alignment, std::size_t bytes) noexcept {
    return memory_fails(bytes) ? nullptr : __libc_memalign(alignment, bytes);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) noexcept {
    return memalign(alignment, bytes);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t bytes) noexcept {
    void* const got = memalign(alignment, bytes);
    if (got == nullptr) return ENOMEM;
    *memory = got;
    return 0;
}

}  // extern "C"
