// `lightnet run --ssh`: daemons that are started by ssh, for one run. A script stands for ssh; a real one is tried
// where its server is installed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <thread>

#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;
using testing::Not;
using Clock = std::chrono::steady_clock;

class Ssh : public ::testing::Test {
protected:
    // Stands for ssh: does here what it is told, and notes its words.
    std::string stand_in(const std::string& before = "") {
        const auto path = folder.write("ssh", "#!/bin/sh\nprintf '%s\\n' \"$@\" >> " + folder.file("words") + "\n" +
                                                  before + "\nfor last; do :; done\nexec sh -c \"$last\"\n");
        std::filesystem::permissions(path, std::filesystem::perms::owner_all);
        return path;
    }
    std::vector<std::string> words(const std::vector<std::string>& more) const {
        std::vector<std::string> all{"--size", "48x48",      "--samples", "32",       "--tile",
                                     "16",     "--progress", "json",      "--listen", "tcp://127.0.0.1:*"};
        all.insert(all.end(), more.begin(), more.end());
        return launch_words(graph_file("cornell.lua"), folder / "picture.exr", all);
    }
    // All daemons that dial here are gone.
    static bool gone(const std::string& endpoint) {
        const auto end = Clock::now() + slowdown * seconds(20);
        while (!processes_with("--join " + endpoint).empty() && Clock::now() < end)
            std::this_thread::sleep_for(milliseconds(20));
        return processes_with("--join " + endpoint).empty();
    }
    std::string reference() const {
        const Folder other;
        return launch(graph_file("cornell.lua"), other,
                      {"--size", "48x48", "--samples", "32", "--tile", "16", "--threads", "1"})
            .picture;
    }

    Folder folder;
};

TEST_F(Ssh, StartsDaemonsForARunAndEndsThem) {
    Process run(words({"--ssh", "anna@left,right", "--ssh-command", stand_in() + " -p 2222"}));
    const auto endpoint = join_endpoint(run);
    const auto end = finish(run, folder / "picture.exr");
    EXPECT_EQ(end.code, 0) << end.said;
    EXPECT_TRUE(end.picture == reference()) << "the bytes differ";
    EXPECT_THAT(end.said, HasSubstr("left is ready"));
    EXPECT_THAT(end.said, HasSubstr("right is ready"));
    EXPECT_TRUE(gone(endpoint));
    const auto told = bytes_of(folder / "words");
    EXPECT_THAT(told, HasSubstr("-p\n2222\nanna@left\n"));
    EXPECT_THAT(told, Not(HasSubstr("--key"))) << "no key, and no file of one";
}

TEST_F(Ssh, EndsDaemonsAlsoWhenTheLauncherIsKilled) {
    auto all = words({"--ssh", "left", "--ssh-command", stand_in(), "--samples", "1000000"});
    Process run(all);
    const auto endpoint = join_endpoint(run);
    ASSERT_TRUE(run.wait_for("left is ready")) << run.output();
    ASSERT_FALSE(processes_with("--join " + endpoint).empty());
    run.signal(SIGKILL);
    run.wait();
    EXPECT_TRUE(gone(endpoint));
}

TEST_F(Ssh, StartsALostDaemonAnew) {
    Process run(words({"--ssh", "left", "--ssh-command", stand_in(), "--samples", "512"}));
    const auto endpoint = join_endpoint(run);
    ASSERT_TRUE(run.wait_for("left is ready")) << run.output();
    for (const int process : processes_with("--join " + endpoint)) ::kill(process, SIGKILL);
    EXPECT_TRUE(run.wait_for("it is tried again")) << run.output();
    EXPECT_EQ(run.wait(slowdown * seconds(120)), 0) << run.output();
    EXPECT_TRUE(gone(endpoint));
}

TEST_F(Ssh, SaysWhenNobodyCanBeReached) {
    Process run(words({"--ssh", "nowhere", "--ssh-command", stand_in("exit 255"), "--wait", "0"}));
    EXPECT_EQ(run.wait(), 3) << run.output();
    EXPECT_THAT(run.output(), HasSubstr("ssh to nowhere: could not connect"));
    EXPECT_THAT(run.output(), HasSubstr("nowhere: has not joined"));
}

TEST_F(Ssh, SaysWhenThereIsNoDaemonThere) {
    Process run(words({"--ssh", "bare", "--ssh-command", stand_in("PATH=/usr/bin:/bin; export PATH"), "--ssh-daemon",
                       "/nowhere/lightnetd", "--wait", "0"}));
    EXPECT_EQ(run.wait(), 3) << run.output();
    EXPECT_THAT(run.output(), HasSubstr("found no lightnetd there (code 127): install it, or say --ssh-daemon PATH"));
}

/// A server of ssh of this user, for this user, on a port of its own. Null where there is none to be had.
class Server {
public:
    explicit Server(const Folder& folder) {
        const auto make = [&](const char* name) {
            Process keygen({"/usr/bin/env", "ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", folder.file(name)});
            return keygen.wait() == 0;
        };
        if (::access("/usr/sbin/sshd", X_OK) != 0 || !make("host") || !make("user")) return;
        if (::geteuid() == 0) std::filesystem::create_directories("/run/sshd");
        std::filesystem::copy_file(folder.file("user.pub"), folder.file("authorized"));
        for (int tries = 0; tries < 20 && !there; ++tries) {
            port = std::to_string(20000 + (::getpid() * 7 + tries * 131) % 20000);
            const auto config = folder.write(
                "sshd_config", "Port " + port + "\nListenAddress 127.0.0.1\nHostKey " + folder.file("host") +
                                   "\nAuthorizedKeysFile " + folder.file("authorized") +
                                   "\nStrictModes no\nUsePAM no\nPidFile none\nPasswordAuthentication no\n"
                                   "PermitRootLogin yes\n");
            process = std::make_unique<Process>(std::vector<std::string>{"/usr/sbin/sshd", "-D", "-e", "-f", config});
            there = process->wait_for("listening on");
        }
        command =
            "ssh -T -o BatchMode=yes -o StrictHostKeyChecking=no -o UserKnownHostsFile=/dev/null -o LogLevel=ERROR "
            "-p " +
            port + " -i " + folder.file("user");
    }
    bool there = false;
    std::string port, command;
    std::unique_ptr<Process> process;
};

TEST_F(Ssh, WorksWithARealServer) {
    const Server server(folder);
    if (!server.there) GTEST_SKIP() << "no sshd, of Debian's package openssh-server, can be started here";
    Process run({program("lightnet"), "run", graph_file("cornell.lua"), "-o", folder.file("picture.exr"), "--size",
                 "48x48", "--samples", "32", "--tile", "16", "--progress", "json", "--ssh", "127.0.0.1",
                 "--ssh-command", server.command});
    const auto endpoint = join_endpoint(run);
    const auto end = finish(run, folder / "picture.exr");
    EXPECT_EQ(end.code, 0) << end.said;
    EXPECT_TRUE(end.picture == reference()) << "the bytes differ";
    EXPECT_THAT(end.said, HasSubstr("127.0.0.1 is ready"));
    const auto port = endpoint.substr(endpoint.rfind(':'));
    EXPECT_TRUE(gone("tcp://127.0.0.1" + port));
}

TEST_F(Ssh, EndsDaemonsBehindARealServerWhenTheLauncherIsKilled) {
    const Server server(folder);
    if (!server.there) GTEST_SKIP() << "no sshd, of Debian's package openssh-server, can be started here";
    Process run(words({"--ssh", "localhost", "--ssh-command", server.command, "--samples", "1000000"}));
    const auto endpoint = join_endpoint(run);
    ASSERT_TRUE(run.wait_for("localhost is ready")) << run.output();
    run.signal(SIGKILL);
    run.wait();
    EXPECT_TRUE(gone(endpoint));
}

}  // namespace
}  // namespace lightnet::test
