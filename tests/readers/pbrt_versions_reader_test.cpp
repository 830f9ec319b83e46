// Versions of pbrt that a graph chooses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/pbrt_text.hpp"

namespace lightnet::test::pbrt_versions_reader_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

TEST(PbrtVersions, MayBeSaidByWhoeverKnows) {
    const auto as = [](const std::string& text, const std::string& version) {
        MemoryFiles files{{"scene.pbrt", text}};
        return read_scene(files, "scene.pbrt", {{"pbrt", version}});
    };
    const auto error = [&](const std::string& text, const std::string& version) -> std::string {
        try {
            as(text, version);
            return "";
        } catch (const UserError& problem) {
            return problem.what();
        }
    };
    // nothing tells: a table of light is seen as the numbers say in version 3 only
    const std::string silent = "WorldBegin LightSource \"point\" \"blackbody I\" [ 6500 2 ]";
    EXPECT_NE(errors_of(silent), "") << "version 4 has no second number";
    EXPECT_EQ(as(silent, "3").lights.size(), 1u);
    EXPECT_THAT(as(silent, "3").warnings, IsEmpty());
    EXPECT_THAT(error("Film \"image\" WorldBegin", "4"), HasSubstr("'image'")) << "whatever the file seems to be";
    EXPECT_THAT(error("WorldBegin", "5"), HasSubstr("the version of pbrt that the file means: 3 or 4, not '5'"));
    MemoryFiles files{{"scene.pbrt", "WorldBegin"}};
    EXPECT_THROW(read_scene(files, "scene.pbrt", {{"size", "5"}}), UserError);
}

}  // namespace
}  // namespace lightnet::test::pbrt_versions_reader_test
