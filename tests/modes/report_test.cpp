// The report of a run, and its progress for programs: figures that add up, and as their schemas say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/modes/daemons.hpp"
#include "tests/support/schema.hpp"

namespace lightnet::test {
namespace {

using testing::HasSubstr;
using Words = std::vector<std::string>;
using Tree = nlohmann::json;

class Report : public ::testing::Test {
protected:
    /// Renders, and returns the report.
    Tree of(const Words& more, const std::string& graph = "cornell.lua") {
        Words words{"--size", "64x64", "--samples", "32", "--tile", "16"};
        words.insert(words.end(), more.begin(), more.end());
        Process run(launch_words(graph_file(graph), folder / "picture.exr", words));
        EXPECT_EQ(run.wait(), 0) << run.output();
        said = run.output();
        return Tree::parse(bytes_of(report));
    }
    static const Tree& named(const Tree& list, const char* name) {
        for (const auto& one : list)
            if (one["name"] == name) return one;
        ADD_FAILURE() << "there is no " << name;
        return list[0];
    }
    static std::uint64_t questions_between(const Tree& told, const char* from, const char* to) {
        for (const auto& edge : told["edges"])
            if (edge["from"] == from && edge["to"] == to) return edge["questions"];
        ADD_FAILURE() << "there is no edge from " << from << " to " << to;
        return 0;
    }
    static const Tree& edge_between(const Tree& told, const char* from, const char* to) {
        for (const auto& edge : told["edges"])
            if (edge["from"] == from && edge["to"] == to) return edge;
        ADD_FAILURE() << "there is no edge from " << from << " to " << to;
        return told["edges"][0];
    }
    // Whoever does the work, it is the same, but for the part `again` that is done twice at the end; and no thread
    // works longer than it lives.
    static void expect_sound(const Tree& told, double again = 0) {
        const auto asked = questions_between(told, "image", "lighting");
        EXPECT_GT(asked, 64u * 64 * 20);
        for (const char* node : {"direct", "bounce"}) {
            EXPECT_NEAR(double(questions_between(told, "lighting", node)), double(asked), again * double(asked));
            EXPECT_EQ(named(told["nodes"], node)["questions"], questions_between(told, "lighting", node));
        }
        const double blocks = named(told["nodes"], "image")["answered"];
        EXPECT_NEAR(blocks, 16 * 2, again * 16 * 2) << "tiles, times blocks";
        double own = 0, lived = 0;
        for (const auto& node : told["nodes"]) {
            EXPECT_LE(node["own_seconds"].get<double>(), node["seconds"].get<double>()) << node;
            own += node["own_seconds"].get<double>();
        }
        for (const auto& place : told["places"]) {
            EXPECT_GT(place["seconds"].get<double>(), 0) << place;
            EXPECT_LE(place["waiting"].get<double>() + place["idle"].get<double>(), place["seconds"].get<double>());
            lived += place["seconds"].get<double>();
        }
        EXPECT_GT(own, 0);
        EXPECT_LT(own, lived * 1.01);
    }
    const Folder folder;
    const std::string report = folder / "picture.run.json";
    std::string said;
};

TEST_F(Report, TellsWhatEachNodeDidInOneThread) { expect_sound(of({"--threads", "1"})); }

TEST_F(Report, TellsWhatEachNodeDidInThreads) {
    const auto hosts = folder.write("hosts.lua",
                                    "place 'here' { bounce = 1 }\n"
                                    "place 'here' { direct = 1, lighting = 1, image = 1, places = 1 }\n");
    const Tree told = of({"--hosts", hosts});
    expect_sound(told);
    const auto& bounce = named(told["nodes"], "bounce");
    EXPECT_EQ(bounce["answered"], bounce["questions"]) << "all by bundles";
    EXPECT_GT(bounce["bundles"], 0);
    EXPECT_GT(bounce["latency"].get<double>(), 0);
    EXPECT_EQ(named(told["nodes"], "direct")["answered"], 0) << "called by its own place";
    EXPECT_GT(told["places"][1]["waiting"].get<double>(), 0) << "for the one that bounces";
    const auto& sent = edge_between(told, "lighting", "bounce");
    EXPECT_EQ(sent["sent"], sent["questions"]);
    EXPECT_EQ(sent["bundles"], bounce["bundles"]) << "it alone asks there";
    EXPECT_EQ(sent["bytes"].get<std::uint64_t>(), sent["sent"].get<std::uint64_t>() * (56 + 12));
    const auto& called = edge_between(told, "lighting", "direct");
    EXPECT_EQ(called["sent"], 0);
    EXPECT_EQ(called["bytes"], 0);
}

TEST_F(Report, TellsWhatEachNodeDidOnTwoDaemons) {
    const Daemon one(folder), other(folder);
    const auto hosts = folder.write("hosts.lua", "place '" + one.endpoint + "' { bounce = 1, image = 1 }\nplace '" +
                                                     other.endpoint + "' { direct = 1, lighting = 1, image = 1 }\n");
    const Tree told = of({"--hosts", hosts});
    expect_sound(told, 0.25);
    EXPECT_EQ(told["places"].size(), 2u);
    EXPECT_GT(named(told["nodes"], "lighting")["bundles"], 0) << "from where the other image is";
}

TEST_F(Report, TellsHowMuchOfTheLightEachLayerIs) {
    const Tree told = of({"--threads", "1", "--gain", "bounce=0"});
    const auto& direct = named(told["layers"], "direct");
    EXPECT_GT(direct["mean"].get<double>(), 0);
    EXPECT_EQ(named(told["layers"], "bounce")["share"], 0);
    double all = 0;
    for (const auto& layer : told["layers"]) all += layer["share"].get<double>();
    EXPECT_NEAR(all, 1, 1e-9);
}

TEST_F(Report, IsAsItsSchemaSays) {
    if (!schemas_can_be_checked()) GTEST_SKIP() << "Python's jsonschema is not here";
    of({"--threads", "1"});
    EXPECT_EQ(complaints_of_schema("run", report), "");
    of({"--local-workers", "2", "-D", "photons=1000"}, "progressive.lua");
    EXPECT_EQ(complaints_of_schema("run", report), "");
    Tree wrong = Tree::parse(bytes_of(report));
    wrong["nodes"][0].erase("own_seconds");
    EXPECT_THAT(complaints_of_schema("run", folder.write("wrong.json", wrong.dump())), HasSubstr("own_seconds"));
}

TEST_F(Report, OfProgressIsAsItsSchemaSays) {
    if (!schemas_can_be_checked()) GTEST_SKIP() << "Python's jsonschema is not here";
    of({"--threads", "2", "--progress", "json", "-D", "photons=1000"}, "progressive.lua");
    EXPECT_EQ(complaints_of_schema("progress", folder.write("lines.json", said), true), "");
    EXPECT_THAT(said, HasSubstr("\"format\":\"lightnet progress 1\""));
    EXPECT_NE(complaints_of_schema("progress", folder.write("lines.json", "{\"event\":\"other\"}\n"), true), "");
}

}  // namespace
}  // namespace lightnet::test
