// `lightnet view`: a finished picture in a browser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/modes/daemons.hpp"
#include "tests/watch/visitor.hpp"

namespace lightnet::view_verb_test {
namespace {

using testing::HasSubstr;

/// The program at work, and a page that looks.
class Viewing {
public:
    explicit Viewing(std::vector<std::string> words) : process_(with_program(std::move(words))) {
        const std::string before = "http://127.0.0.1:";
        EXPECT_TRUE(process_.wait_for(before) && process_.wait_for("\n")) << process_.output();
        const auto& said = process_.output();
        const auto at = said.find(before) + before.size();
        const auto port = static_cast<std::uint16_t>(std::atoi(said.c_str() + at));
        const auto token_at = said.find('#', at) + 1;
        token_ = said.substr(token_at, said.find('\n', token_at) - token_at);
        page_.emplace(port);
        EXPECT_TRUE(page_->watch("127.0.0.1:" + std::to_string(port)));
    }

    nlohmann::json hears(const std::string& what) {
        const auto text = page_->next_with("\"" + what + "\"");
        return text ? nlohmann::json::parse(*text)[what] : nlohmann::json();
    }
    void explain(int x, int y) {
        page_->say(nlohmann::json{{"do", "explain"}, {"x", x}, {"y", y}, {"samples", 4}, {"token", token_}}.dump());
    }
    int end() {
        process_.signal(SIGTERM);
        return process_.wait();
    }
    const std::string& said() const { return process_.output(); }

private:
    static std::vector<std::string> with_program(std::vector<std::string> words) {
        words.insert(words.begin(), {test::program("lightnet"), "view"});
        return words;
    }
    test::Process process_;
    std::string token_;
    std::optional<test::Visitor> page_;
};

class ViewVerb : public testing::Test {
protected:
    void render(const std::string& name, const std::string& size = "16x12", const std::string& seed = "1") {
        test::Process run(test::launch_words(test::graph_file("cornell.lua"), folder / name,
                                             {"--size", size, "--seed", seed, "--samples", "16", "--threads", "1"}));
        ASSERT_EQ(run.wait(), 0) << run.output();
    }
    test::Folder folder;
};

TEST_F(ViewVerb, ShowsANetworkAndExplainsPixels) {
    render("x.exr");
    Viewing viewing({folder / "x.exr"});
    const auto hello = viewing.hears("hello");
    EXPECT_EQ(hello["picture"], nlohmann::json({0, 0, 16, 12}));
    EXPECT_GT(hello["nodes"].size(), 3u);
    EXPECT_GT(hello["edges"].size(), 2u);
    viewing.explain(3, 4);
    const auto explained = viewing.hears("explained");
    EXPECT_THAT(explained["text"].get<std::string>(), HasSubstr("x.exr, pixel 3,4")) << explained;
    EXPECT_EQ(viewing.end(), 0) << viewing.said();
}

TEST_F(ViewVerb, ComparesTwoRunsOfOneGraph) {
    render("x.exr"), render("y.exr", "16x12", "7");
    Viewing viewing({folder / "x.exr", folder / "y.exr"});
    const auto hello = viewing.hears("hello");
    EXPECT_EQ(hello["other"]["colours"].size(), hello["colours"].size());
    EXPECT_EQ(viewing.end(), 0) << viewing.said();
}

TEST_F(ViewVerb, ShowsAPictureThatNobodyKnowsTheRunOf) {
    render("x.exr");
    std::filesystem::remove(folder / "x.run.json");
    Viewing viewing({folder / "x.exr"});
    EXPECT_EQ(viewing.hears("hello")["nodes"].size(), 0u);
    EXPECT_EQ(viewing.end(), 0) << viewing.said();
}

TEST_F(ViewVerb, SaysWhatIsWrong) {
    const auto mistaken = [](std::vector<std::string> words) {
        words.insert(words.begin(), {test::program("lightnet"), "view"});
        test::Process process(words);
        EXPECT_EQ(process.wait(), 2) << process.output();
        return process.output();
    };
    EXPECT_THAT(mistaken({folder / "none.exr"}), HasSubstr("none.exr: can't be read"));
    render("x.exr"), render("wide.exr", "20x12");
    EXPECT_THAT(mistaken({folder / "x.exr", folder / "wide.exr"}), HasSubstr("only pictures of the same pixels"));
    EXPECT_THAT(mistaken({folder / "x.exr", "--report", folder / "wide.run.json"}),
                HasSubstr("tells of another picture"));
    EXPECT_THAT(mistaken({folder / "x.exr", "--at", "0.0.0.0:0"}), HasSubstr("--at 0.0.0.0"));
    EXPECT_THAT(mistaken({folder / "x.exr", "--at", "somewhere"}), HasSubstr("an address like 127.0.0.1:8080"));
}

}  // namespace
}  // namespace lightnet::view_verb_test
