// Preloaded (LD_PRELOAD), this writes what a program does to files and folders to the file
// DISK_JOURNAL, for tests/apps/power_loss_test.py: a line for each call that succeeded, of words
// that a tab ends. Files are named by their inode, for they change their names; bytes are
// hexadecimal.

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <string>

#include "tests/apps/preloaded.h"

namespace {

void note(std::initializer_list<std::string> words) {
    const char* const journal = std::getenv("DISK_JOURNAL");
    if (journal == nullptr) return;
    static const int file = next<int(const char*, int, ...)>("open")(
        journal, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    std::string line;
    for (const std::string& word : words) line.append(word).append(1, '\t');
    line.append(1, '\n');
    if (next<ssize_t(int, const void*, std::size_t)>("write")(file, line.data(), line.size()) < 0)
        std::abort();
}

/// "" for what is neither a regular file nor a folder.
std::string inode_of(int file) {
    struct stat status {};
    if (fstat(file, &status) != 0 || !(S_ISREG(status.st_mode) || S_ISDIR(status.st_mode)))
        return "";
    return std::to_string(status.st_ino);
}

std::string inode_at(const char* path) {
    struct stat status {};
    return lstat(path, &status) == 0 ? std::to_string(status.st_ino) : "";
}

std::string hexadecimal(const void* bytes, std::size_t size) {
    constexpr char kDigits[] = "0123456789abcdef";
    std::string text;
    for (std::size_t i = 0; i < size; ++i) {
        const auto byte = static_cast<const std::uint8_t*>(bytes)[i];
        text.append({kDigits[byte >> 4U], kDigits[byte & 15U]});
    }
    return text;
}

void note_write(int file, const void* bytes, ssize_t written, off_t offset) {
    const std::string inode = inode_of(file);
    if (written > 0 && file > STDERR_FILENO && !inode.empty())
        note({"write", inode, std::to_string(offset),
              hexadecimal(bytes, static_cast<std::size_t>(written))});
}

int noted_open(const char* call, const char* path, int flags, mode_t mode) {
    const bool there = access(path, F_OK) == 0;
    const int file = next<int(const char*, int, ...)>(call)(path, flags, mode);
    if (file >= 0 && !there) note({"create", inode_of(file), path});
    if (file >= 0 && there && (flags & O_TRUNC) != 0) note({"cut", inode_of(file), "0"});
    return file;
}

/// 0 as `result` means success.
int noted(int result, std::initializer_list<std::string> words) {
    if (result == 0) note(words);
    return result;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    const auto mode = va_arg(rest, mode_t);
    va_end(rest);
    return noted_open("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    const auto mode = va_arg(rest, mode_t);
    va_end(rest);
    return noted_open("open64", path, flags, mode);
}

ssize_t write(int file, const void* bytes, std::size_t size) {
    const off_t offset = lseek(file, 0, SEEK_CUR);
    const auto written = next<ssize_t(int, const void*, std::size_t)>("write")(file, bytes, size);
    note_write(file, bytes, written, offset);
    return written;
}

ssize_t pwrite(int file, const void* bytes, std::size_t size, off_t offset) {
    const auto written =
        next<ssize_t(int, const void*, std::size_t, off_t)>("pwrite")(file, bytes, size, offset);
    note_write(file, bytes, written, offset);
    return written;
}

int ftruncate(int file, off_t bytes) noexcept {
    return noted(next<int(int, off_t)>("ftruncate")(file, bytes),
                 {"cut", inode_of(file), std::to_string(bytes)});
}

int fsync(int file) {
    return noted(next<int(int)>("fsync")(file), {"sync", inode_of(file)});
}

int mkdir(const char* path, mode_t mode) noexcept {
    const int result = next<int(const char*, mode_t)>("mkdir")(path, mode);
    return noted(result, {"mkdir", inode_at(path), path});
}

int rename(const char* from, const char* to) noexcept {
    return noted(next<int(const char*, const char*)>("rename")(from, to), {"rename", from, to});
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to,
              unsigned flags) noexcept {
    const bool exchange = (flags & RENAME_EXCHANGE) != 0;
    return noted(next<int(int, const char*, int, const char*, unsigned)>("renameat2")(
                     from_folder, from, to_folder, to, flags),
                 {exchange ? "exchange" : "rename", from, to});
}

int unlink(const char* path) noexcept {
    return noted(next<int(const char*)>("unlink")(path), {"remove", path});
}

int remove(const char* path) noexcept {
    return noted(next<int(const char*)>("remove")(path), {"remove", path});
}

int rmdir(const char* path) noexcept {
    return noted(next<int(const char*)>("rmdir")(path), {"remove", path});
}

FILE* fdopen(int file, const char* mode) noexcept {
    if (mode[0] != 'w') return next<FILE*(int, const char*)>("fdopen")(file, mode);
    return stream_of(file, mode);
}

}  // extern "C"
