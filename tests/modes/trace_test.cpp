// `--trace`: what all places of a run were busy with, for Perfetto.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/modes/daemons.hpp"
#include "tests/support/schema.hpp"

namespace lightnet::test {
namespace {

using testing::HasSubstr;
using testing::IsSupersetOf;
using Words = std::vector<std::string>;
using Tree = nlohmann::json;
using Thread = std::pair<int, int>;

struct Slice {
    double begin, end;
    std::string name, kind;
};

class Trace : public ::testing::Test {
protected:
    Launch render(const Words& more, const std::string& graph = "cornell.lua") {
        Words words{"--size", "48x48", "--samples", "32", "--cache", "none"};
        words.insert(words.end(), more.begin(), more.end());
        return launch(graph_file(graph), folder, words);
    }
    /// Renders, traced.
    Tree of(Words more, const std::string& graph = "cornell.lua") {
        more.insert(more.end(), {"--trace", file});
        const auto run = render(more, graph);
        EXPECT_EQ(run.code, 0) << run.said;
        picture = run.picture;
        return Tree::parse(bytes_of(file));
    }
    static std::map<Thread, std::vector<Slice>> slices_of(const Tree& trace) {
        std::map<Thread, std::vector<Slice>> slices;
        for (const auto& event : trace["traceEvents"])
            if (event["ph"] == "X")
                slices[{event["pid"], event["tid"]}].push_back(
                    {event["ts"], event["ts"].get<double>() + event["dur"].get<double>(), event["name"], event["cat"]});
        return slices;
    }
    static std::set<std::string> what_ran(const Tree& trace) {
        std::set<std::string> all;
        for (const auto& [thread, slices] : slices_of(trace))
            for (const auto& slice : slices) all.insert(slice.kind + " " + slice.name);
        return all;
    }
    // Slices of a thread lie beside or within each other, or no viewer could draw them.
    static void expect_nested(const Tree& trace) {
        constexpr double rounding = 0.002;  // microseconds
        for (auto& [thread, slices] : slices_of(trace)) {
            auto sorted = slices;
            std::sort(sorted.begin(), sorted.end(), [](const Slice& a, const Slice& b) {
                return std::pair(a.begin, -a.end) < std::pair(b.begin, -b.end);
            });
            std::vector<double> open;
            for (const auto& slice : sorted) {
                while (!open.empty() && open.back() <= slice.begin + rounding) open.pop_back();
                ASSERT_TRUE(open.empty() || slice.end <= open.back() + rounding) << slice.name << " at " << slice.begin;
                open.push_back(slice.end);
            }
        }
    }
    struct Arrows {
        int all = 0, across_hosts = 0;
    };
    // Both ends of an arrow lie in slices, and it does not fly backwards by more than clocks may be wrong.
    static Arrows expect_arrows_to_meet_slices(const Tree& trace) {
        double error = 0;
        for (const auto& clock : trace["otherData"]["clocks"]) error += clock["error_us"].get<double>();
        std::map<std::string, const Tree*> began;
        const auto slices = slices_of(trace);
        Arrows arrows;
        for (const auto& event : trace["traceEvents"]) {
            if (event["ph"] != "s" && event["ph"] != "f") continue;
            const double at = event["ts"];
            const std::string kind = event["ph"] == "s" ? "send" : "take";
            const auto& own = slices.at({event["pid"], event["tid"]});
            EXPECT_TRUE(std::any_of(own.begin(), own.end(), [&](const Slice& slice) {
                return slice.kind == kind && slice.begin <= at + 0.002 && at <= slice.end + 0.002;
            })) << event;
            if (event["ph"] == "s") began.try_emplace(event["id"], &event);
        }
        for (const auto& event : trace["traceEvents"]) {
            if (event["ph"] != "f") continue;
            const auto from = began.find(event["id"]);
            if (from == began.end()) {
                ADD_FAILURE() << "comes from nowhere: " << event;
                continue;
            }
            ++arrows.all;
            arrows.across_hosts += (*from->second)["pid"] != event["pid"];
            EXPECT_GE(event["ts"].get<double>(), (*from->second)["ts"].get<double>() - error - 1);
        }
        return arrows;
    }
    const Folder folder;
    const std::string file = folder / "run.trace.json";
    std::string picture;
};

TEST_F(Trace, ShowsPreparingTilesAndCallsOfOneThread) {
    const Tree trace = of({"--threads", "1", "-D", "photons=1000"}, "progressive.lua");
    EXPECT_THAT(what_ran(trace), IsSupersetOf({"prepare indirect", "tiles image", "call direct", "call indirect"}));
    expect_nested(trace);
}

TEST_F(Trace, ShowsTheSamePictureAndBundlesBetweenThreads) {
    const auto hosts = folder.write("hosts.lua",
                                    "place 'here' { bounce = 1 }\n"
                                    "place 'here' { direct = 1, lighting = 1, image = 1, places = 1 }\n");
    const Tree trace = of({"--hosts", hosts});
    EXPECT_EQ(picture, render({"--threads", "1"}).picture);
    EXPECT_THAT(what_ran(trace), IsSupersetOf({"light bounce", "tiles image", "call lighting", "call direct",
                                               "send send bounce", "take take bounce"}));
    expect_nested(trace);
    EXPECT_GT(expect_arrows_to_meet_slices(trace).all, 0);
}

TEST_F(Trace, ShowsArrowsBetweenDaemonsByOneClock) {
    const Daemon one(folder, 2), other(folder, 2);
    const auto hosts = folder.write("hosts.lua", "place '" + one.endpoint + "' { bounce = 2 }\nplace '" +
                                                     other.endpoint + "' { direct = 1, lighting = 1, image = 1 }\n");
    const Tree trace = of({"--hosts", hosts});
    expect_nested(trace);
    const auto arrows = expect_arrows_to_meet_slices(trace);
    EXPECT_GT(arrows.across_hosts, 0);
    EXPECT_GT(arrows.all, arrows.across_hosts) << "dispatchers deal to places of their own host";
    const auto& clocks = trace["otherData"]["clocks"];
    ASSERT_EQ(clocks.size(), 2u);
    for (const auto& clock : clocks)  // which is the same one here
        EXPECT_LE(std::abs(clock["ahead_us"].get<double>()), clock["error_us"].get<double>() + 1) << clock;
    std::set<std::string> names;
    for (const auto& event : trace["traceEvents"])
        if (event["ph"] == "M") names.insert(event["args"]["name"]);
    EXPECT_THAT(names, IsSupersetOf({one.endpoint, other.endpoint, std::string("dispatcher"), std::string("place 0")}));
}

TEST_F(Trace, IsAsItsSchemaSays) {
    if (!schemas_can_be_checked()) GTEST_SKIP() << "Python's jsonschema is not here";
    const Tree trace = of({"--local-workers", "2", "-D", "photons=1000", "--tile", "8"}, "progressive.lua");
    EXPECT_EQ(complaints_of_schema("trace", file), "");
    Tree wrong = trace;
    wrong["traceEvents"][0]["ph"] = "Q";
    EXPECT_NE(complaints_of_schema("trace", folder.write("wrong.json", wrong.dump())), "");
}

TEST_F(Trace, LeavesFilesOfOthersAlone) {
    const auto mine = folder.write("mine.json", "{\"my\": \"notes\"}");
    const auto refused = render({"--threads", "1", "--trace", mine});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.said, HasSubstr("left alone"));
    EXPECT_EQ(bytes_of(mine), "{\"my\": \"notes\"}");
    of({"--threads", "1"});
    of({"--threads", "1"});  // its own may be replaced
}

}  // namespace
}  // namespace lightnet::test
