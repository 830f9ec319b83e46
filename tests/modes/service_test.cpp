// The shipped service, as its unit describes it, where there is no systemd to start it.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/modes/daemons.hpp"
#include "tests/support/service_rules.hpp"
#include "transport/keys/key_file.hpp"

namespace lightnet::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

void replace(std::string& text, const std::string& from, const std::string& to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
}

class Service : public ::testing::Test {
protected:
    Service() {
        std::filesystem::create_directory(folder / "home");
        ::setenv("HOME", folder.file("home").c_str(), 1);
    }
    static std::vector<std::string> as_service(const std::string& rules, std::vector<std::string> words) {
        words.insert(words.begin(), {LIGHTNET_IN_SERVICE, rules, std::filesystem::temp_directory_path().string()});
        return words;
    }
    // What the unit starts, where its files lie here, at whatever port is free.
    std::vector<std::string> exec_start() const {
        auto line = ServiceRules(unit).value("ExecStart");
        replace(line, "@LIGHTNET_BINDIR@", LIGHTNET_PROGRAMS);
        replace(line, "%d/key", folder.file("daemon.key"));
        replace(line, "/etc/lightnet/launchers.keys", folder.file("launchers.keys"));
        replace(line, "/var/cache/lightnetd", folder.file("cache"));
        replace(line, ":7777", ":*");
        std::istringstream in(line);
        std::vector<std::string> words;
        for (std::string word; in >> word;) words.push_back(word);
        return words;
    }
    // The unit with other families than it names.
    std::string with_families(const std::string& families) const {
        std::ifstream in(unit);
        std::string text;
        for (std::string line; std::getline(in, line); text += line + "\n")
            if (line.starts_with("RestrictAddressFamilies=")) line = "RestrictAddressFamilies=" + families;
        return folder.write("other.service", text);
    }
    Launch render(const std::vector<std::string>& more) const {
        std::vector<std::string> words{"--size", "32x32", "--samples", "16", "--progress", "plain"};
        words.insert(words.end(), more.begin(), more.end());
        return launch(graph_file("cornell.lua"), folder, words);
    }

    static inline const std::string unit = std::string(LIGHTNET_SOURCE_DIR) + "/packaging/systemd/lightnetd.service.in";
    static inline const std::string without_cards = "AF_UNIX AF_INET AF_INET6";
    Folder folder;
};

TEST_F(Service, OfTheShippedUnitListensAndRenders) {
    const auto daemon_key = load_or_make_key(folder.file("daemon.key"));
    const auto user = load_or_make_key(folder.file("user.key"));
    folder.write("launchers.keys", user.open.text() + " user\n");
    Process daemon(as_service(unit, exec_start()));
    const std::string listening = "listening on ";
    ASSERT_TRUE(daemon.wait_for(listening) && daemon.wait_for("\n")) << daemon.output();
    const auto at = daemon.output().find(listening) + listening.size();
    const auto endpoint = daemon.output().substr(at, daemon.output().find('\n', at) - at);
    const auto hosts = folder.write("hosts.lua", "place '" + endpoint + "' { key = '" + daemon_key.open.text() + "' }");
    const auto end = render({"--hosts", hosts, "--key", folder.file("user.key")});
    EXPECT_EQ(end.code, 0) << end.said << daemon.output();
    EXPECT_THAT(end.said, HasSubstr("is ready"));
    daemon.signal(SIGTERM);
    EXPECT_EQ(daemon.wait(), 0) << daemon.output();
}

TEST_F(Service, MayListenAtANetworkCard) {
    Process daemon(as_service(
        unit, {program("lightnetd"), "--listen", "tcp://lo:*", "--insecure", "--cache", folder.file("cache")}));
    EXPECT_TRUE(daemon.wait_for("listening on tcp://127.0.0.1:")) << daemon.output();
}

TEST_F(Service, ThatMayNotLookAtNetworkCardsSaysSoWhereItWantsTo) {
    const auto rules = with_families(without_cards);
    Process at_card(as_service(
        rules, {program("lightnetd"), "--listen", "tcp://lo:*", "--insecure", "--cache", folder.file("cache")}));
    EXPECT_EQ(at_card.wait(), 1) << at_card.output();
    EXPECT_THAT(at_card.output(), HasSubstr("a service takes AF_NETLINK for that, in RestrictAddressFamilies"));
    for (const auto* where : {"tcp://127.0.0.1:*", "tcp://*:*", "tcp://localhost:*"}) {
        Process at_number(as_service(
            rules, {program("lightnetd"), "--listen", where, "--insecure", "--cache", folder.file("cache")}));
        EXPECT_TRUE(at_number.wait_for("listening on tcp://")) << where << ": " << at_number.output();
    }
}

TEST_F(Service, MayStartLocalWorkers) {
    for (const auto& rules : {unit, with_families(without_cards)}) {
        const auto out = folder / "picture.exr";
        auto words =
            launch_words(graph_file("cornell.lua"), out,
                         {"--size", "32x32", "--samples", "16", "--progress", "plain", "--local-workers", "1"});
        Process run(as_service(rules, words));
        const auto end = finish(run, out);
        EXPECT_EQ(end.code, 0) << end.said;
        EXPECT_THAT(end.said, HasSubstr("is ready"));
        std::filesystem::remove(out);
    }
}

TEST_F(Service, IsHeldToItsRules) {
    const auto refused = [&](const std::string& command, const std::string& rules) {
        Process shell(as_service(rules, {"/bin/sh", "-c", command}));
        return shell.wait() != 0;
    };
    EXPECT_FALSE(refused("true", unit));
    Process mounting({"/bin/sh", "-c", "unshare -m true"});
    if (mounting.wait() == 0) {
        EXPECT_TRUE(refused("touch /etc/lightnet-was-here && rm /etc/lightnet-was-here", unit)) << "it writes to /etc";
    }
    EXPECT_TRUE(refused("unshare -Ur true", unit));
    EXPECT_TRUE(refused("chmod u+s " + folder.write("file", ""), unit));
}

}  // namespace
}  // namespace lightnet::test
