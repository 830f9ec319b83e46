// `lightnet explain`: how a pixel came about, whoever rendered it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/film/exr.hpp"
#include "core/run/assembly/direct_port.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/modes/daemons.hpp"
#include "tests/support/schema.hpp"
#include "tools/explain/explanation_json.hpp"
#include "tools/explain/past_run.hpp"
#include "tools/explain/pixel_account.hpp"

namespace lightnet::test {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using Words = std::vector<std::string>;
using Tree = nlohmann::json;

class Explain : public ::testing::Test {
protected:
    void render(const std::string& graph, const Words& more) const {
        Process run(launch_words(graph, picture, more));
        ASSERT_EQ(run.wait(), 0) << run.output();
    }
    Process explain(const std::string& pixel, const Words& more = {}) const {
        Words words{program("lightnet"), "explain", picture, pixel};
        words.insert(words.end(), more.begin(), more.end());
        return Process(words);
    }
    void expect_equal(const std::string& pixel) const {
        Process told = explain(pixel);
        EXPECT_EQ(told.wait(), 0) << told.output();
        EXPECT_THAT(told.output(), HasSubstr("all bits of all layers are those of the picture"));
    }
    Tree json(const std::string& pixel, Words more = {}) const {
        more.push_back("--json");
        Process told = explain(pixel, more);
        EXPECT_EQ(told.wait(), 0) << told.output();
        return Tree::parse(told.output());
    }
    const Folder folder;
    const std::string picture = folder / "picture.exr";
    const Words small{"--size", "16x16", "--samples", "40", "--threads", "1", "--progress", "none"};
};

struct Case {
    const char* name;
    const char* graph;
    Words more;
    friend void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }
};

class ExplainGraph : public Explain, public testing::WithParamInterface<Case> {};

TEST_P(ExplainGraph, GivesTheBitsOfThePicture) {
    Words words{"--size", "16x16", "--progress", "none"};
    words.insert(words.end(), GetParam().more.begin(), GetParam().more.end());
    render(graph_file(GetParam().graph), words);
    expect_equal("5,9");
    expect_equal("12,13");
}

INSTANTIATE_TEST_SUITE_P(
    Graphs, ExplainGraph,
    testing::Values(
        Case{"Serial", "cornell.lua", {"--threads", "1", "--samples", "40", "--seed", "7"}},
        Case{"Threads", "cornell.lua", {"--threads", "2", "--samples", "40", "--gain", "bounce=0.5"}},
        Case{"Glass", "path_all.lua", {"--threads", "2", "--samples", "40"}},
        Case{"Facts", "facts.lua", {"--threads", "2", "--samples", "40"}},
        Case{"Crop", "cornell.lua", {"--threads", "2", "--samples", "16", "--crop", "4,5,14,16", "--exposure", "-1"}},
        Case{"Cache", "irradiance_cache.lua", {"--threads", "2", "--samples", "4"}},
        Case{"Passes", "progressive.lua", {"--threads", "2", "--samples", "40", "-D", "photons=1000"}},
        Case{"ManyGroups", "direct.lua", {"--threads", "2", "--samples", "200"}}),
    [](const auto& one) { return one.param.name; });

TEST_F(Explain, GivesTheBitsOfARunOnTwoDaemons) {
    const Daemon one(folder), other(folder);
    const auto hosts = folder.write("hosts.lua", "place '" + one.endpoint + "' { bounce = 1, image = 1 }\nplace '" +
                                                     other.endpoint + "' { direct = 1, lighting = 1, image = 1 }\n");
    render(graph_file("cornell.lua"), {"--size", "16x16", "--samples", "40", "--hosts", hosts});
    expect_equal("8,12");
}

TEST_F(Explain, GivesThemWhereCellsDecideAboutTheirSamples) {
    folder.write("cornell_box.pbrt", bytes_of(graph_file("cornell_box.pbrt")));
    auto text = bytes_of(graph_file("cornell.lua"));
    text.insert(text.find("samples = samples"), "error = 0.03, ");
    render(folder.write("adaptive.lua", text), {"--size", "20x20", "--samples", "256", "--threads", "2"});
    const Picture had = read_exr(picture);
    const auto [least, most] = std::minmax_element(had.samples.begin(), had.samples.end());
    ASSERT_LT(*least, *most) << "their number differs";
    for (const auto one : {least, most}) {
        const auto index = one - had.samples.begin();
        expect_equal(std::to_string(index % 20) + "," + std::to_string(index / 20));
    }
    expect_equal("19,19");
}

TEST_F(Explain, TellsOfASceneThatWasRenderedWithoutAGraph) {
    const auto scene = folder.write("cornell_box.pbrt", bytes_of(graph_file("cornell_box.pbrt")));
    Process run({program("lightnet"), "render", scene, "--size", "16x16", "--samples", "16", "-o", picture});
    ASSERT_EQ(run.wait(), 0) << run.output();
    expect_equal("8,12");
}

TEST_F(Explain, PutsTheBrightestSampleFirst) {
    render(graph_file("cornell.lua"), small);
    const Tree all = json("8,12", {"--most", "40"});
    ASSERT_EQ(all["brightest"].size(), 40u);
    const auto luminance_of = [](const Tree& c) {
        return 0.2126 * c[0].get<double>() + 0.7152 * c[1].get<double>() + 0.0722 * c[2].get<double>();
    };
    double before = 1e30, sum = 0;
    for (const auto& sample : all["brightest"]) {
        const double now = luminance_of(sample["colour"]);
        EXPECT_LE(now, before * 1.00001);
        before = now;
        sum += now / 40;
    }
    EXPECT_NEAR(sum, luminance_of(all["colour"]), 1e-5 * sum) << "they are all of the pixel";
    const Tree alone = json("8,12", {"--sample", "3"});
    ASSERT_EQ(alone["brightest"].size(), 1u);
    EXPECT_EQ(alone["brightest"][0]["sample"], 3);
}

TEST_F(Explain, TellsWhatAnswersAreMadeOf) {
    render(graph_file("cornell.lua"), small);
    const Tree all = json("8,12", {"--most", "40"});
    for (const auto& sample : all["brightest"]) {
        const Tree& asked = sample["questions"];
        ASSERT_EQ(asked.size(), 3u) << "lighting, direct, bounce";
        EXPECT_EQ(asked[0]["asked"], "lighting");
        EXPECT_EQ(asked[0]["within"], nullptr);
        for (std::size_t k : {1u, 2u}) {
            EXPECT_EQ(asked[k]["within"], 0);
            EXPECT_EQ(asked[k]["answer"][0], asked[0]["answer"][k - 1]) << "what Combine passes on";
            EXPECT_EQ(sample["layers"][asked[k]["asked"].get<std::string>()], asked[k]["answer"][0]);
        }
        EXPECT_EQ(sample["rays"][0]["meets"]["position"], asked[0]["surface"]["position"]);
        EXPECT_THAT(asked[0]["surface"]["where"].get<std::string>(), ContainsRegex("cornell_box.pbrt:[0-9]+"));
    }
}

TEST_F(Explain, SpeaksAsItsSchemaSays) {
    if (!schemas_can_be_checked()) GTEST_SKIP() << "Python's jsonschema is not here";
    render(graph_file("facts.lua"), small);
    const auto file = folder.write("told.json", json("8,12", {"--most", "5"}).dump());
    EXPECT_EQ(complaints_of_schema("explanation", file), "");
    EXPECT_NE(complaints_of_schema("explanation", folder.write("other.json", "{\"format\": 1}")), "");
}

// Asks nodes of a network, which ask each other by function calls.
class Asked {
public:
    explicit Asked(const Network& network)
        : assembly_(network, [this](std::size_t node, std::size_t width) { return port_to(node, width); }, {}) {}
    std::vector<Rgb> operator()(const AskedQuestion& asked) {
        std::vector<Rgb> answer(asked.answer.size());
        port_to(asked.asked, answer.size())->begin({&asked.question, 1}, answer);
        return answer;
    }

private:
    Port* port_to(std::size_t node, std::size_t width) {
        return ports_.emplace_back(std::make_unique<DirectPort>(assembly_.callee(node), width, count_)).get();
    }
    std::uint64_t count_ = 0;
    std::vector<std::unique_ptr<DirectPort>> ports_;
    Assembly assembly_;
};

TEST_F(Explain, PrintsQuestionsThatCanBeAskedAgain) {
    render(graph_file("cornell.lua"), small);
    const Registry registry{standard_nodes()};
    const auto past = read_past_run(folder / "picture.run.json", registry);
    const auto network = account_for(read_exr(picture), past, 8, 12, registry).network;
    for (const char* node : {"lighting", "bounce"}) {
        Process told = explain("8,12", {"--at", node});
        ASSERT_EQ(told.wait(), 0) << told.output();
        Asked ask(*network);
        std::istringstream lines(told.output());
        int count = 0;
        for (std::string line; std::getline(lines, line); ++count) {
            const AskedQuestion asked = question_of_line(line, network->graph);
            EXPECT_EQ(network->graph.nodes[asked.asked].name, node);
            const auto again = ask(asked);
            ASSERT_EQ(again.size(), asked.answer.size());
            EXPECT_EQ(std::memcmp(again.data(), asked.answer.data(), again.size() * sizeof(Rgb)), 0) << line;
        }
        EXPECT_EQ(count, 40) << node << ": one of each sample";
    }
}

TEST_F(Explain, CallsACollisionByItsLetter) {
    render(graph_file("fog.lua"), small);
    Process told = explain("8,8");
    EXPECT_EQ(told.wait(), 0) << told.output();
    EXPECT_THAT(told.output(), HasSubstr("V, a collision in a medium"));
}

TEST_F(Explain, DrawsThePathsOverThePicture) {
    render(graph_file("cornell.lua"), small);
    Process told = explain("8,12", {"--paths", folder / "paths.png"});
    ASSERT_EQ(told.wait(), 0) << told.output();
    EXPECT_THAT(told.output(), AllOf(HasSubstr("image white"), HasSubstr("bounce magenta")));
    const auto png = bytes_of(folder / "paths.png");
    ASSERT_GT(png.size(), 1000u);
    EXPECT_EQ(png.substr(16, 8), std::string("\0\0\x03\x80\0\0\x03\x80", 8))
        << "896 x 896: small pictures are enlarged";
    const auto mine = folder.write("mine.png", "my notes");
    EXPECT_EQ(explain("8,12", {"--paths", mine}).wait(), 1);
    EXPECT_EQ(bytes_of(mine), "my notes");
}

TEST_F(Explain, SaysWhatItCantTell) {
    render(graph_file("cornell.lua"), small);
    const auto expect_refusal = [&](const std::string& pixel, const Words& more, const std::string& why) {
        Process told = explain(pixel, more);
        EXPECT_EQ(told.wait(), 2);
        EXPECT_THAT(told.output(), HasSubstr(why));
    };
    expect_refusal("16,3", {}, "has no pixel 16,3: its pixels go from 0,0 to 15,15");
    expect_refusal("3", {}, "PIXEL");
    expect_refusal("3,3", {"--sample", "40"}, "the pixel has samples 0 to 39");
    expect_refusal("3,3", {"--at", "bonce"}, "the graph has no node 'bonce' (did you mean 'bounce'?)");
    expect_refusal("3,3", {"--report", folder / "none.json"}, "can't be read; it tells from which graph");
    expect_refusal("3,3", {"--report", folder.write("old.run.json", "{\"graph\": {\"file\": \"x.lua\"}}")},
                   "older version");
    Process other(launch_words(graph_file("direct.lua"), folder / "other.exr", {"--size", "16x16", "--samples", "1"}));
    ASSERT_EQ(other.wait(), 0) << other.output();
    expect_refusal("3,3", {"--report", folder / "other.run.json"}, "size or layers differ");
}

TEST_F(Explain, NoticesASceneThatHasChanged) {
    const auto scene = folder.write("cornell_box.pbrt", bytes_of(graph_file("cornell_box.pbrt")));
    render(folder.write("cornell.lua", bytes_of(graph_file("cornell.lua"))), small);
    auto text = bytes_of(scene);
    const auto at = text.find("\"rgb L\"");
    ASSERT_NE(at, std::string::npos);
    text.replace(text.find('[', at) + 1, 1, "9");
    folder.write("cornell_box.pbrt", text);
    Process told = explain("8,12");
    EXPECT_EQ(told.wait(), 1);
    EXPECT_THAT(told.output(), HasSubstr("its scene or the program has changed"));
}

}  // namespace
}  // namespace lightnet::test
