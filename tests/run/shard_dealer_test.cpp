#include "core/run/master/shard_dealer.hpp"

#include <gmock/gmock.h>

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/network/light/mapped.hpp"
#include "tests/support/fake_channel.hpp"

namespace lightnet::shard_dealer_test {
namespace {

// Shards that went together.
struct Shards {
    std::uint32_t first = 0, count = 0;
    friend bool operator==(const Shards&, const Shards&) = default;
};
constexpr Shards only(std::uint32_t shard) { return {shard, 1}; }

// The results of so many shards, which are one byte each.
Bytes results(std::uint32_t count, int value = 0) {
    return join_shards(
        std::vector<std::vector<std::byte>>(count, std::vector<std::byte>(1, static_cast<std::byte>(value))));
}

// Tells a dealer stories about the places a, b and c, each on a host of its own.
class ShardDealerTest : public ::testing::Test {
protected:
    void begin(std::uint32_t count, const std::vector<std::string>& hosts, SpotChecks checks = {}) {
        ShardDealer::Job job;
        job.node = "caustics";
        job.count = count;
        job.checks = checks;
        job.clock = [this] { return now; };
        job.done = [this](std::uint32_t first, const Bytes& joined) {
            for (const auto& result : split_shards(joined)) done[first++].push_back(static_cast<int>(result.front()));
        };
        job.at_fault = [this](const Failure& failure) { at_fault.push_back(failure.why); };
        job.doubt = [this](const Failure& lie) { lies.push_back(lie); };
        dealer.emplace(std::move(job));
        for (const auto& host : hosts) join(host);
    }
    void join(const std::string& host, std::uint64_t process = 1) {
        auto& channel = channels.emplace_back(2);
        channel.where = host;
        channel.number = process;
        there[host] = &channel;
        use();
    }
    void use() {
        std::vector<Channel<Step>*> all, leave;
        for (const auto& [host, channel] : there) {
            all.push_back(channel);
            if (leaving.contains(host)) leave.push_back(channel);
        }
        dealer->use(all, leave);
    }
    // What each is told to do.
    using Dealt = std::map<std::string, std::vector<Shards>>;
    Dealt deal(bool more = true) {
        dealer->deal(there.size(), more);
        Dealt dealt;
        for (const auto& [host, channel] : there)
            for (; !channel->sent.empty(); channel->sent.pop_front()) {
                const auto& bundle = channel->sent.front();
                const Step& step = bundle.questions->front();
                dealt[host].push_back({step.first, step.count});
                asked[{host, step.first}] = bundle;
            }
        return dealt;
    }
    void answer(const std::string& host, std::uint32_t first, std::uint32_t count = 1, int value = 0) {
        const auto& bundle = asked.at({host, first});
        bundle.owner->answered(bundle, results(count, value));
    }
    void fail(const std::string& host, std::uint32_t first) {
        const auto& bundle = asked.at({host, first});
        bundle.owner->failed(bundle, {"on " + host + ": no memory", host});
    }
    void lose(const std::string& host) {
        there.erase(host);
        use();
    }
    std::set<std::uint32_t> counted() const {
        std::set<std::uint32_t> shards;
        for (const auto& [shard, values] : done) shards.insert(shard);
        return shards;
    }

    double now = 0;
    std::deque<test::FakeChannel<Step>> channels;
    std::map<std::string, test::FakeChannel<Step>*> there;
    std::set<std::string> leaving;
    std::map<std::pair<std::string, std::uint32_t>, Bundle<Step>> asked;
    std::map<std::uint32_t, std::vector<int>> done;  // values that counted, by shard
    std::vector<std::string> at_fault;
    std::vector<Failure> lies;
    std::optional<ShardDealer> dealer;
};

TEST_F(ShardDealerTest, GivesEachShardOnceAndTheLastOnesToThoseWhoAreIdle) {
    begin(5, {"a", "b"});
    EXPECT_EQ(deal(), (Dealt{{"a", {only(0), only(2)}}, {"b", {only(1)}}})) << "two are left, for who is idle first";
    now = 1;
    answer("a", 0);
    EXPECT_EQ(deal(), Dealt{}) << "it still has one";
    answer("b", 1);
    EXPECT_EQ(deal(), (Dealt{{"b", {only(3)}}}));
    now = 2;
    answer("a", 2);
    EXPECT_EQ(deal(), (Dealt{{"a", {only(4)}}}));
    answer("b", 3);
    EXPECT_EQ(deal(), Dealt{}) << "nobody is late";
    now = 2.5;
    EXPECT_EQ(deal(), Dealt{});
    EXPECT_EQ(dealer->missing(), 1u);
}

TEST_F(ShardDealerTest, GivesWhatSomebodyIsLateWithToWhoIsIdle) {
    begin(2, {"a", "b"});
    EXPECT_EQ(deal(), (Dealt{{"a", {only(0)}}, {"b", {only(1)}}}));
    now = 0.1;
    answer("a", 0);
    now = 0.35;
    EXPECT_EQ(deal(), Dealt{}) << "it was to take as long as the other one, after that";
    now = 0.45;
    EXPECT_EQ(deal(), (Dealt{{"a", {only(1)}}}));
    answer("a", 1, 1, 7);
    answer("b", 1, 1, 8);
    EXPECT_THAT(done[1], testing::ElementsAre(7)) << "the first answer counts";
}

TEST_F(ShardDealerTest, GivesOutAgainWhatALostPlaceHad) {
    begin(2, {"a", "b"});
    deal();
    lose("b");
    answer("a", 0);
    EXPECT_EQ(deal(), (Dealt{{"a", {only(1)}}}));
    answer("b", 1);
    EXPECT_EQ(dealer->missing(), 1u);
}

TEST_F(ShardDealerTest, AsksNobodyWhoWasToldToStop) {
    begin(6, {"a", "b"});
    deal();
    leaving.insert("b");
    use();
    answer("b", 1);
    EXPECT_TRUE(counted().contains(1)) << "it answers what it has";
    answer("a", 0), answer("a", 2);
    const auto more = deal();
    EXPECT_TRUE(more.contains("a"));
    EXPECT_FALSE(more.contains("b"));
}

TEST_F(ShardDealerTest, GivesSeveralTogetherWhileThereAreManyAndTheRestOfThemToOthers) {
    begin(20, {"a", "b"});
    const auto first = deal();
    EXPECT_EQ(first.at("a").front(), (Shards{0, 3}));
    EXPECT_EQ(first.at("b").front(), (Shards{3, 2}));
    now = 1;
    answer("b", 3, 1);
    EXPECT_EQ(counted(), (std::set<std::uint32_t>{3})) << "it did one of them";
    const auto more = deal();
    ASSERT_TRUE(more.contains("b"));
    EXPECT_EQ(more.at("b").front(), only(4));
}

TEST_F(ShardDealerTest, AsksSomebodyElseWhereOneFailed) {
    begin(1, {"a", "b"});
    const auto first = deal();
    const std::string sick = first.begin()->first, healthy = sick == "a" ? "b" : "a";
    fail(sick, 0);
    EXPECT_THAT(at_fault, testing::ElementsAre("on " + sick + ": no memory"));
    EXPECT_EQ(deal(), (Dealt{{healthy, {only(0)}}}));
    answer(healthy, 0);
    EXPECT_EQ(dealer->missing(), 0u);
    fail(sick, 0);
    EXPECT_EQ(at_fault.size(), 1u) << "it came late";
    EXPECT_FALSE(dealer->error());
}

TEST_F(ShardDealerTest, EndsWithWhatASecondHostCannotDoEither) {
    begin(1, {"a", "b"});
    const auto first = deal();
    const std::string sick = first.begin()->first, too = sick == "a" ? "b" : "a";
    fail(sick, 0);
    deal();
    fail(too, 0);
    ASSERT_TRUE(dealer->error());
    EXPECT_EQ(dealer->error()->what(), "on " + too + ": no memory");
}

TEST_F(ShardDealerTest, KeepsWhatFailedForThoseWhoComeLater) {
    begin(1, {"a"});
    deal();
    fail("a", 0);
    lose("a");
    join("b");
    EXPECT_EQ(deal(), (Dealt{{"b", {only(0)}}}));
}

TEST_F(ShardDealerTest, EndsWhereNobodyElseWillCome) {
    begin(1, {"a"});
    deal(false);
    fail("a", 0);
    ASSERT_TRUE(dealer->error());
    EXPECT_EQ(dealer->error()->what(), std::string("on a: no memory"));
}

TEST_F(ShardDealerTest, TakesNoAnswerThatCannotBeOne) {
    ShardDealer::Job job;
    job.node = "caustics";
    job.count = 1;
    job.check = [](std::uint32_t, const Bytes&) { throw Error("results of preparing", "they are damaged"); };
    job.at_fault = [this](const Failure& failure) { at_fault.push_back(failure.host + "; " + failure.why); };
    dealer.emplace(std::move(job));
    join("a"), join("b");
    deal();
    answer("a", 0);
    EXPECT_THAT(at_fault, testing::ElementsAre("a; 'caustics' on a: results of preparing: they are damaged"));
    EXPECT_EQ(dealer->missing(), 1u);
}

TEST_F(ShardDealerTest, NamesTheShardThatKillsHostsThoughItWentWithOthers) {
    begin(12, {"a"});
    constexpr std::uint32_t poison = 4;
    for (std::uint64_t process = 2; process < 200 && !dealer->error(); ++process) {
        bool died = false;
        for (const auto& [host, all] : deal())
            for (const auto& some : all) {
                died = died || (some.first <= poison && poison < some.first + some.count);
                if (!died) answer(host, some.first, some.count);
            }
        if (!died) continue;
        lose("a");
        join("a", process);
    }
    ASSERT_TRUE(dealer->error());
    EXPECT_STREQ(dealer->error()->what(),
                 "caustics: shard 4 of what a node prepares is set aside: hosts died of it, with nothing else to do: "
                 "a, a, a");
    EXPECT_FALSE(counted().contains(poison));
}

// ---- what is checked ----

class CheckedShards : public ShardDealerTest {
protected:
    // One host does all its shards falsely. Who is named.
    std::vector<std::string> with_liar(const std::string& liar, const std::vector<std::string>& hosts) {
        constexpr std::uint32_t count = 12;
        there.clear(), done.clear(), lies.clear();
        begin(count, hosts, {1'000'000, 1});
        for (int turn = 0; turn < 100 && dealer->missing() > 0; ++turn)
            for (const auto& [host, all] : deal(false))
                for (const auto& some : all) {
                    EXPECT_EQ(some.count, 1u) << "two can only be compared where both did all";
                    answer(host, some.first, some.count, host == liar ? 99 : static_cast<int>(some.first));
                }
        EXPECT_EQ(dealer->missing(), 0u) << "it waits for ever";
        std::vector<std::string> names;
        for (const auto& lie : lies) names.push_back(lie.host);
        return names;
    }
};

TEST_F(CheckedShards, ShowWhoseAreFalse) {
    const auto named = with_liar("b", {"a", "b", "c"});
    ASSERT_FALSE(named.empty());
    EXPECT_THAT(named, testing::Each("b"));
    EXPECT_THAT(lies.front().why, testing::HasSubstr("shard"));
    for (const auto& [shard, values] : done) EXPECT_THAT(values, testing::ElementsAre(static_cast<int>(shard)));
    EXPECT_THAT(with_liar("nobody", {"a", "b", "c"}), testing::IsEmpty());
    EXPECT_THAT(with_liar("nobody", {"a"}), testing::IsEmpty()) << "nobody else can be asked";
    const auto undecided = with_liar("b", {"a", "b"});
    ASSERT_FALSE(undecided.empty());
    EXPECT_THAT(undecided, testing::Each("")) << "one against one";
    EXPECT_THAT(with_liar("nobody", {"", "b"}), testing::IsEmpty());
    EXPECT_THAT(with_liar("b", {"", "b"}), testing::Each("b")) << "this process is believed";
}

TEST_F(CheckedShards, AreShownToThoseWhoJoinLater) {
    begin(1, {"a"}, {1'000'000, 1});
    deal();
    answer("a", 0, 1, 99);
    EXPECT_EQ(deal(), Dealt{});
    EXPECT_EQ(dealer->missing(), 1u) << "others will come";
    for (const std::string host : {"b", "c"}) {
        EXPECT_THAT(lies, testing::IsEmpty()) << "one against one, so far";
        join(host);
        EXPECT_EQ(deal(), (Dealt{{host, {only(0)}}}));
        answer(host, 0, 1, 5);
    }
    EXPECT_EQ(dealer->missing(), 0u);
    ASSERT_EQ(lies.size(), 1u);
    EXPECT_EQ(lies.front().host, "a");
    EXPECT_THAT(done[0], testing::ElementsAre(5));
}

}  // namespace
}  // namespace lightnet::shard_dealer_test
