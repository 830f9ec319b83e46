// Daemons of this machine that don't start as they should. Scripts stand for daemons.
#include "transport/start/local_workers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/base/allowance.hpp"
#include "core/base/error.hpp"
#include "tests/support/folder.hpp"
#include "transport/start/ssh_workers.hpp"

namespace lightnet::local_workers_test {
namespace {

using testing::HasSubstr;

/// What stands for lightnetd: a script that knows which start it is (`$n`, from 0).
class Stand {
public:
    explicit Stand(const std::string& does) {
        const auto counter = folder_.file("starts");
        path = folder_.write("lightnetd",
                             "#!/bin/sh\nn=$(wc -l < " + counter + ")\necho \"$*\" >> " + counter + "\n" + does + "\n");
        folder_.write("starts", "");
        std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    }
    std::size_t starts() const {
        std::ifstream in(folder_.file("starts"));
        std::size_t count = 0;
        for (std::string line; std::getline(in, line);) ++count;
        return count;
    }
    std::string words() const {
        std::ifstream in(folder_.file("starts"));
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::string path;

private:
    test::Folder folder_;
};

const std::string listens = "echo listening on tcp://127.0.0.1:$((5000 + n)); exec sleep 60";

TEST(LocalWorkers, AreStartedAnewWhenASignalEndsThemAtTheStart) {
    const Stand stand("[ $n -ge 2 ] || kill -9 $$\n" + listens);
    const LocalWorkers workers(stand.path, 1, 1);
    EXPECT_THAT(workers.endpoints(), testing::ElementsAre("tcp://127.0.0.1:5002"));
    EXPECT_EQ(workers.missing(), 0u);
}

TEST(LocalWorkers, AreStartedAnewSoOftenAndNoMore) {
    const Stand stand("kill -9 $$");
    try {
        const LocalWorkers workers(stand.path, 1, 1);
        FAIL() << "it never started";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("the local worker did not start"));
    }
    EXPECT_EQ(stand.starts(), 5u);
}

TEST(LocalWorkers, DoWithoutThoseThatEndByThemselves) {
    const Stand stand("mkdir $0.first 2>/dev/null && exit 1\n" + listens);
    const LocalWorkers workers(stand.path, 3, 1);
    EXPECT_EQ(workers.endpoints().size(), 2u);
    EXPECT_EQ(workers.missing(), 1u);
    EXPECT_EQ(stand.starts(), 3u) << "whoever has said why he ends would say it again";
}

TEST(LocalWorkers, StartAFewAtATime) {
    const unsigned few = 4 * usable_cores();
    // each counts those that have begun to start and not yet spoken
    const Stand stand("d=$0.starting; mkdir -p $d; : > $d/$$; ls $d | wc -l >> $0.seen; sleep .1; rm $d/$$\n" +
                      listens);
    const LocalWorkers workers(stand.path, 3 * few, 1);
    EXPECT_EQ(workers.missing(), 0u);
    std::ifstream in(stand.path + ".seen");
    const std::vector<unsigned> seen{std::istream_iterator<unsigned>(in), {}};
    ASSERT_EQ(seen.size(), 3 * few);
    EXPECT_LE(*std::max_element(seen.begin(), seen.end()), few);
}

TEST(LocalWorkers, AreToldWhereTheirCacheIs) {
    const Stand stand(listens);
    const LocalWorkers workers(stand.path, 1, 1, std::nullopt, {}, "/somewhere/else");
    EXPECT_THAT(stand.words(), HasSubstr("--cache /somewhere/else"));
}

TEST(Restarts, ComeLaterAndLaterAndEnd) {
    Restarts restarts;
    Restarts::Time now{};
    std::chrono::steady_clock::duration last{};
    for (int death = 1; death < Restarts::most_useless_deaths; ++death) {
        restarts.died(now, false);
        ASSERT_FALSE(restarts.due(now));
        auto due = now;
        while (!restarts.due(due)) due += std::chrono::milliseconds(1);
        EXPECT_GT(due - now, last);
        last = due - now;
        now = due;
    }
    restarts.died(now, true);
    EXPECT_FALSE(restarts.given_up()) << "it was of use";
    for (int death = 0; death < Restarts::most_useless_deaths; ++death) restarts.died(now, false);
    EXPECT_TRUE(restarts.given_up());
    EXPECT_FALSE(restarts.due(now + std::chrono::hours(1)));
}

SshWorkers::Request request_to_join(const std::string& endpoint) {
    return {{}, {"ssh"}, "/opt/it's here/lightnetd", endpoint, true, KeyPair::random().open};
}

TEST(SshWorkers, TellNoSecretInTheirCommand) {
    auto request = request_to_join("tcp://desk:7000");
    const auto key = KeyPair::random();
    request.hosts = {{"anna@onyx1", "onyx1", key}};
    const auto script = ssh_script(request, "onyx1");
    EXPECT_THAT(script, HasSubstr("--launcher-key " + request.launcher.text()));
    EXPECT_EQ(script.find(key.secret_text()), std::string::npos);
}

// What a shell makes of the script, with a daemon that only says its words.
std::string words_there(SshWorkers::Request request, const std::string& connection) {
    const test::Folder folder;
    request.program = folder.write("it's here/lightnetd", "#!/bin/sh\necho \"$@\" > " + folder.file("said") + "\n");
    std::filesystem::permissions(request.program, std::filesystem::perms::owner_all);
    const auto command = folder.write("command", ssh_script(request, "onyx'1"));
    EXPECT_EQ(std::system(("SSH_CONNECTION='" + connection + "' sh " + command).c_str()), 0);
    std::ifstream in(folder.file("said"));
    std::string line;
    std::getline(in, line);
    return line;
}

TEST(SshWorkers, DialWhereSshCameFrom) {
    const auto request = request_to_join("tcp://desk:7000");
    EXPECT_THAT(words_there(request, "10.0.0.5 40000 10.0.0.9 22"),
                HasSubstr("--led --quiet --join tcp://10.0.0.5:7000 --name onyx'1 --launcher-key "));
    EXPECT_THAT(words_there(request, "fe80::1%eth0 40000 fe80::2 22"), HasSubstr("--join tcp://[fe80::1%eth0]:7000 "));
    EXPECT_THAT(words_there(request, ""), HasSubstr("--join tcp://desk:7000 ")) << "it doesn't say";
}

TEST(SshWorkers, DialWhereTheyAreTold) {
    auto request = request_to_join("tcp://10.1.1.1:7000");
    request.as_seen_from_there = false;
    EXPECT_THAT(words_there(request, "10.0.0.5 40000 10.0.0.9 22"), HasSubstr("--join tcp://10.1.1.1:7000 "));
}

}  // namespace
}  // namespace lightnet::local_workers_test
