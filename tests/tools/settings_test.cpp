// Who decides what a command line leaves open.
#include "tools/cli/settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/support/fake_registry.hpp"
#include "tests/support/folder.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/daemon/daemon_options.hpp"

namespace lightnet::settings_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Words = std::vector<std::string>;

VerbText run_text() {
    for (const auto& text : launcher_texts(standard_verbs()))
        if (text.name == "lightnet run") return text;
    return {};
}

Settings settings_with(std::map<std::string, std::string> environment, std::vector<SettingLine> lines = {}) {
    return {"LIGHTNET_", std::move(lines), [environment](const std::string& name) -> std::optional<std::string> {
                const auto found = environment.find(name);
                return found == environment.end() ? std::nullopt : std::optional(found->second);
            }};
}

Settled settled_option(const Settings& settings, const Words& words, const std::string& option) {
    for (const auto& one : settings.settled(run_text(), words))
        if (one.option == option) return one;
    return {};
}

TEST(Settings, AreDecidedByTheNearestWhoSpeaks) {
    const std::vector<SettingLine> lines{{"", "wait", "5", {"c.lua", 1}}, {"run", "wait", "6", {"c.lua", 2}}};
    const auto settings = settings_with({{"LIGHTNET_WAIT", "7"}}, lines);
    EXPECT_EQ(settled_option(settings, {"run", "--wait", "8"}, "--wait"), (Settled{"--wait", "8", "command line"}));
    EXPECT_EQ(settled_option(settings, {"run", "--wait=8"}, "--wait").value, "8");
    EXPECT_EQ(settled_option(settings, {"run"}, "--wait"), (Settled{"--wait", "7", "LIGHTNET_WAIT"}));
    EXPECT_EQ(settled_option(settings_with({}, lines), {"run"}, "--wait"), (Settled{"--wait", "6", "c.lua:2"}));
    EXPECT_EQ(settled_option(settings_with({}), {"run"}, "--wait"), (Settled{"--wait", "30", "built in"}));
}

TEST(Settings, BecomeWordsOfTheCommandLine) {
    const auto settings = settings_with({{"LIGHTNET_LOCAL_WORKERS", "2"}, {"LIGHTNET_OUTPUT", "x.exr"}});
    EXPECT_THAT(settings.missing(run_text(), {"run", "g.lua", "-o", "y.exr"}), ElementsAre("--local-workers=2"));
    EXPECT_THAT(settings.missing(run_text(), {"run", "g.lua", "-oy.exr"}), ElementsAre("--local-workers=2"));
}

TEST(Settings, LeaveOutWhatMeansNothingAlone) {
    const std::vector<SettingLine> lines{{"", "partition", "short", {"c.lua", 1}}};
    EXPECT_THAT(settings_with({}, lines).missing(run_text(), {"run", "g.lua"}), IsEmpty());
    EXPECT_THAT(settings_with({}, lines).missing(run_text(), {"run", "g.lua", "--slurm", "2"}),
                ElementsAre("--partition=short"));
}

TEST(Settings, AreReadOfAFile) {
    test::Folder folder;
    const std::string file = folder / "config.lua";
    std::ofstream(file) << "threads = 4\nlocal twice = 2 * 30\nwait = twice\nrun = { insecure = true }\n";
    EXPECT_THAT(load_settings(file),
                ElementsAre(SettingLine{"", "threads", "4", {file, 1}}, SettingLine{"", "wait", "60", {file, 3}},
                            SettingLine{"run", "insecure", "true", {file, 4}}));
    std::ofstream(file) << "threads = {}\nwait = print\n";
    try {
        load_settings(file);
        FAIL() << "a function was taken";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr("config.lua:2: 'wait' takes a text, a number or true"));
    }
    std::ofstream(file) << "while true do end\n";
    EXPECT_THROW(load_settings(file), UserError);
}

class LaunchedWithSettings : public testing::Test {
protected:
    int operator()(Words words, Settings settings) {
        out.str(""), err.str("");
        Launcher launcher{registry, [&](const RunRequest& request) { return seen = request.wait.count(), 7; }, out,
                          err};
        launcher.settings = std::move(settings);
        return launcher(words);
    }
    const Registry registry = test::fake_registry();
    std::ostringstream out, err;
    long seen = 0;
};

TEST_F(LaunchedWithSettings, TellWhereAValueComesFrom) {
    EXPECT_EQ((*this)({"run", "--print-config"}, settings_with({{"LIGHTNET_WAIT", "9"}})), 0);
    EXPECT_THAT(out.str(), HasSubstr("--wait"));
    EXPECT_THAT(out.str(), HasSubstr("  LIGHTNET_WAIT\n"));
    EXPECT_EQ(seen, 0) << "nothing runs";
}

TEST_F(LaunchedWithSettings, NameThemWhenTheyAreWrong) {
    EXPECT_EQ((*this)({"run", "g.lua"}, settings_with({{"LIGHTNET_WAIT", "soon"}})), 2);
    EXPECT_THAT(err.str(), HasSubstr("--wait: must be a whole number"));
    EXPECT_THAT(err.str(), HasSubstr("settled elsewhere (--print-config): --wait=soon"));
}

}  // namespace
}  // namespace lightnet::settings_test
