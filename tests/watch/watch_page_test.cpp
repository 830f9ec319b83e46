// The page is what its sources say, and fetches nothing.
#include "tools/watch/watch_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/base/hash.hpp"
#include "tools/watch/report_page.hpp"

namespace lightnet::watch_page_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// As build.mjs has it.
std::string hash_of_sources() {
    const fs::path folder = fs::path(LIGHTNET_SOURCE_DIR) / "tools/watch/page";
    std::vector<std::string> files{"build.mjs", "index.html", "package-lock.json", "package.json", "vite.config.mjs"};
    for (const auto& entry : fs::directory_iterator(folder / "src"))
        files.push_back("src/" + entry.path().filename().string());
    std::sort(files.begin(), files.end());
    std::string all;
    for (const auto& file : files) {
        std::ifstream in(folder / file, std::ios::binary);
        all += file + '\0' + std::string(std::istreambuf_iterator<char>(in), {}) + '\0';
    }
    return to_hex(content_hash(all));
}

TEST(WatchPage, WasBuiltFromTheSourcesBesideIt) {
    EXPECT_THAT(std::string(watch_page()), HasSubstr("<!--built from " + hash_of_sources() + "-->"))
        << "after a change in tools/watch/page: npm ci && npm run build";
}

TEST(WatchPage, HasPlacesForAReport) {
    const std::string page(watch_page());
    EXPECT_THAT(page, StartsWith(std::string(report_page_beginning)));
    EXPECT_THAT(page, HasSubstr("<!--frozen-->"));
    EXPECT_THAT(page, HasSubstr("<meta charset=\"utf-8\">"));
}

TEST(WatchPage, NamesNothingThatABrowserWouldFetch) {
    const std::string page(watch_page());
    for (const auto* word : {" src=\"", " src='", "@import", "url(http", "<link rel=\"stylesheet", "fetch(\"http"})
        EXPECT_THAT(page, Not(HasSubstr(word)));
}

}  // namespace
}  // namespace lightnet::watch_page_test
