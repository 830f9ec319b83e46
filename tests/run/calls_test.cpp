#include "core/run/prepare/calls.hpp"

#include <gmock/gmock.h>

#include <map>
#include <optional>

#include "core/base/error.hpp"
#include "core/network/light/mapped.hpp"

namespace lightnet::calls_test {
namespace {

Bytes one_byte(int value) { return std::make_shared<const std::vector<std::byte>>(1, static_cast<std::byte>(value)); }

// One result of each of these shards.
Bytes results(const std::vector<int>& values) {
    std::vector<std::vector<std::byte>> shards;
    for (const int value : values) shards.push_back(*one_byte(value));
    return join_shards(shards);
}

constexpr Shards only(std::uint32_t shard) { return {shard, 1}; }

TEST(Call, HandsEachShardOutOnceAndTheLastOnesToThoseWhoAreIdle) {
    Call call({StepReport::Kind::map, 0, 5}, false);
    EXPECT_EQ(call.hand_out({0, 2}), only(0));
    EXPECT_EQ(call.hand_out({1, 2}), only(1));
    EXPECT_EQ(call.hand_out({2, 2}), std::nullopt) << "two at a time";
    EXPECT_EQ(call.hand_out({0, 2}), only(2));
    EXPECT_EQ(call.hand_out({1, 2}), std::nullopt) << "as many are left as there are places";
    EXPECT_EQ(call.hand_out({0, 2}), only(3));
    EXPECT_EQ(call.hand_out({0, 2}), only(4));
    EXPECT_EQ(call.hand_out({0, 2}), std::nullopt) << "nobody is late";
}

TEST(Call, HandsOutOnceMoreWhatSomebodyIsLateWith) {
    Call call({StepReport::Kind::map, 0, 3}, false);
    for (std::uint32_t shard = 0; shard < 3; ++shard) EXPECT_EQ(call.hand_out({0, 3, 10}), only(shard));
    call.answer(only(0), results({0}), 10.1);
    EXPECT_EQ(call.hand_out({0, 3, 10.15}), std::nullopt) << "it takes as long as the first, and half as long again";
    EXPECT_EQ(call.hand_out({1, 3, 10.25}), std::nullopt) << "only who is idle does what others are at";
    EXPECT_EQ(call.hand_out({0, 3, 10.25}), only(1));
    EXPECT_EQ(call.hand_out({0, 3, 10.25}), only(2));
    EXPECT_EQ(call.hand_out({0, 3, 20}), std::nullopt) << "no shard is done three times at once";
}

TEST(Call, WaitsForTheFirstShardsWithPatience) {
    Call call({StepReport::Kind::map, 0, 1}, false);
    EXPECT_EQ(call.hand_out({0, 2, 10}), only(0));
    EXPECT_EQ(call.hand_out({0, 2, 10.9}), std::nullopt);
    EXPECT_EQ(call.hand_out({0, 2, 11.1}), only(0));
}

TEST(Call, PutsShardsTogetherInTheirOrderAndCountsTheFirstAnswerOnly) {
    Call call({StepReport::Kind::map, 0, 2}, false);
    call.hand_out({0}), call.hand_out({0}), call.hand_out({0, 1, 100});
    EXPECT_FALSE(call.answer(only(1), results({1})));
    EXPECT_FALSE(call.answer(only(1), results({9})));
    EXPECT_TRUE(call.answer(only(0), results({0})));
    call.complete_from_shards();
    const Mapped<std::uint8_t> result(call.result());
    EXPECT_THAT(result.all(), testing::ElementsAre(0, 1));
    EXPECT_FALSE(call.answer(only(0), results({5}))) << "too late";
}

TEST(Call, HandsOutAgainWhatALostPlaceHad) {
    Call call({StepReport::Kind::map, 0, 2}, false);
    call.hand_out({0}), call.hand_out({0});
    call.take_back(only(1));
    EXPECT_EQ(call.hand_out({0}), only(1));
    EXPECT_EQ(call.hand_out({0, 1, 100}), only(0)) << "doubled";
    call.take_back(only(0));
    EXPECT_EQ(call.hand_out({0, 1, 0.5}), std::nullopt) << "another place is still at it";
}

// Fewer towards the end; what is not answered goes to somebody else.
TEST(Call, HandsOutSeveralShardsTogetherWhileThereAreMany) {
    Call call({StepReport::Kind::map, 0, 20}, false);
    EXPECT_EQ(call.hand_out({0, 2}), (Shards{0, 3}));
    EXPECT_EQ(call.hand_out({1, 2}), (Shards{3, 2}));
    EXPECT_FALSE(call.answer({0, 3}, results({0, 1})));
    EXPECT_EQ(call.missing(), 18u);
    EXPECT_EQ(call.hand_out({0, 2}), (Shards{2, 1})) << "those that follow it are under way";
    call.take_back({3, 2});
    EXPECT_EQ(call.hand_out({0, 2}), (Shards{3, 2}));
    EXPECT_THROW(call.answer({3, 2}, results({})), Error);
    EXPECT_THROW(call.answer({3, 2}, results({3, 4, 5})), Error);
    EXPECT_THROW(call.answer({3, 2}, one_byte(3)), Error);
    std::vector<int> all{0, 1};
    for (int i = 2; i < 20; ++i) all.push_back(i);
    EXPECT_FALSE(call.answer({2, 1}, results({2})));
    EXPECT_FALSE(call.answer({3, 2}, results({3, 4})));
    while (const auto some = call.hand_out({0, 2})) {
        const std::vector<int> values(all.begin() + some->first, all.begin() + some->first + some->count);
        if (call.answer(*some, results(values))) call.complete_from_shards();
    }
    ASSERT_TRUE(call.done());
    const Mapped<std::uint8_t> result(call.result());
    EXPECT_EQ(std::vector<int>(result.begin(), result.end()), all);
}

TEST(Calls, NamesANodeThatDoesNotPrepareAlikeEverywhere) {
    Graph graph;
    graph.nodes.push_back({"photons", "PhotonMap", {}, {}, {}});
    Calls calls(graph, "", nullptr);
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

TEST(Call, GivesEachSectorItsOwnPartInTheOrderOfShards) {
    Call call({StepReport::Kind::sectors, 0, 2}, false, 2);
    call.hand_out({0}), call.hand_out({0});
    EXPECT_THROW(call.answer(only(0), results({})), Error);
    EXPECT_THROW(call.answer(only(0), done({results({})})), Error) << "of no sector";
    EXPECT_FALSE(call.answer(only(1), done({two_lists(3, 4)})));
    EXPECT_TRUE(call.answer(only(0), done({two_lists(1, 2)})));
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
        while (const auto some = call.hand_out({0})) {
            std::vector<Bytes> lists;
            for (auto shard = some->first; shard < some->first + some->count; ++shard)
                lists.push_back(two_lists(static_cast<int>(shard), 10 + static_cast<int>(shard)));
            if (call.answer(*some, done(lists))) {
                call.complete_from_shards();
                calls->keep(0, 0);
                return;
            }
        }
    }
    const StepReport at{StepReport::Kind::sectors, 0, 3};
    Graph graph;
    KeepingCache cache;
    std::optional<Calls> calls;
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
    Calls alone(graph, "", nullptr);
    auto& call = alone.reported(1, at);
    for (std::uint32_t shard = 0; shard < 3; ++shard) call.answer(only(shard), done({two_lists(1, 2)}));
    call.complete_from_shards();
    alone.all_have(0, 0);
    EXPECT_NE(alone.result(2, 0), nullptr);
    EXPECT_THROW(alone.reported(0, {StepReport::Kind::sectors, 1, 3}), Error) << "the written node has no sector";
}

}  // namespace
}  // namespace lightnet::calls_test
