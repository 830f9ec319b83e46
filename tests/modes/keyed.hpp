// Runs whose launchers and hosts know each other by keys, for tests.
#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/modes/daemons.hpp"
#include "transport/keys/key_file.hpp"

namespace lightnet::test {

using Words = std::vector<std::string>;

/// Keys are made when they are first named, in a folder of the test; "user" is the launcher's.
class Keys : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        const Folder folder;
        reference = new std::string(launch(graph_file("cornell.lua"), folder, join(size, {"--threads", "1"})).picture);
        ASSERT_FALSE(reference->empty());
    }
    static void TearDownTestSuite() { delete reference; }
    static Words join(Words one, const Words& more) {
        one.insert(one.end(), more.begin(), more.end());
        return one;
    }
    KeyPair key_in(const std::string& name) const { return load_or_make_key(folder.file(name + ".key")); }
    /// A daemon with a key of its own that lets in whom `list` names.
    std::unique_ptr<Daemon> keyed_daemon(const std::string& name, const std::string& list = "launchers") {
        if (!std::filesystem::exists(folder / list)) folder.write(list, user.open.text() + " user\n");
        return std::make_unique<Daemon>(folder, 1, "tcp://127.0.0.1:*",
                                        Words{"--key", folder.file(name + ".key"), "--allow", folder.file(list)});
    }
    std::string place(const std::string& endpoint, const std::string& name, const std::string& nodes = "") const {
        return "place '" + endpoint + "' { " + nodes + "key = '" + key_in(name).open.text() + "' }\n";
    }
    // What stands twice counts as it stands in `more`.
    std::unique_ptr<Process> start(const std::string& hosts, const Words& more = {}) {
        auto words = size;
        words.insert(words.end(), {"--key", folder.file("user.key")});
        for (std::size_t i = 0; i < more.size(); i += 2)
            if (const auto found = std::find(words.begin(), words.end(), more[i]); found != words.end())
                words.erase(found, found + 2);
        if (!hosts.empty()) words = join(words, {"--hosts", folder.write("hosts.lua", hosts)});
        return std::make_unique<Process>(launch_words(graph_file("cornell.lua"), out, join(words, more)));
    }
    static Words long_words(const std::string& samples) {
        return {"--size", "48x48", "--samples", samples, "--tile", "16", "--threads", "2"};
    }
    // The first host of a run that is ready.
    static std::string first_ready(const Process& run) {
        const auto& said = run.output();
        const auto at = said.rfind("tcp://", said.find(" is ready"));
        return said.substr(at, said.find(' ', at) - at);
    }
    static bool is_ready_again(Process& run, const std::string& endpoint) {
        const auto text = endpoint + " is ready";
        const auto patience = std::chrono::steady_clock::now() + slowdown * std::chrono::seconds(20);
        while (std::chrono::steady_clock::now() < patience) {
            if (run.output().find(text, run.output().find("is lost")) != std::string::npos) return true;
            run.wait_for("never said", std::chrono::milliseconds(20));
        }
        return false;
    }
    Launch expect_same(Process& run) {
        auto end = finish(run, out);
        EXPECT_EQ(end.code, 0) << end.said;
        EXPECT_TRUE(end.picture == *reference) << "the bytes differ\n" << end.said;
        return end;
    }

    static inline const Words size{"--size", "48x48", "--samples", "64", "--progress", "json", "--tile", "16"};
    static constexpr const char* endless = "1000000";  // samples: of a run that is ended from outside
    static inline std::string* reference = nullptr;
    Folder folder;
    const KeyPair user = key_in("user");
    std::filesystem::path out = folder / "picture.exr";
};

}  // namespace lightnet::test
