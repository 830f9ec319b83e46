#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lua/load_graph.hpp"
#include "tests/support/parse.hpp"

namespace lightnet::constants_test {
namespace {

using testing::HasSubstr;

Value rays_with(const std::map<std::string, std::string>& constants, const std::string& text) {
    return parse_graph(text, "graph.lua", {.constants = constants}).nodes.at(0).params.at("rays");
}

std::string error_with(const std::map<std::string, std::string>& constants, const std::string& text) {
    return test::error_of([&] { parse_graph(text, "graph.lua", {.constants = constants}); });
}

TEST(Constants, AreOverridden) {
    EXPECT_EQ(rays_with({{"n", "16"}}, "n = 4\nsky = Ambient { rays = n }"), Value{16.0});
    EXPECT_EQ(rays_with({{"n", "2.5e3"}}, "n = 4\nsky = Ambient { rays = n }"), Value{2500.0});
}

TEST(Constants, KeepTheTypeOfTheFile) {
    EXPECT_EQ(rays_with({{"n", "16"}}, "n = 'four'\nsky = Ambient { rays = n }"), Value{std::string("16")});
    EXPECT_EQ(rays_with({{"n", "true"}}, "n = false\nsky = Ambient { rays = n }"), Value{true});
    EXPECT_EQ(error_with({{"n", "many"}}, "\nn = 4"),
              "graph.lua:2: -D n=many: the file gives a number, and so must -D");
    EXPECT_EQ(error_with({{"n", "1"}}, "n = true"),
              "graph.lua:1: -D n=1: the file gives true or false, and so must -D");
}

TEST(Constants, HaveATypeByTheirLookWhereTheFileOnlyReadsThem) {
    EXPECT_EQ(rays_with({{"n", "16"}}, "sky = Ambient { rays = n }"), Value{16.0});
    EXPECT_EQ(rays_with({{"n", "false"}}, "sky = Ambient { rays = n }"), Value{false});
    EXPECT_EQ(rays_with({{"n", "x16"}}, "sky = Ambient { rays = n }"), Value{std::string("x16")});
    EXPECT_EQ(rays_with({{"n", "16"}}, "n = n or 4\nsky = Ambient { rays = n }"), Value{16.0});
}

TEST(Constants, MustBeKnownToTheFile) {
    EXPECT_EQ(error_with({{"smaples", "1"}}, "samples = 4"),
              "graph.lua: -D smaples: the file has no constant of that name (did you mean 'samples'?)");
}

TEST(Constants, AreNoNodes) {
    EXPECT_THAT(error_with({{"sky", "1"}}, "sky = Ambient {}"),
                HasSubstr("-D sky=1: the file gives a node, which -D can't override"));
}

}  // namespace
}  // namespace lightnet::constants_test
