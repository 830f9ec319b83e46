// The project keeps the rules of the house.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <sstream>

#include "tests/architecture/project_files.hpp"
#include "tests/architecture/rules.hpp"

namespace lightnet::house {
namespace {

using ::testing::IsEmpty;

constexpr std::size_t usual_most = 400;

// Files that may be longer, each with its reason.
const std::map<std::string, std::size_t> longer{};

Complaints all_complaints(const std::vector<SourceFile>& files, Complaints (*rule)(const SourceFile&)) {
    Complaints all;
    for (const SourceFile& file : files) std::ranges::move(rule(file), std::back_inserter(all));
    return all;
}

TEST(Project, IsFound) {
    const auto core = files_of("core");
    EXPECT_TRUE(std::ranges::any_of(core, [](const SourceFile& file) { return file.path == "core/base/query.hpp"; }));
}

TEST(Project, KeepsTheMapOfRooms) { EXPECT_THAT(all_complaints(all_files(), stray_includes), IsEmpty()); }

TEST(Project, KeepsDistributionOutOfNodesAndWhatTheyShare) {
    for (const char* room : {"nodes", "core/estimate"})
        EXPECT_THAT(all_complaints(files_of(room), words_of_distribution), IsEmpty());
}

TEST(Project, WrapsAClassInFiveLines) {
    const SourceFile candela = read("nodes/examples/candela/bridge.cpp");
    EXPECT_THAT(long_wraps(candela, 0), testing::SizeIs(5)) << "its five classes are found";
    EXPECT_THAT(all_complaints({candela, read("examples/integrators/integrators.cpp")},
                               [](const SourceFile& file) { return long_wraps(file, 5); }),
                IsEmpty());
}

TEST(Project, HasHeadersThatGuardThemselves) { EXPECT_THAT(all_complaints(all_files(), bad_header), IsEmpty()); }

std::vector<SourceFile> product() {
    std::vector<SourceFile> files;
    for (const char* room : {"core", "nodes", "transport", "lua", "tools"})
        std::ranges::move(files_of(room), std::back_inserter(files));
    std::erase_if(files,
                  [](const SourceFile& file) { return !file.path.ends_with(".cpp") && !file.path.ends_with(".hpp"); });
    return files;
}

TEST(Project, HasNoFoldersThatIncludeEachOther) { EXPECT_THAT(folder_circles(product()), IsEmpty()); }

TEST(Project, HasAMasterAndPlacesThatNeverSeeEachOther) {
    EXPECT_THAT(glances(product(), "core/run/master", "core/run/place"), IsEmpty());
}

TEST(Project, HasOneTypeOfEachName) { EXPECT_THAT(repeated_types(product()), IsEmpty()); }

TEST(Project, ReadsFilesThatOthersMayHaveMadeByOneReader) {
    EXPECT_THAT(all_complaints(product(), streams_of_files), IsEmpty());
}

TEST(Project, TellsExceptionsInWordsForPeople) {
    EXPECT_THAT(all_complaints(product(), words_of_the_library), IsEmpty());
}

TEST(Project, HasCommentsWithASubjectOfTheirOwn) {
    EXPECT_THAT(all_complaints(product(), borrowed_subjects), IsEmpty());
}

TEST(Project, HasHeadsOfFilesThatSayWhatTheyHold) {
    EXPECT_THAT(all_complaints(product(), questions_for_heads), IsEmpty());
}

TEST(Project, HasDocumentsThatShowItsCode) {
    for (const char* document : {"README.md", "CONTRIBUTING.md"})
        EXPECT_THAT(stale_cuts(read(document), all_files()), IsEmpty());
}

// Lines "path Class members" of class_debts.txt.
std::map<std::string, std::size_t> class_debts() {
    std::map<std::string, std::size_t> debts;
    std::istringstream lines(read("tests/architecture/class_debts.txt").text);
    std::string path, name;
    for (std::size_t members = 0; lines >> path >> name >> members;) debts[path + " " + name] = members;
    return debts;
}

TEST(Project, HasClassesThatFitInAHead) { EXPECT_THAT(too_large(product(), 25, class_debts()), IsEmpty()); }

TEST(Project, HasShortFiles) {
    Complaints all;
    for (const SourceFile& file : all_files()) {
        const auto allowed = longer.find(file.path);
        std::ranges::move(too_long(file, allowed == longer.end() ? usual_most : allowed->second),
                          std::back_inserter(all));
    }
    EXPECT_THAT(all, IsEmpty());
}

}  // namespace
}  // namespace lightnet::house
