#pragma once

#include <fcntl.h>
#include <linux/capability.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace stipple {

/// Gives this process, and those that it starts, a loopback interface of their own, so that tests
/// that run at the same time may use the same ports. To be called once, before other threads start.
/// Returns an empty text, or why it cannot be had here.
inline std::string enter_private_network() {
    static bool entered = false;
    if (entered) return {};
    if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0 && unshare(CLONE_NEWNET) != 0)
        return std::string("no network namespace can be made: ") + std::strerror(errno);
    const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    ifreq request{};
    std::strcpy(request.ifr_name, "lo");
    request.ifr_flags = IFF_UP;
    const bool up = ioctl(socket, SIOCSIFFLAGS, &request) == 0;
    const int error = errno;
    ::close(socket);
    if (!up) return std::string("the loopback interface does not come up: ") + std::strerror(error);
    entered = true;
    return {};
}

/// From here on this process is an ordinary user's: it may open no packet sockets.
inline bool drop_capabilities() {
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    __user_cap_data_struct none[2]{};
    return syscall(SYS_capset, &header, none) == 0;
}

}  // namespace stipple
