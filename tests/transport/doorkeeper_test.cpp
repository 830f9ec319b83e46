// Who comes in at a door.
#include "transport/zmq/doorkeeper.hpp"

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
#include "transport/places/descriptors.hpp"
#include "transport/wire/packet.hpp"
#include "transport/zmq/handshake.hpp"

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
        socket->connect(door->endpoint());
        return socket;
    }
    // Is it greeted, as who was let in is?
    bool is_let_in(zmq::socket_t& socket, std::chrono::milliseconds most) {
        const auto end = std::chrono::steady_clock::now() + most;
        while (std::chrono::steady_clock::now() < end) {
            if (keeper) keeper->tick();
            door->receive();  // a door takes connections up when it is looked at
            if (zmq::message_t greeting; socket.recv(greeting, zmq::recv_flags::dontwait)) return true;
            std::this_thread::sleep_for(2ms);
        }
        return false;
    }

    SocketContext context;
    zmq::context_t outside;
    std::optional<Doorkeeper> keeper;
    std::optional<Socket> door;
};

TEST_F(DoorkeeperTest, LetsInWhoKnocksAndCountsThem) {
    const auto one = caller(), two = caller();
    EXPECT_TRUE(is_let_in(*one, test::slowdown * 20s));
    EXPECT_TRUE(is_let_in(*two, test::slowdown * 20s));
    EXPECT_EQ(keeper->peers(), 2u);
}

TEST_F(DoorkeeperTest, ForgetsWhoLeaves) {
    auto one = caller();
    ASSERT_TRUE(is_let_in(*one, test::slowdown * 20s));
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

class KeyedDoorTest : public ::testing::Test {
protected:
    KeyedDoorTest() {
        keeper.emplace(context, Doorkeeper::Keys{own, [this](const PublicKey& key) { return key == known.open; },
                                                 [this](const PublicKey& key, const std::string&) { told = key; },
                                                 [this] { ++without; }});
        door.emplace(door_socket(context));
        keeper->guard(*door);
        door->bind("tcp://127.0.0.1:*");
    }
    Socket caller(const std::optional<LineKeys>& keys) {
        auto socket = unconnected_asking_socket(outside, door->endpoint(), keys);
        note_handshakes(outside, socket);
        socket.connect(door->endpoint());
        return socket;
    }
    // How the handshake ends; none: not at all.
    std::optional<Handshake> handshake_of(Socket& caller, std::chrono::milliseconds most = test::slowdown * 20s) {
        const auto end = std::chrono::steady_clock::now() + most;
        while (std::chrono::steady_clock::now() < end) {
            if (keeper) keeper->tick();
            if (const auto seen = last_handshake(caller)) return seen;
            std::this_thread::sleep_for(1ms);
        }
        return std::nullopt;
    }
    // Does the door get what it sends?
    std::optional<Frames> arrives(Socket& caller, std::chrono::milliseconds most) {
        const auto end = std::chrono::steady_clock::now() + most;
        while (std::chrono::steady_clock::now() < end) {
            if (keeper) keeper->tick();
            caller.receive();
            auto frames = frames_of(packet::pack(packet::Type::hello, 0, {}));
            caller.send(frames);
            if (auto arrived = door->receive(&sender)) return arrived;
            std::this_thread::sleep_for(1ms);
        }
        return std::nullopt;
    }

    SocketContext context, outside;
    const KeyPair own = KeyPair::random(), known = KeyPair::random(), stranger = KeyPair::random();
    std::optional<Doorkeeper> keeper;
    std::optional<Socket> door;
    std::optional<PublicKey> told;
    PeerName sender;
    int without = 0;
};

TEST_F(KeyedDoorTest, KnowsByItsKeyWhoSendsWhat) {
    auto friendly = caller(LineKeys{known, own.open});
    EXPECT_EQ(handshake_of(friendly), Handshake::made);
    const auto frames = arrives(friendly, test::slowdown * 20s);
    ASSERT_TRUE(frames);
    EXPECT_EQ(sender.key, known.open.text());
    EXPECT_NO_THROW(keeper->try_out(*door));
}

TEST_F(KeyedDoorTest, TurnsAwayWrongKeysUnknownKeysAndNone) {
    auto unknown = caller(LineKeys{stranger, own.open});
    EXPECT_EQ(handshake_of(unknown), Handshake::refused);
    EXPECT_EQ(told, stranger.open);
    auto mistaken = caller(LineKeys{known, stranger.open});
    EXPECT_EQ(handshake_of(mistaken), Handshake::abandoned);
    auto plain = caller(std::nullopt);
    EXPECT_THAT(handshake_of(plain), testing::AnyOf(Handshake::mismatched, Handshake::abandoned))
        << "who sees it first";
    EXPECT_GT(without, 0);
    for (auto* one : {&unknown, &mistaken, &plain}) EXPECT_FALSE(arrives(*one, 300ms));
}

TEST_F(KeyedDoorTest, LetsNobodyInWhenItsKeeperIsGone) {
    keeper.reset();
    for (const auto& keys : {LineKeys{known, own.open}, LineKeys{stranger, own.open}}) {
        auto one = caller(keys);
        EXPECT_FALSE(arrives(one, 500ms));
    }
}

TEST_F(KeyedDoorTest, IsNotUsedWhenAStrangerGetsIn) {
    const SocketContext elsewhere;
    Doorkeeper careless(elsewhere, Doorkeeper::Keys{own, [](const PublicKey&) { return true; }});
    auto open_door = door_socket(elsewhere);
    careless.guard(open_door);
    open_door.bind("tcp://127.0.0.1:*");
    try {
        careless.try_out(open_door);
        FAIL() << "nobody noticed";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("lets strangers in"), std::string::npos) << error.what();
    }
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

// A socket that closes in the middle of a handshake, or just before, must not take the library's thread with it.
TEST_F(KeyedDoorTest, LinesThatCloseInTheMiddleOfAHandshakeHoldUpNoOthers) {
    const LineKeys keys{known, own.open};
    for (int i = 0; i < 400; ++i) {
        auto closing = caller(keys);
        const auto end = std::chrono::steady_clock::now() + i % 40 * 50us;
        while (std::chrono::steady_clock::now() < end) keeper->tick(), door->receive();
    }
    auto last = caller(keys);
    EXPECT_EQ(handshake_of(last, test::slowdown * 10s), Handshake::made);
}

}  // namespace
}  // namespace lightnet::doorkeeper_test
