// JSON that goes out: its text is the one that the library would write, and is read back.
#include "core/base/json_tree.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "core/base/json.hpp"
#include "core/base/printable.hpp"

namespace lightnet::json_tree_test {
namespace {

TEST(JsonTree, TellsObjectsFromListsByWhatStandsInBraces) {
    EXPECT_EQ(to_text({{"name", "a"}, {"at", {1, 2}}}), R"({"name":"a","at":[1,2]})");
    EXPECT_EQ(to_text({{"a", "b"}}), R"({"a":"b"})");
    EXPECT_EQ(to_text({"a", "b"}), R"(["a","b"])");
    EXPECT_EQ(to_text({{"a", 1, 2}, {"b", 3, 4}}), R"([["a",1,2],["b",3,4]])");
    EXPECT_EQ(to_text({{1, 2}, {3, 4}}), "[[1,2],[3,4]]");
    EXPECT_EQ(to_text(JsonTree("a")), R"("a")");
    EXPECT_EQ(to_text({{"of", {{"one", nullptr}}}}), R"({"of":{"one":null}})");
}

TEST(JsonTree, GrowsPieceByPiece) {
    JsonTree tree;
    tree["b"] = 1;
    tree["a"]["within"] = true;
    auto& entries = tree["entries"] = JsonTree::list();
    entries.push_back({"x", 0.5f});
    entries.push_back(JsonTree::object());
    tree["b"] = "another";
    EXPECT_EQ(to_text(tree), R"({"b":"another","a":{"within":true},"entries":[["x",0.5],{}]})");
    EXPECT_EQ(sorted_text(tree), R"({"a":{"within":true},"b":"another","entries":[["x",0.5],{}]})");
    const JsonTree copy = tree;
    tree["a"] = nullptr;
    EXPECT_EQ(to_text(copy), R"({"b":"another","a":{"within":true},"entries":[["x",0.5],{}]})");
}

TEST(JsonTree, TakesListsAndMapsOfWhatItTakes) {
    EXPECT_EQ(to_text(std::vector<std::vector<int>>{{1}, {}, {2, 3}}), "[[1],[],[2,3]]");
    EXPECT_EQ(to_text(std::map<std::string, double>{{"z", 1}, {"a", 0.1}}), R"({"a":0.1,"z":1.0})");
}

TEST(JsonTree, KeepsEachBitOfANumber) {
    constexpr auto most = std::numeric_limits<std::uint64_t>::max();
    constexpr auto least = std::numeric_limits<std::int64_t>::min();
    EXPECT_EQ(to_text({most, least, -1, std::uint8_t{7}, true}),
              "[18446744073709551615,-9223372036854775808,-1,7,true]");
    for (const double number : {0.1, 1.0, -0.0, 1e300, 5e-324, 1.0 / 3, 123456789.0, 1e21}) {
        EXPECT_EQ(to_text(number), nlohmann::json(number).dump());
        EXPECT_EQ(parse_json(to_text(number)).number(), number);
    }
    EXPECT_EQ(to_text(0.1f), nlohmann::json(double{0.1f}).dump());
    EXPECT_EQ(to_text({std::nan(""), HUGE_VAL}), "[null,null]");
}

TEST(JsonTree, IsLaidOutAsTheLibraryDoes) {
    const nlohmann::ordered_json theirs{
        {"b", {1, {{"c", nlohmann::ordered_json::array()}}}}, {"a", nlohmann::ordered_json::object()}, {"d", "x\n"}};
    const JsonTree ours{{"b", {1, {{"c", JsonTree::list()}}}}, {"a", JsonTree::object()}, {"d", "x\n"}};
    for (const int indent : {-1, 0, 1, 2, 4}) EXPECT_EQ(to_text(ours, {.indent = indent}), theirs.dump(indent));
    EXPECT_EQ(to_text(ours, {.indent = 2, .by_name = true}), nlohmann::json(theirs).dump(2));
}

TEST(JsonTree, WritesTextsThatAreNoUtf8AsItIsTold) {
    const std::string torn =
        "a\xff"
        "b";
    EXPECT_EQ(to_text(torn),
              "\"a\xef\xbf\xbd"
              "b\"");
    EXPECT_THROW(to_text(torn, {.strict = true}), Error);
    EXPECT_THROW(to_text({{torn, 1}, {"a", 2}}, {.strict = true}), Error);
    EXPECT_EQ(to_text("ü\"\x01", {.ascii = true}), "\"\\u00fc\\\"\\u0001\"");
    JsonTree tree{{"name", torn}, {"list", {torn, 1}}};
    tree.change_texts(in_utf8);
    EXPECT_EQ(to_text(tree, {.strict = true}), R"({"name":"a\\xffb","list":["a\\xffb",1]})");
}

TEST(JsonTree, OfWhatWasReadIsTheSame) {
    const std::string text = R"({"a":[1,2.5,"x",null,true,{"b":[]}],"n":18446744073709551615})";
    EXPECT_EQ(to_text(JsonTree(parse_json(text))), text);
}

}  // namespace
}  // namespace lightnet::json_tree_test
