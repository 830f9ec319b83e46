#include "core/prepare/calls.hpp"

#include <gmock/gmock.h>

#include <map>
#include <optional>

#include "core/error.hpp"
#include "core/light/mapped.hpp"

namespace lightnet {
namespace {

Bytes one_byte(int value) { return std::make_shared<const std::vector<std::byte>>(1, static_cast<std::byte>(value)); }

TEST(Call, HandsEachShardOutOnceAndTheLastOnesToThoseWhoAreIdle) {
    Call call({Report::Kind::map, 0, 5}, false);
    EXPECT_EQ(call.hand_out({0, 2}), 0u);
    EXPECT_EQ(call.hand_out({1, 2}), 1u);
    EXPECT_EQ(call.hand_out({2, 2}), std::nullopt) << "two at a time";
    EXPECT_EQ(call.hand_out({0, 2}), 2u);
    EXPECT_EQ(call.hand_out({1, 2}), std::nullopt) << "as many are left as there are places";
    EXPECT_EQ(call.hand_out({0, 2}), 3u);
    EXPECT_EQ(call.hand_out({0, 2}), 4u);
    EXPECT_EQ(call.hand_out({0, 2}), std::nullopt) << "nobody is late";
}

TEST(Call, HandsOutOnceMoreWhatSomebodyIsLateWith) {
    Call call({Report::Kind::map, 0, 3}, false);
    for (std::uint32_t shard = 0; shard < 3; ++shard) EXPECT_EQ(call.hand_out({0, 3, 10}), shard);
    call.answer(0, one_byte(0), 10.1);
    EXPECT_EQ(call.hand_out({0, 3, 10.15}), std::nullopt) << "it takes as long as the first, and half as long again";
    EXPECT_EQ(call.hand_out({1, 3, 10.25}), std::nullopt) << "only who is idle does what others are at";
    EXPECT_EQ(call.hand_out({0, 3, 10.25}), 1u);
    EXPECT_EQ(call.hand_out({0, 3, 10.25}), 2u);
    EXPECT_EQ(call.hand_out({0, 3, 20}), std::nullopt) << "no shard is done three times at once";
}

TEST(Call, WaitsForTheFirstShardsWithPatience) {
    Call call({Report::Kind::map, 0, 1}, false);
    EXPECT_EQ(call.hand_out({0, 2, 10}), 0u);
    EXPECT_EQ(call.hand_out({0, 2, 10.9}), std::nullopt);
    EXPECT_EQ(call.hand_out({0, 2, 11.1}), 0u);
}

TEST(Call, PutsShardsTogetherInTheirOrderAndCountsTheFirstAnswerOnly) {
    Call call({Report::Kind::map, 0, 2}, false);
    call.hand_out({0}), call.hand_out({0}), call.hand_out({0, 1, 100});
    EXPECT_FALSE(call.answer(1, one_byte(1)));
    EXPECT_FALSE(call.answer(1, one_byte(9)));
    EXPECT_TRUE(call.answer(0, one_byte(0)));
    call.complete_from_shards();
    const Mapped<std::uint8_t> result(call.result());
    EXPECT_THAT(result.all(), testing::ElementsAre(0, 1));
    EXPECT_FALSE(call.answer(0, one_byte(5))) << "too late";
}

TEST(Call, HandsOutAgainWhatALostPlaceHad) {
    Call call({Report::Kind::map, 0, 2}, false);
    call.hand_out({0}), call.hand_out({0});
    call.take_back(1);
    EXPECT_EQ(call.hand_out({0}), 1u);
    EXPECT_EQ(call.hand_out({0, 1, 100}), 0u) << "doubled";
    call.take_back(0);
    EXPECT_EQ(call.hand_out({0, 1, 0.5}), std::nullopt) << "another place is still at it";
}

TEST(Calls, NamesANodeThatDoesNotPrepareAlikeEverywhere) {
    Graph graph;
    graph.nodes.push_back({"photons", "PhotonMap", {}, {}, {}});
    Calls calls(graph, "", nullptr);
    calls.reported(0, {Report::Kind::map, 0, 4});
    EXPECT_NO_THROW(calls.reported(0, {Report::Kind::map, 0, 4}));
    try {
        calls.reported(0, {Report::Kind::map, 0, 8});
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

std::vector<int> values(const Bytes& result) {
    std::vector<int> values;
    for (const auto value : Mapped<std::uint8_t>(result)) values.push_back(value);
    return values;
}

TEST(Call, GivesEachSectorItsOwnPartInTheOrderOfShards) {
    Call call({Report::Kind::sectors, 0, 2}, false, 2);
    call.hand_out({0}), call.hand_out({0});
    EXPECT_THROW(call.answer(0, join_shards(std::span<const std::vector<std::byte>>())), Error) << "of no sector";
    EXPECT_FALSE(call.answer(1, two_lists(3, 4)));
    EXPECT_TRUE(call.answer(0, two_lists(1, 2)));
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
        while (const auto shard = call.hand_out({0})) {
            const int value = static_cast<int>(*shard);
            if (call.answer(*shard, two_lists(value, 10 + value))) {
                call.complete_from_shards();
                calls->keep(0, 0);
                return;
            }
        }
    }
    const Report at{Report::Kind::sectors, 0, 3};
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
    for (std::uint32_t shard = 0; shard < 3; ++shard) call.answer(shard, two_lists(1, 2));
    call.complete_from_shards();
    alone.all_have(0, 0);
    EXPECT_NE(alone.result(2, 0), nullptr);
    EXPECT_THROW(alone.reported(0, {Report::Kind::sectors, 1, 3}), Error) << "the written node has no sector";
}

}  // namespace
}  // namespace lightnet
