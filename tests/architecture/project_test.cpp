// The project keeps the rules of the house.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "tests/architecture/rules.hpp"

namespace lightnet::house {
namespace {

using ::testing::IsEmpty;

constexpr std::size_t usual_most = 400;

// Files that may be longer, each with its reason.
const std::map<std::string, std::size_t> longer{};

SourceFile read(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {path.lexically_relative(LIGHTNET_SOURCE_DIR), {std::istreambuf_iterator<char>(stream), {}}};
}

std::vector<SourceFile> files_of(const std::string& room) {
    const std::filesystem::path root = LIGHTNET_SOURCE_DIR;
    std::vector<SourceFile> files;
    if (!std::filesystem::exists(root / room)) return files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / room)) {
        const auto kind = entry.path().extension();
        if (!entry.is_regular_file() || (kind != ".cpp" && kind != ".hpp" && kind != ".lua")) continue;
        files.push_back(read(entry.path()));
    }
    std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
    return files;
}

std::vector<SourceFile> all_files() {
    std::vector<SourceFile> files;
    for (const char* room : {"core", "nodes", "transport", "lua", "graphs", "tools", "tests"})
        std::ranges::move(files_of(room), std::back_inserter(files));
    return files;
}

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

TEST(Project, HasHeadersThatGuardThemselves) { EXPECT_THAT(all_complaints(all_files(), bad_header), IsEmpty()); }

TEST(Project, HasNoFoldersThatIncludeEachOther) { EXPECT_THAT(folder_circles(files_of("core"), "core"), IsEmpty()); }

TEST(Project, HasOneTypeOfEachName) {
    std::vector<SourceFile> product;
    for (const char* room : {"core", "nodes", "transport", "lua", "tools"})
        std::ranges::move(files_of(room), std::back_inserter(product));
    std::erase_if(product, [](const SourceFile& file) { return file.path.ends_with(".lua"); });
    EXPECT_THAT(repeated_types(product), IsEmpty());
}

TEST(Project, HasDocumentsThatShowItsCode) {
    for (const char* document : {"README.md", "CONTRIBUTING.md"})
        EXPECT_THAT(stale_cuts(read(std::filesystem::path(LIGHTNET_SOURCE_DIR) / document), all_files()), IsEmpty());
}

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
