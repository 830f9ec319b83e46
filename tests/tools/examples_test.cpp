// Every help ends in examples, and they work.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <sstream>

#include "tools/cli/launcher.hpp"

namespace lightnet::examples_test {
namespace {

using Words = std::vector<std::string>;

// What stands behind "Example:" or "Examples:", line by line; what is behind a pipe is another program's.
std::vector<Words> examples_in(const std::string& help) {
    std::vector<Words> examples;
    std::istringstream lines(help.substr(std::min(help.rfind("\nExample"), help.size())));
    std::string line;
    std::getline(lines, line);
    std::getline(lines, line);
    while (std::getline(lines, line)) {
        std::istringstream in(line.substr(0, line.find('|')));
        examples.emplace_back(std::istream_iterator<std::string>(in), std::istream_iterator<std::string>());
    }
    return examples;
}

void expect_to_work(Words words) {
    ASSERT_FALSE(words.empty());
    ASSERT_EQ(words[0], "lightnet");
    words.erase(words.begin());
    const auto understood = understand(words, standard_verbs());
    const auto* finished = std::get_if<Finished>(&understood);
    EXPECT_TRUE(!finished || finished->code == 0) << words[0] << ": " << finished->err;
    for (const auto& word : words) {
        const bool ours = word.starts_with("graphs/");
        EXPECT_TRUE(!ours || std::filesystem::exists(std::filesystem::path(LIGHTNET_SOURCE_DIR) / word)) << word;
    }
}

class HelpOf : public testing::TestWithParam<Words> {};

TEST_P(HelpOf, EndsInExamplesThatWork) {
    Words words = GetParam();
    words.push_back("--help");
    const auto understood = understand(words, standard_verbs());
    const auto& help = std::get<Finished>(understood).out;
    const auto examples = examples_in(help);
    EXPECT_FALSE(examples.empty()) << help;
    for (const auto& example : examples) expect_to_work(example);
}

std::vector<Words> every_verb() {
    std::vector<Words> verbs{{}, {"scene", "info"}};
    for (const auto& verb : standard_verbs()) verbs.push_back({verb.name});
    return verbs;
}

INSTANTIATE_TEST_SUITE_P(EveryVerb, HelpOf, testing::ValuesIn(every_verb()), [](const auto& verb) {
    std::string name = "Lightnet";
    for (const auto& word : verb.param) name += "_" + word;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

}  // namespace
}  // namespace lightnet::examples_test
