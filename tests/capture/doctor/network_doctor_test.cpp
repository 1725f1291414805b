#include "capture/doctor/doctor_findings.h"

#include <gtest/gtest.h>

#include "capture/network.h"

namespace stipple {
namespace {

using Level = DoctorFinding::Level;

TEST(NetworkDoctorTest, AReceiveBufferIsJudgedOnlyWhereItIsUsed) {
    const std::int64_t small = 212992;  // the kernel's default
    const DoctorFinding finding = judge_receive_buffer(small, false);
    EXPECT_EQ(finding.level, Level::kWarning);
    EXPECT_NE(finding.fix.find("sysctl -w net.core.rmem_max=16777216"), std::string::npos);
    EXPECT_EQ(judge_receive_buffer(small, true).level, Level::kGood);
    EXPECT_EQ(judge_receive_buffer(16777216, false).level, Level::kGood);
    EXPECT_EQ(judge_receive_buffer(0, false).level, Level::kWarning);
}

TEST(NetworkDoctorTest, ASmallMtuIsWarnedOfWithTheCommandThatRaisesIt) {
    EXPECT_EQ(judge_mtu("eth0", 9000).level, Level::kGood);
    const DoctorFinding finding = judge_mtu("eth0", 1500);
    EXPECT_EQ(finding.level, Level::kWarning);
    EXPECT_NE(finding.fix.find("ip link set eth0 mtu 9000"), std::string::npos);
    EXPECT_EQ(judge_mtu("eth0", 576).level, Level::kProblem);
}

TEST(NetworkDoctorTest, EveryFindingThatIsNotGoodHasAFix) {
    for (const DoctorFinding& finding : examine_network({})) {
        EXPECT_FALSE(finding.subject.empty());
        EXPECT_FALSE(finding.fact.empty());
        EXPECT_EQ(finding.fix.empty(), finding.level <= Level::kGood) << finding.subject;
        // Neither good nor bad in itself: the receive buffer is judged by it.
        EXPECT_EQ(finding.level == Level::kFact, finding.subject == "CAP_NET_ADMIN");
    }
}

TEST(NetworkFactsTest, APortThatNobodyUsesHasNoDrops) {
    EXPECT_EQ(udp_drops(0), 0U);
    EXPECT_EQ(link_faults("no such interface"), 0U);
}

}  // namespace
}  // namespace stipple
