// Hosts that dial in at the launcher's port, and others who knock.
#include <gmock/gmock.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/modes/stranger.hpp"
#include "transport/launcher/cluster.hpp"
#include "transport/launcher/join_listener.hpp"
#include "transport/zmq/zmq_hosts.hpp"

namespace lightnet::joiners_test {
namespace {

using packet::Fields;
using packet::Type;
using test::Stranger;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class JoinersTest : public ::testing::Test {
protected:
    // Takes in what comes, until `enough`.
    template <class Enough>
    bool wait_for(const Enough& enough) {
        const auto end = std::chrono::steady_clock::now() + test::slowdown * std::chrono::seconds(20);
        while (!enough() && std::chrono::steady_clock::now() < end) {
            Poll poll;
            joiners.watch(poll);
            poll.wait(std::chrono::milliseconds(20));
            broken += joiners.receive(
                {[this](const std::string& endpoint, const auto&) { called.push_back(endpoint); },
                 [this](const std::string& name, std::unique_ptr<JoinedConnection> made, const auto&) {
                     connections[name] = std::move(made);
                 },
                 [this](const std::string& name, const std::string& why) { lost.push_back(name + ": " + why); },
                 [] {
                     return std::vector<HostState>{{"onyx1", "is ready", true, 2, 7, {}}};
                 },
                 [this](const std::string& name, const std::string&) { turned_down.push_back(name); }});
        }
        return enough();
    }
    // Says who it is, learns the challenge, and proves that it knows the pass.
    void join(Stranger& host, const Pass::Claim& claim, const std::string& secret = "the pass of this run's user") {
        Fields fields;
        fields.set("name", claim.name).set("process", claim.process).set("endpoint", claim.endpoint);
        if (challenge.empty()) {
            host.send(packet::pack(Type::join, 0, fields));
            int looks = 0;
            wait_for([&] { return ++looks > 5; });
            const auto [type, said] = host.receive();
            EXPECT_EQ(type, Type::joined);
            challenge = said.text("challenge");
        }
        fields.set("proof", Pass(secret).proof(challenge, claim));
        host.send(packet::pack(Type::join, 0, fields));
    }

    std::shared_ptr<HostTransport> hosts = zmq_hosts();
    JoinListener joiners{*hosts, "tcp://127.0.0.1:*", Pass("the pass of this run's user")};
    std::string challenge;
    std::vector<std::string> called, lost, turned_down;
    std::map<std::string, std::unique_ptr<JoinedConnection>> connections;
    std::uint64_t broken = 0;
};

TEST_F(JoinersTest, GiveEachHostAConnectionUnderItsName) {
    Stranger host(joiners.endpoint());
    join(host, {"onyx1", 1, ""});
    ASSERT_TRUE(wait_for([&] { return connections.contains("onyx1"); }));
    EXPECT_EQ(host.receive().first, Type::joined);
    auto frames = frames_of(packet::pack(Type::hello, 1, {}));
    EXPECT_TRUE(connections["onyx1"]->send(frames, false));
    EXPECT_EQ(host.receive().first, Type::hello);
    host.send(packet::pack(Type::welcome, 1, {}));
    bool arrived = false;
    EXPECT_TRUE(wait_for([&] { return arrived |= connections["onyx1"]->receive().has_value(); }));
}

TEST_F(JoinersTest, KnowAHostThatDialsInAgainAndSayThatItWasCut) {
    auto host = std::make_unique<Stranger>(joiners.endpoint());
    join(*host, {"onyx1", 1, ""});
    ASSERT_TRUE(wait_for([&] { return connections.contains("onyx1"); }));
    host = std::make_unique<Stranger>(joiners.endpoint());
    join(*host, {"onyx1", 1, ""});
    ASSERT_TRUE(wait_for([&] { return !lost.empty(); }));
    EXPECT_THAT(lost, ElementsAre("onyx1: its connection was cut"));
    EXPECT_EQ(connections.size(), 1u);
}

TEST_F(JoinersTest, TellTwoHostsOfOneNameApart) {
    Stranger one(joiners.endpoint()), two(joiners.endpoint());
    join(one, {"onyx1", 1, ""});
    ASSERT_TRUE(wait_for([&] { return connections.contains("onyx1"); }));
    // Both keep in touch; so the first is not the predecessor of the second.
    ASSERT_TRUE(wait_for([&] {
        join(one, {"onyx1", 1, ""});
        join(two, {"onyx1", 2, ""});
        return connections.size() == 2;
    }));
    EXPECT_TRUE(connections.contains("onyx1-2"));
    EXPECT_THAT(lost, IsEmpty());
}

TEST_F(JoinersTest, GiveANewProcessTheNameOfItsDeadPredecessor) {
    auto host = std::make_unique<Stranger>(joiners.endpoint());
    join(*host, {"onyx1", 1, ""});
    ASSERT_TRUE(wait_for([&] { return connections.contains("onyx1"); }));
    host = std::make_unique<Stranger>(joiners.endpoint());
    ASSERT_TRUE(wait_for([&] {
        join(*host, {"onyx1", 2, ""});
        return !lost.empty();
    }));
    EXPECT_THAT(lost, ElementsAre("onyx1: it was started anew"));
    EXPECT_EQ(connections.size(), 1u);
}

TEST_F(JoinersTest, CallBackWhoHasAPort) {
    Stranger host(joiners.endpoint());
    join(host, {"onyx1", 1, "tcp://0.0.0.0:7777"});
    ASSERT_TRUE(wait_for([&] { return !called.empty(); }));
    EXPECT_THAT(called, ElementsAre("tcp://127.0.0.1:7777")) << "at the address from which it came";
    EXPECT_THAT(connections, IsEmpty());
}

TEST_F(JoinersTest, CallBackWhoListensInBothFamiliesAndNobodyByAName) {
    Stranger host(joiners.endpoint()), named(joiners.endpoint());
    join(host, {"onyx1", 1, "tcp://[::]:7777"});
    ASSERT_TRUE(wait_for([&] { return !called.empty(); }));
    EXPECT_THAT(called, ElementsAre("tcp://127.0.0.1:7777")) << "at the address from which it came";
    join(named, {"onyx2", 2, "tcp://onyx2:7777"});
    join(host, {"onyx1", 1, "tcp://10.0.0.1:7777"});
    ASSERT_TRUE(wait_for([&] { return called.size() > 1; }));
    EXPECT_EQ(called.back(), "tcp://10.0.0.1:7777") << "what a host says is no reason to look names up";
}

TEST_F(JoinersTest, LetNobodyInWhoDoesNotKnowThePass) {
    Stranger host(joiners.endpoint());
    join(host, {"onyx1", 1, ""}, "another pass, of another user");
    ASSERT_TRUE(wait_for([&] { return !turned_down.empty(); }));
    const auto [type, said] = host.receive();
    EXPECT_EQ(type, Type::joined);
    EXPECT_EQ(said.number("turned_down"), 1u) << "it is told why nothing happens";
    // Nor does a proof count for another name, process or port than it was made for.
    const auto proof = Pass("the pass of this run's user").proof(challenge, {"onyx1", 1, ""});
    for (const auto& claim : {Pass::Claim{"onyx2", 1, ""}, {"onyx1", 2, ""}, {"onyx1", 1, "tcp://127.0.0.1:7777"}})
        host.send(packet::pack(Type::join, 0,
                               Fields{}
                                   .set("name", claim.name)
                                   .set("process", claim.process)
                                   .set("endpoint", claim.endpoint)
                                   .set("proof", proof)));
    ASSERT_TRUE(wait_for([&] { return turned_down.size() == 4; }));
    EXPECT_THAT(connections, IsEmpty());
    EXPECT_THAT(called, IsEmpty());
}

TEST_F(JoinersTest, CallNothingButTcp) {
    for (const auto* endpoint : {"inproc://reports", "ipc:///tmp/somewhere", "tipc://{1,0,2}"}) {
        Stranger host(joiners.endpoint());
        join(host, {"onyx1", 1, endpoint});
        const auto before = broken;
        ASSERT_TRUE(wait_for([&] { return broken > before; })) << endpoint;
    }
    EXPECT_THAT(called, IsEmpty());
}

TEST_F(JoinersTest, TellStrangersNoNumberOfARun) {
    Stranger anyone(joiners.endpoint());
    anyone.send(packet::pack(Type::join, 0, Fields{}.set("name", "onyx1").set("process", 1)));
    anyone.send(packet::pack(Type::status, 0, {}));
    for (int answers = 0; answers < 2; ++answers) {
        int looks = 0;
        wait_for([&] { return ++looks > 5; });
        EXPECT_NE(anyone.receive().first, Type::ping) << "no answer";
        EXPECT_EQ(anyone.run(), 0u);
    }
}

TEST_F(JoinersTest, TellAnyoneHowTheHostsAre) {
    Stranger anyone(joiners.endpoint());
    anyone.send(packet::pack(Type::status, 0, {}));
    int looks = 0;
    wait_for([&] { return ++looks > 5; });
    const auto [type, fields] = anyone.receive();
    EXPECT_EQ(type, Type::state);
    EXPECT_EQ(fields.text("name"), "onyx1");
    EXPECT_EQ(fields.number("progress"), 7u);
}

TEST_F(JoinersTest, CountWhatStrangersSay) {
    Stranger anyone(joiners.endpoint());
    anyone.send("nonsense");
    anyone.send(packet::pack(Type::end, 1, {}));
    anyone.send(packet::pack(Type::join, 0, Fields{}.set("name", "no process")));
    ASSERT_TRUE(wait_for([&] { return broken == 3; }));
    EXPECT_THAT(connections, IsEmpty());
}

}  // namespace
}  // namespace lightnet::joiners_test
