// How a run stands, in letters.
#include "tools/watch/run_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.hpp"
#include "tools/support/run_report.hpp"

namespace lightnet::run_table_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr const char* hello = R"({"hello":{"graph":"/g/box.lua","nodes":[
    {"name":"scene","kind":"Scene","role":"scene"},{"name":"direct","kind":"DirectLighting","role":"light"},
    {"name":"image","kind":"RayTracer","role":"image"}],"edges":[[2,1]]}})";

// At that second, and so far.
std::string state(double t, double done, int questions, const std::string& more = R"("outcome":"")") {
    return R"({"state":{"t":)" + std::to_string(t) + R"(,"done":)" + std::to_string(done) + R"(,"phase":"render",)" +
           more + R"(,"hosts":[{"name":"onyx","state":"is ready","there":true,"places":2,"answered":7,"looks":[[)" +
           std::to_string(questions) + R"(,0,0,)" + std::to_string(questions) +
           R"(],[0,0,0,0]]}],"nodes":[[0,0,0,0,0,0,0],[)" + std::to_string(questions) + R"(,3,)" +
           std::to_string(questions / 10) + "," + std::to_string(questions) +
           R"(,600,2000000,2],[0,0,0,0,0,0,0]],"edges":[[)" + std::to_string(questions) + ",0,0,0]]}}";
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0, end = 0; (end = text.find('\n', at)) != std::string::npos; at = end + 1)
        lines.push_back(text.substr(at, end - at));
    return lines;
}

TEST(LiveTable, CallsNobodyBusyWhoHasLeft) {
    LiveTable live;
    live.hear(hello);
    auto said = state(10, 0.1, 4000);
    said.replace(said.find("\"there\":true"), 12, "\"there\":false");
    live.hear(said);
    EXPECT_THAT(to_text(live.table(), 120, 40), AllOf(HasSubstr("(gone)"), Not(HasSubstr("50 %"))));
}

TEST(LiveTable, CountsRatesAndTellsTheTimeThatIsLeft) {
    LiveTable live;
    live.hear(hello);
    live.hear(state(10, 0.1, 0));
    live.hear(state(12, 0.2, 4000, R"("left":16,"outcome":"")"));
    live.hear(R"({"log":["1.0\tpreparing direct"]})");
    EXPECT_TRUE(live.changed());
    EXPECT_FALSE(live.changed());
    const auto table = live.table();
    EXPECT_EQ(table.graph, "box.lua");
    EXPECT_EQ(table.left.value(), 16) << "as the run itself says";
    ASSERT_EQ(table.nodes.size(), 2u) << "scenes answer nothing";
    EXPECT_EQ(table.nodes[0].questions, 2000);
    EXPECT_EQ(table.nodes[0].share, 0.5);
    EXPECT_EQ(table.nodes[0].bundle, 10);
    EXPECT_EQ(table.hosts[0].parts[3], 0.5);
    const auto text = to_text(table, 120, 40);
    EXPECT_THAT(text, HasSubstr("box.lua  render  [####................] 20.0 %  12 s, 16 s left"));
    EXPECT_THAT(text, HasSubstr("preparing direct"));
    EXPECT_EQ(live.outcome(), "");
    live.hear(state(13, 1, 5000, R"("outcome":"done")"));
    EXPECT_EQ(live.outcome(), "done");
}

TEST(LiveTable, RefusesWhatNoLauncherSays) {
    LiveTable live;
    EXPECT_THROW(live.hear("nonsense"), Error);
    EXPECT_THROW(live.hear(R"({"state":7})"), Error);
}

TEST(RunTableText, FitsTheTerminal) {
    RunTable table;
    table.graph = "box.lua";
    for (int i = 0; i < 1000; ++i)
        table.hosts.push_back({"tcp://host" + std::to_string(i), "is ready", i != 777, 4, 9, {}});
    table.nodes.resize(3);
    table.lines.assign(50, "ä line that is longer than the terminal is wide, which no terminal should have to break");
    for (const std::size_t rows : {8u, 24u, 50u}) {
        const auto lines = lines_of(to_text(table, 40, rows));
        EXPECT_LT(lines.size(), rows);
        for (const auto& line : lines) EXPECT_LE(line.size(), 42u) << line;
    }
    const auto text = to_text(table, 80, 24);
    EXPECT_THAT(text, HasSubstr("tcp://host777")) << "whoever is gone is seen";
    EXPECT_THAT(text, HasSubstr("and 99"));
}

TEST(RunTableText, SendsNothingToTheTerminalThatItWouldObey) {
    RunTable table;
    table.graph = "box\x1b]0;evil\x07.lua";
    table.lines = {"\x1b[2J", "bell\a"};
    table.hosts.push_back({"a\rb", "x\x1b[1m", true, 1, 1, {}});
    const auto text = to_text(table, 80, 24);
    EXPECT_EQ(std::count_if(text.begin(), text.end(),
                            [](unsigned char letter) { return (letter < 32 && letter != '\n') || letter == 127; }),
              0)
        << text;
}

TEST(RunTableOfAReport, HasItsHostsAndNodes) {
    RunReport report;
    report.graph = "box.lua";
    report.phases = {{"load", 1}, {"render", 9}};
    report.places = {{"onyx", 0, {"direct"}, 10, 2, 3}, {"onyx", 1, {"direct"}, 10, 2, 3}};
    report.nodes = {{"direct", "DirectLighting", 1000, 0, 0, 6, 6, 0.002}, {"image", "RayTracer", 0, 0, 0, 8, 2, 0}};
    report.hosts = {{"onyx", "is lost: no answer", "", "", "", "", 0, 0, 2}};
    report.warnings = {"careful"};
    const auto table = table_of_report(to_json(report));
    EXPECT_EQ(table.seconds, 10);
    EXPECT_EQ(table.done, 1);
    EXPECT_EQ(table.nodes[0].share, 0.75);
    EXPECT_EQ(table.hosts[0].parts[0], 0.5);
    EXPECT_FALSE(table.hosts[0].there);
    EXPECT_THAT(to_text(table, 0, 0), HasSubstr("warning: careful"));
    report.hosts[0].state = "takes no part: somebody who watched the run wanted it so";
    EXPECT_FALSE(table_of_report(to_json(report)).hosts[0].there);
    EXPECT_THROW(table_of_report("{}"), Error);
    EXPECT_THROW(table_of_report("[1"), Error);
}

}  // namespace
}  // namespace lightnet::run_table_test
