// Runs on hosts that know each other by keys.
#include <csignal>
#include <fstream>

#include "tests/modes/keyed.hpp"
#include "tests/support/delaying_proxy.hpp"

namespace lightnet::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(Keys, OfAllHostsOfARunLetThemAskEachOtherStraight) {
    const auto one = keyed_daemon("one"), two = keyed_daemon("two");
    const auto run = start(place(one->endpoint, "one", "image = 1, lighting = 1, ") +
                           place(two->endpoint, "two", "direct = 1, bounce = 1, "));
    const auto end = expect_same(*run);
    EXPECT_EQ(counter(end.report, "relayed_bytes"), 0) << "they know each other's keys";
    EXPECT_EQ(counter(end.report, "broken_packets"), 0);
    for (const auto* daemon : {&*one, &*two})
        EXPECT_THAT(daemon->process->output(), Not(HasSubstr("turns away"))) << "nor was anybody early";
    expect_same(*start(place(two->endpoint, "two")));
}

TEST_F(Keys, ThatAreUnknownWrongOrMissingAreNamedByBothSides) {
    const auto daemon = keyed_daemon("daemon");
    const auto refused = [&](const std::string& hosts, const Words& more) {
        const auto run = start(hosts, more);
        EXPECT_EQ(run->wait(), 4) << run->output();
        return run->output();
    };
    const auto stranger = key_in("stranger").open;
    EXPECT_THAT(refused(place(daemon->endpoint, "daemon"), {"--key", folder.file("stranger.key")}),
                HasSubstr("append this line to its list (lightnetd --allow): " + stranger.text()));
    EXPECT_TRUE(daemon->process->wait_for("fingerprint " + stranger.fingerprint())) << daemon->process->output();
    EXPECT_THAT(refused(place(daemon->endpoint, "stranger"), {}),
                HasSubstr("it has another key than expected (fingerprint " + stranger.fingerprint()));
    // The daemon may close the line before it has said how it speaks: then there is no more than a guess.
    const auto keyless = start("place '" + daemon->endpoint + "' {}", {});
    EXPECT_THAT(keyless->wait(), AnyOf(4, 3)) << keyless->output();
    EXPECT_THAT(keyless->output(), AnyOf(HasSubstr("it asks for keys"), HasSubstr("if it has a key, the hosts file")));
    EXPECT_TRUE(daemon->process->wait_for("somebody who has no key")) << daemon->process->output();
    const Daemon plain(folder);
    EXPECT_THAT(refused(place(plain.endpoint, "daemon"), {}), HasSubstr("or none"));
}

TEST_F(Keys, OfUsersThatAreNotThereYetAreAskedFor) {
    const auto run =
        start("place 'tcp://127.0.0.1:9' { key = '" + user.open.text() + "' }", {"--key", folder.file("none")});
    EXPECT_EQ(run->wait(), 2);
    EXPECT_THAT(run->output(), HasSubstr("lightnet key --key " + folder.file("none") + " makes one"));
}

TEST_F(Keys, ThatAreTakenOffTheListLoseTheirRightsInMidRun) {
    const auto loyal = keyed_daemon("loyal", "loyal.list"), other = keyed_daemon("other", "other.list");
    const auto run = start(place(loyal->endpoint, "loyal") + place(other->endpoint, "other"), {"--samples", "512"});
    ASSERT_TRUE(run->wait_for("\"event\":\"progress\"")) << run->output();
    run->signal(SIGSTOP);  // or it might be done before the list is read again
    folder.write("other.list", "# nobody\n");
    EXPECT_TRUE(other->process->wait_for("the list of launchers has changed")) << other->process->output();
    run->signal(SIGCONT);
    EXPECT_TRUE(run->wait_for("the key of its launcher was taken off the list")) << run->output();
    EXPECT_TRUE(other->process->wait_for("is given up")) << other->process->output();
    const auto end = finish(*run, out);
    EXPECT_EQ(end.code, 0) << end.said;
    const Folder alone;
    EXPECT_TRUE(end.picture == launch(graph_file("cornell.lua"), alone, long_words("512")).picture);
}

TEST_F(Keys, OfHostsThatJoinGiveThemTheirNames) {
    folder.write("hosts.list", key_in("one").open.text() + " onyx1\n" + key_in("two").open.text() + " onyx2\n");
    const auto run = start("place 'onyx1' { image = 1, lighting = 1 }\nplace 'onyx2' { direct = 1, bounce = 1 }",
                           {"--listen", "tcp://127.0.0.1:*", "--allow", folder.file("hosts.list")});
    const auto launcher = join_endpoint(*run);
    const auto dial = [&](const std::string& key, const std::string& name) {
        return joining_daemon(folder, launcher, name,
                              {"--key", folder.file(key + ".key"), "--launcher-key", user.open.text()});
    };
    const auto stranger_key = key_in("stranger").open;
    const auto stranger = dial("stranger", "onyx1");
    EXPECT_TRUE(stranger->wait_for("does not know the key of this host (fingerprint " + stranger_key.fingerprint()))
        << stranger->output();
    EXPECT_TRUE(run->wait_for("fingerprint " + stranger_key.fingerprint())) << run->output();
    const auto one = dial("one", "onyx2"), two = dial("two", "whatever");
    const auto end = expect_same(*run);
    for (const auto* who : {"onyx1 is ready", "onyx2 is ready"}) EXPECT_THAT(end.said, HasSubstr(who));
    EXPECT_GT(counter(end.report, "relayed_bytes"), 0);
    EXPECT_EQ(counter(end.report, "broken_packets"), 0);
}

TEST_F(Keys, OfLaunchersThatAreWrongAreNotSpokenTo) {
    folder.write("hosts.list", key_in("one").open.text() + " onyx1\n");
    const auto run = start("", {"--listen", "tcp://127.0.0.1:*", "--allow", folder.file("hosts.list")});
    const auto one = joining_daemon(folder, join_endpoint(*run), "onyx1",
                                    {"--key", folder.file("one.key"), "--launcher-key", key_in("wrong").open.text()});
    EXPECT_TRUE(one->wait_for("has another key than --launcher-key says")) << one->output();
    run->signal(SIGINT);
    EXPECT_EQ(run->wait(), 130);
}

TEST_F(Keys, LeaveNothingToReadOnTheLine) {
    const std::string secret = "what nobody in between may know";
    folder.write("scene.pbrt", "# " + secret + "\n" + bytes_of(graph_file("cornell_box.pbrt")));
    const auto graph = folder.write("graph.lua",
                                    "scene = Scene { 'scene.pbrt' }\ndirect = DirectLighting {}\n"
                                    "image = RayTracer { direct, scene = scene, samples = 4, film = { 16, 16 } }\n");
    const auto heard = [&](const std::string& endpoint, const std::string& key) {
        DelayingProxy line(endpoint, std::chrono::microseconds(0));
        line.listen_in();
        const auto hosts = folder.write("hosts.lua", "place '" + line.endpoint() + "' { " + key + " }");
        Process run(launch_words(graph, out, {"--hosts", hosts, "--key", folder.file("user.key")}));
        EXPECT_EQ(run.wait(), 0) << run.output();
        EXPECT_GT(line.bytes(), 1000u);
        return line.has_heard(secret) || line.has_heard("DirectLighting");
    };
    const Folder other;
    const Daemon plain(other);
    EXPECT_TRUE(heard(plain.endpoint, "")) << "or nothing was to be heard at all";
    EXPECT_FALSE(heard(keyed_daemon("daemon")->endpoint, "key = '" + key_in("daemon").open.text() + "'"));
}

TEST_F(Keys, AreShownByVerbsAndNeverOverwritten) {
    const auto file = folder.file("config/new.key");
    Process first({program("lightnet"), "key", "--key", file}), again({program("lightnet"), "key", "--key", file});
    EXPECT_EQ(first.wait(), 0);
    EXPECT_EQ(again.wait(), 0);
    const auto key = load_key(file).open;
    EXPECT_THAT(first.output(), HasSubstr(key.text() + " "));
    EXPECT_THAT(again.output(), HasSubstr(key.text() + " "));
    EXPECT_THAT(again.output(), HasSubstr("fingerprint " + key.fingerprint()));
    Process shown({program("lightnetd"), "--key", file, "--print-key"});
    EXPECT_EQ(shown.wait(), 0);
    EXPECT_THAT(shown.output(), HasSubstr(key.text() + "\n"));
}

TEST_F(Keys, ShowTheirUserHowDaemonsAre) {
    const auto daemon = keyed_daemon("daemon");
    const auto hosts = folder.write("hosts.lua", place(daemon->endpoint, "daemon"));
    Process asked({program("lightnet"), "hosts", hosts, "--key", folder.file("user.key")});
    EXPECT_EQ(asked.wait(), 0) << asked.output();
    EXPECT_THAT(asked.output(), HasSubstr("is free"));
    Process by_hand({program("lightnet"), "hosts", daemon->endpoint, "--host-key", key_in("daemon").open.text(),
                     "--key", folder.file("user.key")});
    EXPECT_EQ(by_hand.wait(), 0) << by_hand.output();
    Process looked_at({program("lightnet"), "doctor", "--hosts", hosts, "--key", folder.file("user.key")});
    looked_at.wait();
    EXPECT_THAT(looked_at.output(), HasSubstr("is free, 1 places, round trip"));
}

TEST_F(Keys, LastThroughCutsAndNewLives) {
    auto one = keyed_daemon("one");
    const auto endpoint = one->endpoint;
    const auto two = keyed_daemon("two");
    const auto run = start(place(endpoint, "one") + place(two->endpoint, "two"), {"--samples", "2048"});
    ASSERT_TRUE(run->wait_for("\"event\":\"progress\"")) << run->output();
    two->process->signal(SIGSTOP);  // so that something is left to do for the new life of the other
    one->process->signal(SIGKILL);
    one->process->wait();
    ASSERT_TRUE(run->wait_for(endpoint + " is lost")) << run->output();
    const Daemon anew(folder, 1, endpoint, {"--key", folder.file("one.key"), "--allow", folder.file("launchers")});
    ASSERT_TRUE(is_ready_again(*run, endpoint)) << run->output();
    two->process->signal(SIGCONT);
    const auto end = finish(*run, out);
    EXPECT_EQ(end.code, 0) << end.said;
    const Folder alone;
    EXPECT_TRUE(end.picture == launch(graph_file("cornell.lua"), alone, long_words("2048")).picture);
}

}  // namespace
}  // namespace lightnet::test
