// Manual pages and completions say all that the command line takes.
#include "tools/words/program_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tools/cli/launcher.hpp"
#include "tools/daemon/daemon_options.hpp"

namespace lightnet::program_text_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

VerbText page_of(const std::string& name) {
    for (const auto& page : launcher_texts(standard_verbs()))
        if (page.name == name) return page;
    ADD_FAILURE() << "no page " << name;
    return {};
}

TEST(ProgramText, HasAPageForEachVerb) {
    const auto pages = launcher_texts(standard_verbs());
    EXPECT_EQ(pages.front().name, "lightnet");
    for (const auto& verb : standard_verbs())
        EXPECT_TRUE(std::ranges::any_of(pages, [&](const VerbText& page) {
            return page.name == "lightnet " + verb.name && page.help == verb.help;
        })) << verb.name;
    EXPECT_EQ(page_name(page_of("lightnet scene info")), "lightnet-scene-info");
}

TEST(ProgramText, KnowsWordsAndFlagsApart) {
    const auto run = page_of("lightnet run");
    ASSERT_FALSE(run.options.empty());
    EXPECT_EQ(run.options[0].names, std::vector<std::string>{"GRAPH"});
    EXPECT_TRUE(run.options[0].word && run.options[0].required);
    const auto wait = std::ranges::find_if(run.options, [](const auto& option) { return option.names[0] == "--wait"; });
    ASSERT_NE(wait, run.options.end());
    EXPECT_EQ(wait->value, "SECONDS");
    EXPECT_EQ(wait->initial, "30");
    const auto insecure =
        std::ranges::find_if(run.options, [](const auto& option) { return option.names[0] == "--insecure"; });
    ASSERT_NE(insecure, run.options.end());
    EXPECT_EQ(insecure->value, "") << "a flag takes nothing";
}

TEST(ProgramText, SaysEveryOptionOnEveryPage) {
    auto pages = launcher_texts(standard_verbs());
    std::ranges::copy(daemon_texts(), std::back_inserter(pages));
    for (const auto& page : pages)
        for (const auto& option : page.options) {
            EXPECT_THAT(markdown_page(page), HasSubstr(option.names.back())) << page.name;
            std::string typeset = option.names.back();
            for (std::size_t at = 0; (at = typeset.find('-', at)) != std::string::npos; at += 2)
                typeset.insert(at, "\\");
            EXPECT_THAT(manual_page(page), HasSubstr(typeset)) << page.name;
        }
}

TEST(ProgramText, LetsNoTextCommandTheTypesetter) {
    const VerbText verb{"x y", ".sp 99 \\n", "Example:\n.sp 99\n'x", {}, {}};
    EXPECT_THAT(manual_page(verb),
                AllOf(HasSubstr("\\- \\&.sp 99 \\en"), Not(HasSubstr("\n.sp")), Not(HasSubstr("\n'"))));
}

TEST(ProgramText, CompletesInThreeShells) {
    const auto program = launcher_texts(standard_verbs());
    EXPECT_THAT(bash_completion(program), HasSubstr("'run:--progress') values='auto bar plain json none'"));
    EXPECT_THAT(zsh_completion(program), HasSubstr("'*--progress["));
    EXPECT_THAT(fish_completion(program),
                HasSubstr("complete -c lightnet -n '__fish_seen_subcommand_from run' -l local-workers -r -d "));
    EXPECT_THAT(fish_completion(daemon_texts()), HasSubstr("complete -c lightnetd -l listen -r"));
}

}  // namespace
}  // namespace lightnet::program_text_test
