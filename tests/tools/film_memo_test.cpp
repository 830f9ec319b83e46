// When films of earlier runs may be taken.
#include "tools/session/film_memo.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/network/graph/check.hpp"
#include "tests/support/fake_registry.hpp"

namespace lightnet::film_memo_test {
namespace {

using testing::HasSubstr;

Node node(std::string name, std::string kind, std::vector<Value> entries, std::map<std::string, Value> params = {}) {
    return {std::move(name), std::move(kind), std::move(entries), std::move(params), {"test.lua", 1}};
}

// Light that comes straight, as its kind is made to be.
Kind straight() {
    Kind kind{.name = "Straight", .help = "light"};
    kind.reads = reading(SceneParts());
    return kind;
}
Kind eye() {
    Kind kind{.name = "Eye", .role = Role::image, .help = "the image", .inputs = {1, 1}};
    kind.params = {{.name = "scene", .type = ParamType::scene, .help = "what is seen"},
                   {.name = "film", .type = ParamType::film, .help = "its size"}};
    kind.reads = reading(ScenePart::camera);
    return kind;
}

std::string why_not(const Kind& light, const Tuning& tuning = {}) {
    const Registry registry({light, eye()});
    RunRequest request;
    request.tuning = tuning;
    request.graph.nodes = {
        node("room", "Scene", {Value{std::string("room.pbrt")}}), node("sun", light.name, {}),
        node("image", "Eye", {Value{NodeRef{"sun"}}},
             {{"scene", Value{NodeRef{"room"}}}, {"film", Value{Table{{Value{4.0}, Value{4.0}}, {}}}}})};
    request.graph = check(request.graph, registry);
    return why_no_memo(request, registry);
}

TEST(FilmMemo, IsForGraphsWhoseNodesAllDeclareWhatTheyRead) {
    EXPECT_EQ(why_not(straight()), "");
    Kind unknown = straight();
    unknown.reads = {};
    EXPECT_THAT(why_not(unknown), HasSubstr("nobody has declared what nodes like 'sun' read"));
}

TEST(FilmMemo, IsNotForRandomNumbersThatNobodySeeds) {
    Kind dice = straight();
    dice.run.reproducible = false;
    EXPECT_THAT(why_not(dice), HasSubstr("'sun' draws random numbers that nobody seeds"));
}

TEST(FilmMemo, IsNotForRunsThatCheckWhatTheyAreTold) {
    Tuning checking, verifying;
    checking.check_answers = true;
    verifying.verify = 1;
    EXPECT_THAT(why_not(straight(), checking), HasSubstr("--check-answers"));
    EXPECT_THAT(why_not(straight(), verifying), HasSubstr("--verify"));
}

}  // namespace
}  // namespace lightnet::film_memo_test
