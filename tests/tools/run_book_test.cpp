// What a run says of itself.
#include "tools/run_book.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/support/folder.hpp"

namespace lightnet::run_book_test {
namespace {

TEST(RunBook, NamesTheNodeThatMadeWhatIsNotFinite) {
    Graph graph;
    graph.nodes = {{"direct", "DirectLighting", {}, {}, {}},
                   {"bounce", "PathTracing", {}, {}, {}},
                   {"light", "Combine", {{NodeRef{"direct"}}, {NodeRef{"bounce"}}}, {}, {}}};
    RunBook book({1, 1, {"emission"}, 1}, ProgressMode::none, 1, {});
    Counters counters;
    counters.not_finite = {{"bounce", 2}, {"light", 2}};
    book.count(counters);
    book.name_bad_light(graph);
    const test::Folder folder;
    book.write_report(folder / "x.exr", "done");
    std::ifstream file(folder / "x.run.json");
    const std::string json{std::istreambuf_iterator<char>(file), {}};
    EXPECT_THAT(json, testing::HasSubstr("PathTracing 'bounce' gave 2 answers that are not finite"));
    EXPECT_THAT(json, testing::Not(testing::HasSubstr("'light'")));
    EXPECT_THAT(json, testing::HasSubstr("\"not_finite.bounce\": 2"));
}

}  // namespace
}  // namespace lightnet::run_book_test
