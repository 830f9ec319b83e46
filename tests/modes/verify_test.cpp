// Hosts that answer falsely: they are found, taken out, and leave no trace in the picture.
#include <gmock/gmock.h>

#include <csignal>

#include "tests/modes/daemons.hpp"
#include "tests/modes/long_enough.hpp"
#include "transport/keys/key_file.hpp"

namespace lightnet::verify_test {
namespace {

using namespace test;
using ::testing::HasSubstr;
using ::testing::Not;
using Words = std::vector<std::string>;

/// A daemon whose operators of this kind lie in such a part of their answers.
class LyingDaemon {
public:
    LyingDaemon(const Folder& folder, const std::string& kind, const std::string& part, const Words& keys = {})
        : process(with({LIGHTNET_LYING_DAEMON, folder.file("cache of " + kind), kind, part}, keys)) {
        const std::string before = "listening on ";
        EXPECT_TRUE(process.wait_for("\n")) << process.output();
        endpoint = process.output().substr(before.size(), process.output().find('\n') - before.size());
    }
    Process process;
    std::string endpoint;

private:
    static Words with(Words words, const Words& more) {
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
};

class Verify : public ::testing::Test {
protected:
    /// What one thread makes of the graph.
    std::string alone(const std::string& graph, const Words& picture) {
        const Folder other;
        auto words = picture;
        words.insert(words.end(), {"--threads", "1", "--cache", "none"});
        const auto end = launch(graph, other, words);
        EXPECT_EQ(end.code, 0) << end.said;
        return end.picture;
    }
    std::unique_ptr<Process> start(const std::string& graph, const Words& picture, const std::string& hosts,
                                   const Words& more) {
        auto words = picture;
        words.insert(words.end(), {"--hosts", folder.write("hosts.lua", hosts), "--cache", "none"});
        words.insert(words.end(), more.begin(), more.end());
        return std::make_unique<Process>(launch_words(graph, out, words));
    }
    Launch on(const std::string& graph, const Words& picture, const std::string& hosts, const Words& more) {
        return finish(*start(graph, picture, hosts, more), out);
    }
    static std::string whole(const std::string& endpoint) { return "place '" + endpoint + "' {}\n"; }
    static std::string holds(const std::string& endpoint, const std::string& nodes) {
        return "place '" + endpoint + "' { " + nodes + " }\n";
    }

    static inline const Words small{"--size", "48x48", "--samples", "64", "--progress", "json", "--tile", "16"};
    // Enough answers of each host that one who lies in many of them is found for certain.
    static inline const Words larger{"--size", "48x48", "--samples", "128", "--progress", "json", "--tile", "8"};
    const std::string cornell = graph_file("cornell.lua");
    Folder folder;
    std::filesystem::path out = folder / "picture.exr";
};

#ifndef LIGHTNET_LARGE

TEST_F(Verify, OfHonestHostsChangesNoByteAndTakesNobodyOut) {
    const Daemon one(folder), two(folder), three(folder);
    // Of a tenth of few tiles there may be none, but not in all layouts: they are handed out together where they are
    // quick.
    const std::pair<const char*, Words> parts[]{{"100%", small}, {"0.1", larger}};
    const std::string honest[]{alone(cornell, small), alone(cornell, larger)};
    double verified[]{0, 0};
    for (const auto& hosts :
         {whole(one.endpoint) + whole(two.endpoint),
          holds(one.endpoint, "image = 1, lighting = 1") + holds(two.endpoint, "direct = 1, bounce = 1") +
              holds(three.endpoint, "direct = 1, bounce = 1"),
          holds(one.endpoint, "image = 1, direct = 1, lighting = 1") + whole(two.endpoint) +
              holds(three.endpoint, "bounce = 1, image = 1")})
        for (std::size_t i = 0; i < std::size(parts); ++i) {
            const auto& [part, picture] = parts[i];
            const auto end = on(cornell, picture, hosts, {"--verify", part});
            EXPECT_EQ(end.code, 0) << end.said;
            EXPECT_TRUE(end.picture == honest[i]) << hosts << end.said;
            verified[i] += counter(end.report, "verified");
            EXPECT_THAT(end.said, Not(HasSubstr("falsely")));
        }
    for (const double count : verified) EXPECT_GT(count, 0);
}

TEST_F(Verify, OfNodesThatPrepareChangesNoByte) {
    const Daemon one(folder), two(folder), three(folder);
    for (const auto* name : {"irradiance_cache.lua", "traditional.lua"}) {
        const auto graph = graph_file(name);
        const Words picture{"--size", "24x24", "--samples", "16", "--progress", "json", "--tile", "8"};
        const auto end =
            on(graph, picture, whole(one.endpoint) + whole(two.endpoint) + whole(three.endpoint), {"--verify", "50%"});
        EXPECT_EQ(end.code, 0) << end.said;
        EXPECT_TRUE(end.picture == alone(graph, picture)) << name << end.said;
    }
}

class Liars : public Verify, public ::testing::WithParamInterface<const char*> {};

TEST_P(Liars, AmongThreeAreTakenOutAndLeaveNoTrace) {
    const Daemon one(folder), two(folder);
    const LyingDaemon liar(folder, GetParam(), "0.3");
    const auto end =
        on(cornell, larger, whole(one.endpoint) + whole(liar.endpoint) + whole(two.endpoint), {"--verify", "70%"});
    EXPECT_EQ(end.code, 0) << end.said;
    EXPECT_THAT(end.said, HasSubstr(liar.endpoint + " is taken out, as it answers falsely"));
    EXPECT_TRUE(end.picture == alone(cornell, larger)) << end.said;
}

INSTANTIATE_TEST_SUITE_P(Who, Liars, ::testing::Values("PathTracing", "DirectLighting", "RayTracer"),
                         [](const auto& kind) { return std::string(kind.param); });

TEST_F(Verify, FindsWhoLiesToOtherHosts) {
    const Daemon asks(folder), honest(folder), other(folder);
    const LyingDaemon liar(folder, "PathTracing", "1");
    const auto end =
        on(cornell, small,
           holds(asks.endpoint, "image = 1, lighting = 1, direct = 1") + holds(honest.endpoint, "bounce = 1") +
               holds(other.endpoint, "bounce = 1") + holds(liar.endpoint, "bounce = 1"),
           {"--verify", "100%", "--bundle", "64"});
    EXPECT_EQ(end.code, 0) << end.said;
    EXPECT_THAT(end.said, HasSubstr(liar.endpoint + " is taken out, as it answers falsely"));
    EXPECT_THAT(end.said, HasSubstr("(" + asks.endpoint + " asked)"));
    EXPECT_TRUE(end.picture == alone(cornell, small)) << end.said;
}

TEST_F(Verify, BelievesNobodyWhoOnlyPassesOnWhatALiarSays) {
    const Daemon one(folder), two(folder), three(folder);
    const LyingDaemon liar(folder, "DirectLighting", "0.3");
    // Tiles differ, though those who answer them are honest.
    const auto end =
        on(cornell, larger,
           holds(one.endpoint, "image = 1, lighting = 1, bounce = 1") +
               holds(two.endpoint, "image = 1, lighting = 1, bounce = 1") +
               holds(three.endpoint, "image = 1, lighting = 1, bounce = 1") + holds(liar.endpoint, "direct = 1"),
           {"--verify", "60%"});
    EXPECT_EQ(end.code, 0) << end.said;
    EXPECT_THAT(end.said, HasSubstr("the whole network at each host"));
    EXPECT_THAT(end.said, HasSubstr(liar.endpoint + " is taken out, as it answers falsely"));
    for (const auto* honest : {&one, &two, &three})
        EXPECT_THAT(end.said, Not(HasSubstr(honest->endpoint + " is taken out")));
    EXPECT_TRUE(end.picture == alone(cornell, larger)) << end.said;
}

TEST_F(Verify, OfTwoHostsThatDifferWritesNoPicture) {
    const Daemon honest(folder);
    const LyingDaemon liar(folder, "PathTracing", "0.3");
    const auto run = start(cornell, larger, whole(honest.endpoint) + whole(liar.endpoint), {"--verify", "70%"});
    EXPECT_EQ(run->wait(slowdown * std::chrono::seconds(60)), 1) << run->output();
    EXPECT_THAT(run->output(), HasSubstr("nobody can tell which is right"));
    EXPECT_FALSE(std::filesystem::exists(out));
    EXPECT_FALSE(std::filesystem::exists(out.string() + ".checkpoint")) << "a liar's light would be in it";
}

TEST_F(Verify, BelievesThePlacesOfTheLauncher) {
    const LyingDaemon liar(folder, "PathTracing", "0.3");
    const auto end = on(cornell, larger, whole(liar.endpoint), {"--threads", "1", "--verify", "70%"});
    EXPECT_EQ(end.code, 0) << end.said;
    EXPECT_THAT(end.said, HasSubstr(liar.endpoint + " is taken out, as it answers falsely"));
    EXPECT_TRUE(end.picture == alone(cornell, larger)) << end.said;
}

TEST_F(Verify, GoesOnWithThoseWhoDialIn) {
    const LyingDaemon liar(folder, "PathTracing", "0.3");
    const auto run = start(cornell, larger, "place 'left' {}\nplace 'right' {}\n" + whole(liar.endpoint),
                           {"--listen", "tcp://127.0.0.1:*", "--verify", "70%"});
    const auto launcher = join_endpoint(*run);
    const auto left = joining_daemon(folder, launcher, "left"), right = joining_daemon(folder, launcher, "right");
    const auto end = finish(*run, out);
    EXPECT_EQ(end.code, 0) << end.said;
    EXPECT_THAT(end.said, HasSubstr(liar.endpoint + " is taken out, as it answers falsely"));
    EXPECT_TRUE(end.picture == alone(cornell, larger)) << end.said;
}

TEST_F(Verify, FindsLiarsWhoHaveKeys) {
    const auto key_in = [&](const std::string& name) {
        return load_or_make_key(folder.file(name + ".key")).open.text();
    };
    const auto list = folder.write("launchers", key_in("user") + " user\n");
    const auto place = [&](const std::string& endpoint, const std::string& name) {
        return "place '" + endpoint + "' { key = '" + key_in(name) + "' }\n";
    };
    const auto daemon = [&](const std::string& name) {
        return Daemon(folder, 1, "tcp://127.0.0.1:*", {"--key", folder.file(name + ".key"), "--allow", list});
    };
    const auto one = daemon("one"), two = daemon("two");
    key_in("liar");
    const LyingDaemon liar(folder, "PathTracing", "0.3", {folder.file("liar.key"), list});
    const auto end =
        on(cornell, larger, place(one.endpoint, "one") + place(liar.endpoint, "liar") + place(two.endpoint, "two"),
           {"--key", folder.file("user.key"), "--verify", "70%"});
    EXPECT_EQ(end.code, 0) << end.said;
    EXPECT_THAT(end.said, HasSubstr(liar.endpoint + " is taken out, as it answers falsely"));
    EXPECT_TRUE(end.picture == alone(cornell, larger)) << end.said;
}

TEST_F(Verify, LosesNothingWhenHostsDie) {
    auto picture = small;
    launch_for(std::chrono::seconds(2), cornell, picture);
    const Daemon one(folder), two(folder), three(folder);
    const auto run =
        start(cornell, picture, whole(one.endpoint) + whole(two.endpoint) + whole(three.endpoint), {"--verify", "30%"});
    ASSERT_TRUE(run->wait_for("\"event\":\"progress\"")) << run->output();
    two.process->signal(SIGKILL);
    const auto end = finish(*run, out);
    EXPECT_EQ(end.code, 0) << end.said;
    EXPECT_TRUE(end.picture == alone(cornell, picture)) << end.said;
}

TEST_F(Verify, IsAPartOfAWhole) {
    for (const auto* wrong : {"2 %", "-1", "101%", "1.5", "some", ""}) {
        Process run(launch_words(cornell, out, {"--verify", wrong}));
        EXPECT_EQ(run.wait(), 2) << wrong << run.output();
        EXPECT_THAT(run.output(), HasSubstr("a part of all answers is like 2% or 0.02")) << wrong;
    }
}

#else

// Some 50,000 bundles for each of three hosts, of which the last falsifies a hundredth.
TEST_F(Verify, FindsWhoFalsifiesAHundredthWithTwoPercent) {
    const Daemon asks(folder), honest(folder), other(folder);
    const LyingDaemon liar(folder, "PathTracing", "0.01");
    const Words picture{"--size", "96x96", "--samples", "256", "--progress", "json", "--bundle", "16"};
    const auto end =
        on(cornell, picture,
           holds(asks.endpoint, "image = 1, lighting = 1, direct = 1") + holds(honest.endpoint, "bounce = 1") +
               holds(other.endpoint, "bounce = 1") + holds(liar.endpoint, "bounce = 1"),
           {"--verify", "2%"});
    EXPECT_EQ(end.code, 0) << end.said;
    EXPECT_THAT(end.said, HasSubstr(liar.endpoint + " is taken out, as it answers falsely"));
    EXPECT_TRUE(end.picture == alone(cornell, picture)) << end.said;
}

#endif

}  // namespace
}  // namespace lightnet::verify_test
