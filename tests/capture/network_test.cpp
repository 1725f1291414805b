#include "capture/network.h"

#include <gtest/gtest.h>
#include <net/if.h>

#include <algorithm>

namespace stipple {
namespace {

TEST(NetworkTest, AddressesAreNumbersInHostByteOrder) {
    EXPECT_EQ(parse_ipv4("192.168.0.5"), 0xC0A80005U);
    EXPECT_EQ(ipv4_text(0xC0A80005U), "192.168.0.5");
    for (const char* text : {"", "camera", "192.168.0", "192.168.0.256", "::1"})
        EXPECT_FALSE(parse_ipv4(text).has_value()) << text;
    EXPECT_FALSE(parse_ipv4(std::string("1.2.3.4\0 5", 10)).has_value());
}

TEST(NetworkTest, AnAddressLiesAtTheInterfaceOfItsNetwork) {
    for (const NetworkInterface& one : network_interfaces()) {
        const auto found = interface_at(one.address ^ 1U);
        if (one.netmask == 0xFFFFFFFF) continue;  // alone in its network
        ASSERT_TRUE(found.has_value()) << one.name;
        EXPECT_EQ(found->address & found->netmask, one.address & found->netmask);
        EXPECT_EQ(found->index, static_cast<int>(if_nametoindex(found->name.c_str())));
    }
    EXPECT_FALSE(interface_at(0xFFFFFFFF).has_value());  // broadcast, nobody's own
}

TEST(NetworkTest, LoopbackAddressesAreReachedByTheLoopbackInterface) {
    const auto all = network_interfaces();
    const auto is_up = [](const NetworkInterface& one) { return one.is_loopback && one.is_up; };
    if (std::none_of(all.begin(), all.end(), is_up)) GTEST_SKIP() << "no loopback interface is up";
    const auto found = interface_towards("127.0.0.77");
    ASSERT_TRUE(found.has_value());
    EXPECT_TRUE(found->is_loopback);
    EXPECT_GE(found->mtu, 68);  // RFC 791
}

TEST(NetworkTest, ATextThatIsNoAddressLeadsNowhere) {
    EXPECT_FALSE(interface_towards("camera").has_value());
    EXPECT_FALSE(interface_towards("").has_value());
}

}  // namespace
}  // namespace stipple
