// The layouts of the paper's figures and tables, and one of three levels, in small: the same bytes as one thread gives.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/modes/daemons.hpp"

namespace lightnet::paper_test {
namespace {

using namespace test;
using Words = std::vector<std::string>;

class Paper : public ::testing::TestWithParam<std::string> {
protected:
    // The hosts file, with daemons of this test in place of those that it names.
    std::string with_daemons(const std::string& text) {
        std::string made = text;
        for (std::size_t at = 0; (at = made.find("\nplace \"tcp://", at)) != std::string::npos;) {
            const std::size_t from = at + 8, to = made.find('"', from);
            daemons.push_back(std::make_unique<Daemon>(folder));
            made.replace(from, to - from, daemons.back()->endpoint);
            at = from;
        }
        return folder.write("hosts.lua", made);
    }
    Launch run(const std::string& graph, const Words& more) {
        Words words{"--size", "32x32", "--samples", "4", "--progress", "none", "--cache", "none"};
        if (graph.starts_with("paper/")) words.insert(words.end(), {"-D", "rays=16"});
        if (graph == "paper/figure5.lua") words.insert(words.end(), {"-D", "photons=5000"});
        words.insert(words.end(), more.begin(), more.end());
        return launch(graph_file(graph), folder, words);
    }
    Folder folder;
    std::vector<std::unique_ptr<Daemon>> daemons;
};

TEST_P(Paper, GivesTheBytesOfOneThread) {
    const std::string text = bytes_of(graph_file(GetParam() + ".lua"));
    const std::string before = "-- For ";
    ASSERT_TRUE(text.starts_with(before));
    const std::string folder_of_graph = GetParam().starts_with("paper/") ? "paper/" : "";
    const std::string graph = folder_of_graph + text.substr(before.size(), text.find(':') - before.size());
    const auto serial = run(graph, {"--threads", "1"});
    ASSERT_EQ(serial.code, 0) << serial.said;
    const auto spread = run(graph, {"--hosts", with_daemons(text), "--tile", "16"});
    EXPECT_EQ(spread.code, 0) << spread.said;
    EXPECT_TRUE(spread.picture == serial.picture) << GetParam();
    EXPECT_GT(counter(spread.report, "questions"), 0) << "some should have travelled";
}

INSTANTIATE_TEST_SUITE_P(FiguresAndTables, Paper,
                         testing::Values("paper/hosts/figure3", "paper/hosts/figure5", "paper/hosts/figure7",
                                         "paper/hosts/table1", "paper/hosts/table2", "paper/hosts/table3",
                                         "hosts/chain"),
                         [](const auto& name) { return name.param.substr(name.param.rfind('/') + 1); });

}  // namespace
}  // namespace lightnet::paper_test
