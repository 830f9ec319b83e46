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

TEST(ServiceCall, PutsShardsTogetherInTheirOrder) {
    ServiceCall call({StepReport::Kind::map, 0, 4}, false);
    call.take(1, results({1, 2}));
    EXPECT_EQ(call.missing(), 2u);
    call.take(0, results({0}));
    call.take(3, results({3}));
    EXPECT_EQ(call.missing(), 0u);
    call.complete_from_shards();
    const Mapped<std::uint8_t> result(call.result());
    EXPECT_THAT(result.all(), testing::ElementsAre(0, 1, 2, 3));
}

TEST(ServiceCall, KnowsResultsThatAreNotOfTheShardsThatWereAskedFor) {
    const ServiceCall call({StepReport::Kind::map, 0, 20}, false);
    EXPECT_THROW(call.check(3, results({})), Error);
    EXPECT_THROW(call.check(3, results({0, 1, 2, 3})), Error);
    EXPECT_THROW(call.check(3, one_byte(3)), Error);
    EXPECT_THROW(call.check(3, nullptr), Error);
    EXPECT_NO_THROW(call.check(3, results({0, 1}))) << "some of them are welcome";
}

TEST(ServiceCall, TakesAllShardsOnceMoreWhenItBeginsAgain) {
    ServiceCall call({StepReport::Kind::map, 0, 2}, false);
    call.take(0, results({7}));
    call.begin_again();
    EXPECT_EQ(call.missing(), 2u);
    call.take(0, results({1, 2}));
    call.complete_from_shards();
    EXPECT_THAT(Mapped<std::uint8_t>(call.result()).all(), testing::ElementsAre(1, 2));
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
    EXPECT_THROW(call.check(1, done({results({})})), Error) << "of no sector";
    EXPECT_NO_THROW(call.check(1, done({two_lists(1, 2)})));
    call.take(0, done({two_lists(1, 2)}));
    call.take(1, done({two_lists(3, 4)}));
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
        for (int shard = 0; shard < 3; ++shard)
            call.take(static_cast<std::uint32_t>(shard), done({two_lists(shard, 10 + shard)}));
        call.complete_from_shards();
        calls->keep(0, 0);
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
    for (std::uint32_t shard = 0; shard < 3; ++shard) call.take(shard, done({two_lists(1, 2)}));
    call.complete_from_shards();
    alone.all_have(0, 0);
    EXPECT_NE(alone.result(2, 0), nullptr);
    EXPECT_THROW(alone.reported(0, {StepReport::Kind::sectors, 1, 3}), Error) << "the written node has no sector";
}

}  // namespace
}  // namespace lightnet::service_calls_test
