// Runs on hosts that know each other by keys, and those who would like to have a part in them.
#include <gmock/gmock.h>

#include <csignal>
#include <fstream>

#include "core/base/build_info.hpp"
#include "tests/modes/daemons.hpp"
#include "tests/modes/stranger.hpp"
#include "tests/support/delaying_proxy.hpp"
#include "transport/keys/key_file.hpp"

namespace lightnet::test {
namespace {

using packet::Fields;
using packet::Type;
using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;
using ::testing::Not;
using Words = std::vector<std::string>;

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
    static bool is_ready_again(Process& run, const std::string& endpoint) {
        const auto text = endpoint + " is ready";
        const auto patience = std::chrono::steady_clock::now() + slowdown * seconds(20);
        while (std::chrono::steady_clock::now() < patience) {
            if (run.output().find(text, run.output().find("is lost")) != std::string::npos) return true;
            run.wait_for("never said", milliseconds(20));
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
        const auto begun = std::chrono::steady_clock::now();
        const auto run = start(hosts, more);
        EXPECT_EQ(run->wait(slowdown * seconds(10)), 4) << run->output();
        EXPECT_LT(std::chrono::steady_clock::now() - begun, slowdown * seconds(3));
        return run->output();
    };
    const auto stranger = key_in("stranger").open;
    EXPECT_THAT(refused(place(daemon->endpoint, "daemon"), {"--key", folder.file("stranger.key")}),
                HasSubstr("append this line to its list (lightnetd --allow): " + stranger.text()));
    EXPECT_TRUE(daemon->process->wait_for("fingerprint " + stranger.fingerprint())) << daemon->process->output();
    EXPECT_THAT(refused(place(daemon->endpoint, "stranger"), {}),
                HasSubstr("it has another key than expected (fingerprint " + stranger.fingerprint()));
    EXPECT_THAT(refused("place '" + daemon->endpoint + "' {}", {}), HasSubstr("it asks for keys"));
    EXPECT_TRUE(daemon->process->wait_for("somebody who has no key")) << daemon->process->output();
    const Daemon plain(folder);
    EXPECT_THAT(refused(place(plain.endpoint, "daemon"), {}), HasSubstr("or none"));
}

TEST_F(Keys, OfUsersThatAreNotThereYetAreAskedFor) {
    const auto run =
        start("place 'tcp://127.0.0.1:9' { key = '" + user.open.text() + "' }", {"--key", folder.file("none")});
    EXPECT_EQ(run->wait(slowdown * seconds(5)), 2);
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
    EXPECT_TRUE(run->wait_for("the key of its launcher was taken off the list", slowdown * seconds(5)))
        << run->output();
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

// Each kind of packet there is, without a number of a run and with a guess.
std::vector<packet::Packet> all_packets() {
    std::vector<packet::Packet> all;
    for (std::uint8_t type = 1; type <= static_cast<std::uint8_t>(Type::last); ++type)
        for (const std::uint64_t run : {0, 5})
            all.push_back(packet::pack(
                static_cast<Type>(type), run,
                Fields{}.set("build", build_id()).set("isa", "sse4.2").set("name", "x").set("process", 3)));
    return all;
}

TEST_F(Keys, ThatNobodyKnowsGetNoWordOutOfADoor) {
    const auto daemon = keyed_daemon("daemon");
    const auto run =
        start("", {"--local-workers", "1", "--listen", "tcp://127.0.0.1:*", "--allow",
                   folder.write("hosts.list", key_in("one").open.text() + " onyx1\n"), "--samples", endless});
    const auto launcher = join_endpoint(*run);
    ASSERT_TRUE(run->wait_for(" is ready")) << run->output();
    const auto at = run->output().rfind("tcp://", run->output().find(" is ready"));
    const auto worker = run->output().substr(at, run->output().find(' ', at) - at);
    for (const auto& [endpoint, key] :
         {std::pair{daemon->endpoint, key_in("daemon").open}, {launcher, user.open}, {worker, key_in("guess").open}}) {
        for (const auto& keys : {std::optional<LineKeys>(), std::optional(LineKeys{KeyPair::random(), key})}) {
            Stranger stranger(endpoint, 300, keys);
            for (const auto& packet : all_packets()) stranger.send(packet);
            EXPECT_EQ(stranger.receive().first, Type::ping) << endpoint << ": nothing came";
        }
    }
    run->signal(SIGINT);
    EXPECT_EQ(run->wait(), 130) << run->output();
}

TEST_F(Keys, OfTwoUsersKeepTheirRunsFromEachOther) {
    folder.write("launchers", user.open.text() + " user\n" + key_in("second").open.text() + " second\n");
    const auto daemon = keyed_daemon("daemon");
    const auto run = start(place(daemon->endpoint, "daemon"), {"--samples", endless});
    ASSERT_TRUE(run->wait_for("\"event\":\"progress\"")) << run->output();
    Stranger second(daemon->endpoint, 5000, LineKeys{key_in("second"), key_in("daemon").open});
    second.send(packet::pack(Type::status, 0, {}));
    const auto [type, state] = second.receive();
    EXPECT_EQ(type, Type::state);
    EXPECT_EQ(state.text("state"), "serves");
    EXPECT_EQ(state.text("who"), "");
    EXPECT_EQ(state.text("nodes"), "");
    second.send(packet::pack(Type::begin, 5, Fields{}.set("job", "{}").set("plan", "{}").set("you", "x")));
    const auto [answer, busy] = second.receive();
    EXPECT_EQ(answer, Type::refuse);
    EXPECT_EQ(busy.text("text"), "it serves another run");
    for (const auto& packet : all_packets()) second.send(packet);
    second.send(packet::pack(Type::status, 0, {}));
    while (true) {  // what was said before it has been looked at by then
        const auto [said, fields] = second.receive();
        ASSERT_NE(said, Type::ping) << "nothing came";
        if (said != Type::state) continue;
        EXPECT_EQ(fields.text("state"), "serves");
        break;
    }
    run->signal(SIGINT);
    EXPECT_EQ(run->wait(), 130) << run->output();
    EXPECT_THAT(run->output(), Not(HasSubstr("is lost")));
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
