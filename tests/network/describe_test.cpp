#include "core/network/graph/describe.hpp"

#include <gtest/gtest.h>

#include "tests/support/fake_registry.hpp"

namespace lightnet::describe_test {
namespace {

TEST(Describe, ListsAllKinds) {
    EXPECT_EQ(describe(test::fake_registry()),
              "Ambient    light  light from everywhere\n"
              "Cache      light  remembers light\n"
              "Combine    light  sums its inputs\n"
              "RayTracer  image  makes the image\n"
              "Reuse      light  takes what was remembered\n"
              "Scene      scene  what is seen: Scene { \"file.pbrt\" }, the file named from the graph's folder\n");
}

TEST(Describe, TellsAllOfAParam) {
    EXPECT_EQ(describe(test::ambient()),
              "Ambient: light from everywhere\n"
              "gives: light\n"
              "inputs: none\n"
              "reads of the scene: everything\n"
              "layouts: replicated, sharded\n"
              "parameters:\n"
              "  rays   integer, in samples, default 4, 1 … 64\n"
              "         how many\n"
              "  reach  number, in m, optional, at least 0\n"
              "         how far\n"
              "  paths  text, default \"all\", \"all\" | \"caustic\"\n"
              "         which light\n"
              "  soft   flag, default false\n"
              "         without edges\n");
}

TEST(Describe, TellsWhatIsReadOfTheScene) {
    Kind kind = test::ambient();
    kind.reads = reading(ScenePart::lamps | ScenePart::geometry);
    EXPECT_NE(describe(kind).find("reads of the scene: geometry, lamps\n"), std::string::npos);
    kind.reads = reading({});
    EXPECT_NE(describe(kind).find("reads of the scene: nothing\n"), std::string::npos);
}

TEST(Describe, TellsOfNodesThatAreTaken) {
    EXPECT_NE(describe(test::reuse()).find("of  node, must be given, one that keeps records\n"), std::string::npos);
}

TEST(Describe, TellsOfInputs) {
    EXPECT_NE(describe(test::combine()).find("inputs: 1 or more that give light\n"), std::string::npos);
    EXPECT_NE(describe(test::cache()).find("inputs: 1 that gives light\n"), std::string::npos);
}

}  // namespace
}  // namespace lightnet::describe_test
