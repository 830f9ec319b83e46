// Who comes in at a door.
#include "transport/doorkeeper.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <vector>
#include <zmq.hpp>

#include "core/base/error.hpp"
#include "tests/support/slowdown.hpp"
#include "transport/descriptors.hpp"

namespace lightnet::doorkeeper_test {
namespace {

using namespace std::chrono_literals;

class DoorkeeperTest : public ::testing::Test {
protected:
    DoorkeeperTest() {
        keeper.emplace(context);
        door.emplace(door_socket(context));
        keeper->guard(*door);
        door->bind("tcp://127.0.0.1:*");
    }
    std::unique_ptr<zmq::socket_t> caller() {
        auto socket = std::make_unique<zmq::socket_t>(outside, zmq::socket_type::dealer);
        socket->set(zmq::sockopt::linger, 0);
        socket->connect(door->get(zmq::sockopt::last_endpoint));
        return socket;
    }
    // Is it greeted, as who was let in is?
    bool is_let_in(zmq::socket_t& socket, std::chrono::milliseconds most) {
        const auto end = std::chrono::steady_clock::now() + most;
        while (std::chrono::steady_clock::now() < end) {
            if (keeper) keeper->tick();
            receive_frames(*door);  // a door takes connections up when it is looked at
            if (receive_frames(socket)) return true;
            std::this_thread::sleep_for(2ms);
        }
        return false;
    }

    zmq::context_t context, outside;
    std::optional<Doorkeeper> keeper;
    std::optional<zmq::socket_t> door;
};

TEST_F(DoorkeeperTest, LetsInWhoKnocksAndCountsThem) {
    const auto one = caller(), two = caller();
    EXPECT_TRUE(is_let_in(*one, test::slowdown * 2s));
    EXPECT_TRUE(is_let_in(*two, test::slowdown * 2s));
    EXPECT_EQ(keeper->peers(), 2u);
}

TEST_F(DoorkeeperTest, ForgetsWhoLeaves) {
    auto one = caller();
    ASSERT_TRUE(is_let_in(*one, test::slowdown * 2s));
    one.reset();
    for (int turn = 0; turn < 500 && keeper->peers() > 0; ++turn) {
        keeper->tick();
        std::this_thread::sleep_for(5ms);
    }
    EXPECT_EQ(keeper->peers(), 0u);
}

TEST_F(DoorkeeperTest, TurnsAwayWhoWouldBeTooMany) {
    const auto before = descriptors_left();
    rlimit limit{};
    ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &limit), 0);
    const rlimit old = limit;
    limit.rlim_cur -= before - 100;  // (100 - 64) / 2 of them may come
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &limit), 0);
    const auto most = most_peers(100);
    std::vector<std::unique_ptr<zmq::socket_t>> callers;
    std::size_t in = 0;
    for (std::size_t i = 0; i < most + 4; ++i) {
        callers.push_back(caller());
        in += is_let_in(*callers.back(), 300ms);
    }
    setrlimit(RLIMIT_NOFILE, &old);
    EXPECT_LE(in, most);
    EXPECT_GE(in, most / 4) << "the callers' own sockets take descriptors, too";
    EXPECT_GT(keeper->turned_away(), 0u);
}

TEST_F(DoorkeeperTest, LetsNobodyInWhileItIsNotThere) {
    keeper.reset();
    const auto one = caller();
    EXPECT_FALSE(is_let_in(*one, 1s));
}

TEST(MostPeers, LeavesDescriptorsForOwnWork) {
    EXPECT_EQ(most_peers(0), 8u);
    EXPECT_EQ(most_peers(256), 96u);
    EXPECT_EQ(most_peers(1'000'000), 4096u);
}

TEST(Descriptors, ThatAreLackingAreAskedForBeforeTheyAreNeeded) {
    EXPECT_NO_THROW(want_descriptors(1, "a file"));
    try {
        want_descriptors(descriptors_left() + 1000, "64 places");
        FAIL() << "nobody noticed";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("64 places: needs"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("ulimit -n"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace lightnet::doorkeeper_test
