#include "core/run/master/service_calls.hpp"

#include <gmock/gmock.h>

#include <map>
#include <optional>

#include "core/base/error.hpp"
#include "core/network/light/mapped.hpp"

namespace lightnet::service_calls_test {
namespace {

Bytes one_byte(int value) { return std::make_shared<const std::vector<std::byte>>(1, static_cast<std::byte>(value)); }

// One result of each of these shards.
Bytes results(const std::vector<int>& values) {
    std::vector<std::vector<std::byte>> shards;
    for (const int value : values) shards.push_back(*one_byte(value));
    return join_shards(shards);
}

// One place does all shards, which are asked for one by one where there are few.
class Worker {
public:
    explicit Worker(ServiceCall& call) : call_(call) { take_more(); }
    // Under which number a shard went.
    ShardDealer::CopyId operator[](std::uint32_t shard) {
        take_more();
        return ids_.at(shard);
    }
    void take_more() {
        call_.dealer().join({{"a", 0}, 0}, 1, 0);
        for (const auto& deal : call_.dealer().deal(1, 0)) ids_[deal.shards.first] = deal.id;
    }

private:
    ServiceCall& call_;
    std::map<std::uint32_t, ShardDealer::CopyId> ids_;
};

TEST(ServiceCall, PutsShardsTogetherInTheirOrderAndCountsTheFirstAnswerOnly) {
    ServiceCall call({StepReport::Kind::map, 0, 3}, false);
    Worker worker(call);
    EXPECT_FALSE(call.answer(worker[1], results({1}), 0));
    EXPECT_FALSE(call.answer(worker[1], results({9}), 0));
    EXPECT_FALSE(call.answer(worker[0], results({0}), 0));
    EXPECT_TRUE(call.answer(worker[2], results({2}), 0));
    call.complete_from_shards();
    const Mapped<std::uint8_t> result(call.result());
    EXPECT_THAT(result.all(), testing::ElementsAre(0, 1, 2));
    EXPECT_FALSE(call.answer(worker[0], results({5}), 0)) << "too late";
}

TEST(ServiceCall, TakesNoResultsThatAreNotOfTheShardsThatWereAskedFor) {
    ServiceCall call({StepReport::Kind::map, 0, 20}, false);
    call.dealer().join({{"a", 0}, 0}, 1, 0);
    const auto deal = call.dealer().deal(1, 0).front();
    ASSERT_GT(deal.shards.count, 2u);
    EXPECT_THROW(call.answer(deal.id, results({}), 0), Error);
    EXPECT_THROW(call.answer(deal.id, results(std::vector<int>(deal.shards.count + 1)), 0), Error);
    EXPECT_THROW(call.answer(deal.id, one_byte(3), 0), Error);
    EXPECT_FALSE(call.answer(deal.id, results({0, 1}), 0)) << "some of them are welcome";
    EXPECT_EQ(call.missing(), 18u);
}

// Three hosts do the shards; one of them, falsely. Who was named, and what came of it.
std::pair<std::optional<Failure>, Bytes> with_liar(const std::string& liar, const std::vector<std::string>& hosts) {
    constexpr std::uint32_t count = 12;
    ServiceCall call({StepReport::Kind::map, 0, count}, false);
    call.verify({1'000'000, 1});
    for (const auto& host : hosts) call.dealer().join({{host, 0}, 0}, 1, 0);
    bool all_there = false;
    for (int turn = 0; turn < 100 && !all_there; ++turn) {
        for (const auto& deal : call.dealer().deal(hosts.size(), 0)) {
            std::vector<int> values;
            for (std::uint32_t i = 0; i < deal.shards.count; ++i)
                values.push_back(deal.to.place.host == liar ? 99 : static_cast<int>(deal.shards.first + i));
            call.answer(deal.id, results(values), 0);
        }
        all_there = call.all_there(false);
    }
    EXPECT_TRUE(all_there) << "it waits for ever";
    call.complete_from_shards();
    return {call.lie(), call.result()};
}

TEST(ServiceCall, FindsOutWhoseShardsAreFalse) {
    const auto [lie, result] = with_liar("b", {"a", "b", "c"});
    ASSERT_TRUE(lie);
    EXPECT_EQ(lie->host, "b");
    EXPECT_THAT(lie->why, testing::HasSubstr("shard"));
    EXPECT_EQ(with_liar("", {"a", "b", "c"}).first, std::nullopt);
    EXPECT_EQ(with_liar("", {"a"}).first, std::nullopt) << "nobody else can be asked";
    const auto undecided = with_liar("b", {"a", "b"}).first;
    ASSERT_TRUE(undecided);
    EXPECT_EQ(undecided->host, "") << "one against one";
}

TEST(ServiceCall, AsksThoseWhoJoinLaterWhomToBelieve) {
    ServiceCall call({StepReport::Kind::map, 0, 1}, false);
    call.verify({1'000'000, 1});
    const auto answer_from = [&](const std::string& host, int value) {
        call.join({{host, 0}, 0}, 1, 0);
        const auto deals = call.dealer().deal(1, 0);
        ASSERT_EQ(deals.size(), 1u);
        EXPECT_EQ(deals.front().to.place.host, host);
        call.answer(deals.front().id, results({value}), 0);
    };
    answer_from("a", 99);
    EXPECT_FALSE(call.all_there(true));
    answer_from("b", 5);
    EXPECT_FALSE(call.all_there(true));
    EXPECT_FALSE(call.lie()) << "one against one, so far";
    answer_from("c", 5);
    EXPECT_TRUE(call.all_there(false));
    ASSERT_TRUE(call.lie());
    EXPECT_EQ(call.lie()->host, "a");
}

TEST(ServiceCall, DropsWhatWasComputedBeforeItBeganAgain) {
    ServiceCall call({StepReport::Kind::map, 0, 1}, false);
    const auto before = Worker(call)[0];
    call.begin_again();
    Worker worker(call);
    EXPECT_NE(worker[0], before);
    EXPECT_FALSE(call.answer(before, results({7}), 0));
    EXPECT_TRUE(call.answer(worker[0], results({1}), 0));
}

TEST(ServiceCalls, NamesANodeThatDoesNotPrepareAlikeEverywhere) {
    Graph graph;
    graph.nodes.push_back({"photons", "PhotonMap", {}, {}, {}});
    ServiceCalls calls(graph, "", nullptr);
    calls.reported(0, {StepReport::Kind::map, 0, 4});
    EXPECT_NO_THROW(calls.reported(0, {StepReport::Kind::map, 0, 4}));
    try {
        calls.reported(0, {StepReport::Kind::map, 0, 8});
        FAIL();
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("'photons' does not prepare alike"));
    }
}

// One list for each of two sectors.
Bytes two_lists(int first, int second) {
    const std::vector<std::byte> lists[] = {*one_byte(first), *one_byte(second)};
    return join_shards(std::span<const std::vector<std::byte>>(lists));
}

// The results of shards that gave these lists.
Bytes done(const std::vector<Bytes>& lists) {
    std::vector<std::vector<std::byte>> shards;
    for (const auto& list : lists) shards.push_back(*list);
    return join_shards(shards);
}

std::vector<int> values(const Bytes& result) {
    std::vector<int> values;
    for (const auto value : Mapped<std::uint8_t>(result)) values.push_back(value);
    return values;
}

TEST(ServiceCall, GivesEachSectorItsOwnPartInTheOrderOfShards) {
    ServiceCall call({StepReport::Kind::sectors, 0, 2}, false, 2);
    Worker worker(call);
    EXPECT_THROW(call.answer(worker[0], done({results({})}), 0), Error) << "of no sector";
    EXPECT_FALSE(call.answer(worker[0], done({two_lists(1, 2)}), 0));
    EXPECT_TRUE(call.answer(worker[1], done({two_lists(3, 4)}), 0));
    call.complete_from_shards();
    EXPECT_EQ(values(call.result(0)), (std::vector{1, 3}));
    EXPECT_EQ(values(call.result(1)), (std::vector{2, 4}));
    EXPECT_EQ(call.name(0), content_hash(*call.result(0))) << "though it was hashed piece by piece";
    EXPECT_EQ(call.name(1), content_hash(*call.result(1)));
}

class KeepingCache final : public ResultCache {
public:
    Result find(const Hash& recipe) const override {
        const auto found = kept.find(recipe);
        if (found == kept.end()) return {};
        return {content_hash(found->second), std::make_shared<const std::vector<std::byte>>(found->second)};
    }
    void keep(const Hash& recipe, const Result& result) override { kept[recipe] = *result.bytes; }
    std::map<Hash, std::vector<std::byte>> kept;
};

// "photons" with two sectors, nodes 1 and 2, of which all pieces are done.
class SectorCalls : public ::testing::Test {
protected:
    SectorCalls() {
        Graph whole;
        whole.nodes.push_back({"photons", "PhotonMap", {}, {}, {}});
        graph = sharded(whole, {{"photons", 2}});
        calls.emplace(graph, "", &cache);
        do_all();
    }
    void do_all() {
        auto& call = calls->reported(1, at);
        EXPECT_EQ(&call, &calls->reported(2, at)) << "their calls are the same";
        Worker worker(call);
        for (int shard = 0; shard < 3; ++shard)
            if (call.answer(worker[static_cast<std::uint32_t>(shard)], done({two_lists(shard, 10 + shard)}), 0)) {
                call.complete_from_shards();
                calls->keep(0, 0);
            }
    }
    const StepReport at{StepReport::Kind::sectors, 0, 3};
    Graph graph;
    KeepingCache cache;
    std::optional<ServiceCalls> calls;
};

TEST_F(SectorCalls, LetGoOfWhatIsOnDiskAndTakeItFromThere) {
    EXPECT_EQ(values(calls->result(2, 0)), (std::vector{10, 11, 12}));
    calls->all_have(0, 0);
    EXPECT_EQ(calls->of(0, 0).result(1), nullptr) << "not in memory any more";
    EXPECT_EQ(values(calls->result(1, 0)), (std::vector{0, 1, 2}));
    EXPECT_EQ(values(calls->result(2, 0)), (std::vector{10, 11, 12}));
}

TEST_F(SectorCalls, ComputeAgainWhatTheDiskHasLostOrSpoiled) {
    for (const bool spoiled : {false, true}) {
        calls->all_have(0, 0);
        for (auto& [recipe, bytes] : cache.kept) bytes.back() ^= std::byte{1};
        if (!spoiled) cache.kept.clear();
        EXPECT_EQ(calls->result(1, 0), nullptr);
        EXPECT_FALSE(calls->of(0, 0).done());
        do_all();
        EXPECT_EQ(values(calls->result(1, 0)), (std::vector{0, 1, 2}));
    }
}

TEST_F(SectorCalls, StayInMemoryWhereNothingElseKeepsThem) {
    ServiceCalls alone(graph, "", nullptr);
    auto& call = alone.reported(1, at);
    Worker worker(call);
    for (std::uint32_t shard = 0; shard < 3; ++shard) call.answer(worker[shard], done({two_lists(1, 2)}), 0);
    call.complete_from_shards();
    alone.all_have(0, 0);
    EXPECT_NE(alone.result(2, 0), nullptr);
    EXPECT_THROW(alone.reported(0, {StepReport::Kind::sectors, 1, 3}), Error) << "the written node has no sector";
}

}  // namespace
}  // namespace lightnet::service_calls_test
