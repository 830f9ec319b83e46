// What is there already is left alone, unless it is ours.
#include "tools/pictures/output_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "tests/support/folder.hpp"
#include "tools/support/run_report.hpp"

namespace lightnet::output_file_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::string refusal_of(const fs::path& output) {
    try {
        check_output(output);
        return "";
    } catch (const UserError& error) {
        return error.what();
    }
}

TEST(OutputFile, TakesThePlaceOfPicturesAndOfNothing) {
    const test::Folder folder;
    EXPECT_THAT(refusal_of(folder / "x.exr"), IsEmpty());
    folder.write("x.exr", "\x76\x2f\x31\x01 and more");
    folder.write("x.png", "\x89PNG\r\n\x1a\n and more");
    folder.write("x.run.json", to_json(RunReport{}));
    folder.write("x.exr.checkpoint", "lightnet checkpoint 3\n");
    EXPECT_THAT(refusal_of(folder / "x.exr"), IsEmpty());
    EXPECT_THAT(refusal_of(folder / "X.EXR"), IsEmpty());
    EXPECT_THAT(refusal_of(folder / "x.exr2"), HasSubstr("pictures are written as .exr"));
    folder.write("empty.exr", "");
    EXPECT_THAT(refusal_of(folder / "empty.exr"), IsEmpty()) << "as mktemp makes them";
}

TEST(OutputFile, LeavesFilesOfOthersAlone) {
    for (const std::string name : {"x.exr", "x.png", "x.run.json", "x.exr.checkpoint"}) {
        const test::Folder folder;
        folder.write(name, "{\n  \"my\": \"notes\"\n}");
        EXPECT_THAT(
            refusal_of(folder / "x.exr"),
            HasSubstr((folder / name).string() + ": is there already, and is nothing that lightnet has written"));
    }
    const test::Folder folder;
    fs::create_directory(folder / "x.exr");
    EXPECT_THAT(refusal_of(folder / "x.exr"), HasSubstr("is a folder"));
    ::mkfifo((folder / "y.exr").c_str(), 0600);
    EXPECT_THAT(refusal_of(folder / "y.exr"), HasSubstr("a pipe"));
}

TEST(OutputFile, LeavesAloneWhatThePictureIsMadeOf) {
    const test::Folder folder;
    const auto wood = folder.write("wood.png", "\x89PNG\r\n\x1a\n and more");
    fs::create_symlink(wood, folder / "link.png");
    const auto refusal = [&](const std::string& name) {
        try {
            check_inputs_stay(folder / name, {folder / "none.png", wood});
            return std::string();
        } catch (const UserError& error) {
            return std::string(error.what());
        }
    };
    EXPECT_THAT(refusal("wood.exr"), HasSubstr("wood.png: is what this picture is made of"));
    EXPECT_THAT(refusal("link.exr"), HasSubstr("link.png: is what this picture is made of"));
    EXPECT_THAT(refusal("other.exr"), IsEmpty());
}

TEST(OutputFile, NamesAllThatIsInTheWayAtOnce) {
    const test::Folder folder;
    folder.write("x.png", "notes");
    folder.write("x.run.json", "notes");
    EXPECT_THAT(refusal_of(folder / "x.exr"), testing::AllOf(HasSubstr("x.png"), HasSubstr("x.run.json")));
}

class KeptFiles : public ::testing::Test {
protected:
    KeptFiles() : graph_file(folder.write("graphs/room.lua", "")) {
        keeper.name = "Keeper";
        keeper.run.keeps = true;
    }
    std::vector<Problem> problems(const std::string& keep) const {
        Graph graph;
        graph.file = graph_file;
        graph.nodes = {{"soft", "Keeper", {}, {{"keep", Value{keep}}}, {graph_file, 3}}};
        return problems_of_kept_files(graph, Registry{{keeper}});
    }
    std::string refusal(const std::string& keep) const {
        const auto found = problems(keep);
        return found.empty() ? "" : to_string(found[0]);
    }
    const test::Folder folder;
    std::string graph_file;
    Kind keeper{};
};

TEST_F(KeptFiles, StayInTheFolderOfTheGraph) {
    fs::create_directories(folder / "graphs" / "records");
    for (const char* inside : {"room.records", "records/room.records", "records/../room.records", "./a"})
        EXPECT_THAT(problems(inside), IsEmpty()) << inside;
    for (const std::string outside : {"../room.records", "records/../../room.records", "/etc/room.records"}) {
        EXPECT_THAT(refusal(outside), HasSubstr("room.lua:3: Keeper 'soft': 'keep': ")) << outside;
        EXPECT_THAT(refusal(outside), HasSubstr("is outside of the graph's folder")) << outside;
    }
}

TEST_F(KeptFiles, FollowNoLinksThatLeadOut) {
    folder.write("home/.bashrc", "alias");
    fs::create_symlink(folder / "home", folder / "graphs" / "way");
    fs::create_symlink(folder / "home" / ".bashrc", folder / "graphs" / "file");
    for (const char* outside : {"way/.bashrc", "way/new", "file"})
        EXPECT_THAT(refusal(outside), HasSubstr("is outside of the graph's folder")) << outside;
}

TEST_F(KeptFiles, TakeThePlaceOfNothingElse) {
    folder.write("graphs/notes", "mine");
    EXPECT_THAT(refusal("notes"), HasSubstr("is nothing that lightnet has written"));
    folder.write("graphs/records", "lightnet kept 1\nwhat irradiance records\n");
    EXPECT_THAT(problems("records"), IsEmpty());
}

TEST(PictureOfAGraph, StaysInTheCurrentFolderOrInTheGraphs) {
    const test::Folder folder;
    Graph graph;
    graph.file = folder.write("graphs/room.lua", "");
    for (const auto& inside : {std::string("x.exr"), std::string("out/x.exr"), folder.file("graphs/x.exr")})
        EXPECT_THAT(problems_of_picture(graph, inside), IsEmpty()) << inside;
    for (const auto& outside : {std::string("../x.exr"), folder.file("x.exr"), std::string("out/../../x.exr")})
        ASSERT_THAT(problems_of_picture(graph, outside), SizeIs(1)) << outside;
    EXPECT_THAT(to_string(problems_of_picture(graph, "../x.exr")[0]), HasSubstr("choose that with -o"));
}

}  // namespace
}  // namespace lightnet::output_file_test
