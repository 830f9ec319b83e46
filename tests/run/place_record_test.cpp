// What places did travels as text.
#include "core/run/message/place_record.hpp"

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/run/message/counters.hpp"

namespace lightnet::place_record_test {
namespace {

PlaceRecord some_record(std::uint32_t index) {
    PlaceRecord record{"tcp://onyx:7777", index, ~std::uint64_t{0}, 2, 3, {}, {}};
    record.nodes["a \"quoted\" node"] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, {{{80, 3}, {84, 5}}}};
    record.edges[{"image", "light"}] = {6, 7, 8, 9, 10, 11, 12, 13, 14};
    return record;
}

TEST(PlaceRecord, SurvivesItsWayAsText) {
    const std::vector<PlaceRecord> records{some_record(0), some_record(7)};
    EXPECT_EQ(place_records_from(to_text(records)), records);
    EXPECT_TRUE(place_records_from(to_text(std::vector<PlaceRecord>{})).empty());
}

TEST(PlaceRecord, KeepsAShareOfWorkAlone) {
    PlaceRecord record = some_record(0);
    record.nodes.begin()->second = {1, 200, 3, 4, 5, 6, 2, 70, 80, 9, {{{80, 3}, {84, 5}}}};
    record.edges.begin()->second = {6, 7, 800, 9, 10, 11, 12, 13, 140};
    keep_of_work(0.5, record);
    const NodeRecord node{1, 100, 3, 4, 5, 6, 2, 35, 40, 9, {{{76, 3}, {80, 5}}}};
    EXPECT_EQ(record.nodes.begin()->second, node) << "half the cost is an octave, four steps";
    const EdgeRecord edge{6, 7, 400, 9, 10, 11, 12, 13, 70};
    EXPECT_EQ(record.edges.begin()->second, edge);
    EXPECT_EQ(record.lived_ns, some_record(0).lived_ns);
}

TEST(PlaceRecord, IsRefusedWhenItIsNone) {
    const std::string text = to_text(std::vector{some_record(1)});
    for (const auto& wrong : {std::string("{}"), std::string("[1]"), text.substr(0, text.size() - 3)})
        EXPECT_THROW(place_records_from(wrong), Error) << wrong;
}

TEST(PlaceRecord, StaysByItselfWhereCountsAddUp) {
    Counters sum, more;
    sum.places = {some_record(0)}, more.places = {some_record(1)};
    sum += more;
    EXPECT_EQ(sum.places, (std::vector<PlaceRecord>{some_record(0), some_record(1)}));
}

}  // namespace
}  // namespace lightnet::place_record_test
