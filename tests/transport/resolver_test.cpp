// Names become addresses, whatever name servers do.
#include "transport/address/resolver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "tests/support/fake_names.hpp"

namespace lightnet::resolver_test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using State = Whereabout::State;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> texts(const std::vector<IpAddress>& addresses) {
    std::vector<std::string> all;
    for (const auto& one : addresses) all.push_back(one.text());
    return all;
}

class ResolverTest : public ::testing::Test {
protected:
    ~ResolverTest() override { service->end(); }
    std::shared_ptr<test::FakeNames> service = std::make_shared<test::FakeNames>();
    Resolver names{service};
};

TEST_F(ResolverTest, KnowsNumbersAndThisMachineWithoutAsking) {
    EXPECT_THAT(texts(names.look("10.0.0.1", Clock::now()).addresses), ElementsAre("10.0.0.1"));
    EXPECT_THAT(texts(names.look("fe80::1%eth0", Clock::now()).addresses), ElementsAre("fe80::1%eth0"));
    EXPECT_THAT(texts(names.look("localhost", Clock::now()).addresses), ElementsAre("127.0.0.1", "::1"));
    EXPECT_EQ(service->asked("localhost"), 0);
}

TEST_F(ResolverTest, FindsAllAddressesOfANameAndAsksOnce) {
    service->put("two.lab", {"10.0.0.1", "fd00::1"});
    EXPECT_THAT(texts(names.wait_for("two.lab", 10s).addresses), ElementsAre("10.0.0.1", "fd00::1"));
    EXPECT_EQ(names.look("two.lab", Clock::now()).state, State::found);
    EXPECT_EQ(service->asked("two.lab"), 1);
}

TEST_F(ResolverTest, SaysWhichNameNobodyHas) {
    const auto gone = names.wait_for("render9.lab", 10s);
    EXPECT_EQ(gone.state, State::gone);
    EXPECT_THAT(gone.why, HasSubstr("'render9.lab'"));
}

TEST_F(ResolverTest, IsHeldUpByNoSilentServer) {
    service->silence("silent.lab");
    service->put("well.lab", {"10.0.0.2"});
    const auto begun = Clock::now();
    EXPECT_EQ(names.look("silent.lab", begun).state, State::asked);
    EXPECT_EQ(names.wait_for("well.lab", 20s).state, State::found);
    const auto late = names.look("silent.lab", begun + 1min);
    EXPECT_EQ(late.state, State::unknown);
    EXPECT_THAT(late.why, HasSubstr("no name server says where 'silent.lab' is"));
    EXPECT_EQ(names.wait_for("silent.lab", 50ms).state, State::unknown);
    EXPECT_EQ(service->asked("silent.lab"), 1) << "one lookup at a time";
}

TEST_F(ResolverTest, EndsWhileALookupHangs) {
    service->silence("silent.lab");
    {
        Resolver other{service};
        other.look("silent.lab", Clock::now());
    }
    SUCCEED() << "nobody waited";
}

TEST_F(ResolverTest, AsksAnewForWhatIsOldAndKeepsItMeanwhile) {
    service->put("moving.lab", {"10.0.0.1"});
    names.wait_for("moving.lab", 10s);
    service->put("moving.lab", {"10.0.0.9"});
    const auto later = Clock::now() + 5s;
    EXPECT_THAT(texts(names.look("moving.lab", later, 2s).addresses), ElementsAre("10.0.0.1")) << "as long as it asks";
    while (names.look("moving.lab", Clock::now()).addresses.at(0).text() != "10.0.0.9" && Clock::now() < later + 1min)
        std::this_thread::yield();
    service->remove("moving.lab");
    names.look("moving.lab", Clock::now() + 10s, 2s);
    while (names.look("moving.lab", Clock::now()).state != State::gone && Clock::now() < later + 2min)
        std::this_thread::yield();
    EXPECT_THAT(texts(names.look("moving.lab", Clock::now()).addresses), ElementsAre("10.0.0.9"))
        << "where it was may still be right";
}

TEST(Names, AreCalledInBothFamiliesByTurns) {
    std::vector<IpAddress> all;
    for (const auto* one : {"fd00::1", "fd00::2", "fd00::3", "10.0.0.1"}) all.push_back(*ip_address(one));
    EXPECT_THAT(texts(in_turns(all)), ElementsAre("fd00::1", "10.0.0.1", "fd00::2", "fd00::3"));
    EXPECT_THAT(in_turns({}), IsEmpty());
}

}  // namespace
}  // namespace lightnet::resolver_test
