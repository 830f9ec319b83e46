#include "core/prepare/calls.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/light/mapped.hpp"

namespace lightnet {
namespace {

Bytes one_byte(int value) { return std::make_shared<const std::vector<std::byte>>(1, static_cast<std::byte>(value)); }

TEST(Call, HandsEachShardOutOnceAndThenToThoseWhoAreIdle) {
    Call call({Report::Kind::map, 0, 3}, false);
    EXPECT_EQ(call.hand_out(0), 0u);
    EXPECT_EQ(call.hand_out(1), 1u);
    EXPECT_EQ(call.hand_out(2), std::nullopt) << "two at a time";
    EXPECT_EQ(call.hand_out(0), 2u);
    EXPECT_EQ(call.hand_out(1), std::nullopt) << "only who is idle does what others are at";
    EXPECT_EQ(call.hand_out(0), 0u);
    EXPECT_EQ(call.hand_out(0), 1u);
    EXPECT_EQ(call.hand_out(0), 2u);
    EXPECT_EQ(call.hand_out(0), std::nullopt) << "no shard is done three times at once";
}

TEST(Call, PutsShardsTogetherInTheirOrderAndCountsTheFirstAnswerOnly) {
    Call call({Report::Kind::map, 0, 2}, false);
    call.hand_out(0), call.hand_out(1), call.hand_out(0);
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
    call.hand_out(0), call.hand_out(1);
    call.take_back(1);
    EXPECT_EQ(call.hand_out(0), 1u);
    call.hand_out(0);  // shard 0, doubled
    call.take_back(0);
    EXPECT_EQ(call.hand_out(1), std::nullopt) << "another place is still at it";
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

}  // namespace
}  // namespace lightnet
