// Hosts that are there and of no use: what is private trouble stays private, and never costs the picture.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <thread>
#include <vector>

#include "core/base/hash.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "tests/modes/daemons.hpp"
#include "tests/modes/stranger.hpp"

namespace lightnet::test {
namespace {

using packet::Fields;
using packet::Type;
using std::chrono::seconds;
using ::testing::HasSubstr;

const std::vector<std::string> tiny{"--size", "32x32", "--samples", "4", "--progress", "json"};

// Welcomes launchers, answers their pings, and does nothing else.
class SilentHost {
public:
    SilentHost() : door_(context_, zmq::socket_type::router) {
        door_.set(zmq::sockopt::linger, 0);
        door_.bind("tcp://127.0.0.1:*");
        endpoint_ = door_.get(zmq::sockopt::last_endpoint);
        thread_ = std::jthread([this](std::stop_token stop) { serve(stop); });
    }
    const std::string& endpoint() const { return endpoint_; }

private:
    void serve(const std::stop_token& stop) {
        while (!stop.stop_requested()) {
            zmq::pollitem_t item{door_.handle(), 0, ZMQ_POLLIN, 0};
            zmq::poll(&item, 1, std::chrono::milliseconds(20));
            std::vector<zmq::message_t> frames;
            zmq::message_t frame;
            while ((item.revents & ZMQ_POLLIN) && door_.recv(frame, zmq::recv_flags::dontwait)) {
                frames.push_back(std::move(frame));
                if (!frames.back().more()) break;
            }
            if (frames.size() == 3) answer(frames);
        }
    }
    void answer(std::vector<zmq::message_t>& frames) {
        const auto view = [](const zmq::message_t& m) {
            return std::span(static_cast<const std::byte*>(m.data()), m.size());
        };
        const auto asked = packet::read_header(view(frames[1]), view(frames[2]));
        const auto said = packet::unpack_fields(view(frames[2]));
        packet::Packet answer;
        if (asked && said && asked->type == Type::hello)
            answer =
                packet::pack(Type::welcome, 0,
                             Fields{}.set("places", 4).set("process", 7).set("fingerprint", fingerprint(usual_isa())));
        else if (asked && said && asked->type == Type::ping)
            answer = packet::pack(Type::pong, 0, Fields{}.set("process", 7).set("sent", said->number("sent")));
        else
            return;
        door_.send(frames[0], zmq::send_flags::sndmore);
        door_.send(zmq::const_buffer(answer.header.data(), answer.header.size()), zmq::send_flags::sndmore);
        door_.send(zmq::const_buffer(answer.body.data(), answer.body.size()));
    }

    zmq::context_t context_;
    zmq::socket_t door_;
    std::string endpoint_;
    std::jthread thread_;
};

bool running(Process& process) { return process.wait(std::chrono::milliseconds(1)) == -1; }

class SickHostTest : public ::testing::Test {
protected:
    // Runs on these hosts, in this order.
    Launch launch_on(const std::vector<std::string>& endpoints, std::vector<std::string> more = {}) {
        std::ofstream hosts(folder / "hosts.lua");
        for (const auto& endpoint : endpoints) hosts << "place \"" << endpoint << "\" {}\n";
        hosts.close();
        auto words = tiny;
        words.insert(words.end(), {"--hosts", (folder / "hosts.lua").string()});
        words.insert(words.end(), more.begin(), more.end());
        return launch(graph_file("cornell.lua"), folder, words);
    }
    std::string alone() {
        auto words = tiny;
        words.insert(words.end(), {"--threads", "1"});
        return launch(graph_file("cornell.lua"), other, words).picture;
    }
    // A cache in which the scene's file is a pipe that nobody writes to: who looks for it there waits for ever.
    static void let_hang(const Folder& folder) {
        { const Daemon made(folder); }  // it marks its folder
        const auto scene = content_hash(bytes_of(graph_file("cornell_box.pbrt")));
        EXPECT_EQ(mkfifo((folder / "cache" / to_hex(scene)).c_str(), 0600), 0);
    }
    Folder folder, other;
};

// ---- hosts that do not get ready ----

TEST_F(SickHostTest, ThatIsGreetedAndNeverReadyHoldsNobodyUp) {
    const Daemon healthy(folder);
    const SilentHost silent;
    const auto run = launch_on({silent.endpoint(), healthy.endpoint});
    ASSERT_EQ(run.code, 0) << run.said;
    EXPECT_TRUE(run.picture == alone());
    EXPECT_THAT(run.said, HasSubstr(silent.endpoint() + ": looks at the job"))
        << "and it is said whom the run goes without";
}

TEST_F(SickHostTest, ThatHangsInItsCacheHoldsNobodyUpAndStillObeys) {
    let_hang(folder);
    const Daemon hanging(folder);
    const Daemon healthy(other);
    const auto run = launch_on({hanging.endpoint, healthy.endpoint});
    ASSERT_EQ(run.code, 0) << run.said;
    EXPECT_TRUE(run.picture == alone());
    Stranger anyone(hanging.endpoint);
    anyone.send(packet::pack(Type::status, 0, {}));
    EXPECT_EQ(anyone.receive().first, Type::state) << "it waits in its cleanup, and still answers";
    hanging.process->signal(SIGTERM);
    EXPECT_EQ(hanging.process->wait(), 0) << hanging.process->output();
}

TEST_F(SickHostTest, ThatNeverAppearsIsNamedAtTheBeginningAndAtTheEnd) {
    const Daemon healthy(folder);
    const auto run = launch_on({"tcp://127.0.0.1:1", healthy.endpoint});
    ASSERT_EQ(run.code, 0) << run.said;
    const std::string warning = "tcp://127.0.0.1:1: does not answer; it was to hold the whole network";
    const auto first = run.said.find(warning), written = run.said.find("wrote ");
    EXPECT_LT(first, written) << run.said;
    EXPECT_NE(run.said.find("tcp://127.0.0.1:1 never came: it does not answer; it was to hold", written),
              std::string::npos)
        << run.said;
    EXPECT_THAT(run.report, HasSubstr(warning));
}

TEST_F(SickHostTest, NobodyWhoJoinsEndsTheRunAfterItsWait) {
    auto words = tiny;
    words.insert(words.end(), {"--listen", "tcp://127.0.0.1:*", "--wait", "6"});
    const auto begun = std::chrono::steady_clock::now();
    const auto run = launch(graph_file("cornell.lua"), folder, words);
    EXPECT_EQ(run.code, 3) << run.said;
    EXPECT_LT(std::chrono::steady_clock::now() - begun, slowdown * seconds(20));
    EXPECT_THAT(run.said, HasSubstr("waiting for"));
    EXPECT_THAT(run.said, HasSubstr("nobody has joined at tcp://127.0.0.1:"));
}

// ---- one host's trouble ----

TEST_F(SickHostTest, WithAFullDiskIsLeftOutWithItsReason) {
    const Folder small;
    const auto here = "'" + small.path().string() + "'";
    if (std::system(("mount -t tmpfs -o size=128k none " + here + " 2>/dev/null").c_str()) != 0)
        GTEST_SKIP() << "a small disk takes the right to mount one";
    {
        const Daemon sick(small);
        // Nothing is left for the scene's file.
        std::ofstream(small / "fills") << std::string(256 << 10, 'x');
        const Daemon healthy(other);
        const auto run = launch_on({sick.endpoint, healthy.endpoint});
        EXPECT_EQ(run.code, 0) << run.said;
        EXPECT_TRUE(run.picture == alone());
        EXPECT_THAT(run.said, HasSubstr(sick.endpoint + " takes no part: "));
        EXPECT_THAT(run.said, HasSubstr("can't be written"));
        const auto only = launch_on({sick.endpoint});
        EXPECT_EQ(only.code, 1) << "when nobody is left the run fails, and says why";
        EXPECT_THAT(only.said, HasSubstr("can't be written"));
    }
    EXPECT_EQ(std::system(("umount " + here).c_str()), 0);
}

TEST_F(SickHostTest, WithoutThreadsSaysSoAndEndsWhatItHadBegun) {
    if (geteuid() != 0) GTEST_SKIP() << "a limit of threads takes a user of its own";
    std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
    std::filesystem::create_directories(folder / "cache");
    std::filesystem::permissions(folder / "cache", std::filesystem::perms::all);
    const auto daemon_words = "cd /; ulimit -u 40; exec '" + program("lightnetd") +
                              "' --listen 'tcp://127.0.0.1:*' --cache '" + (folder / "unprivileged").string() + "'";
    Process sick({"/usr/bin/setpriv", "--reuid=65534", "--clear-groups", "/bin/bash", "-c", daemon_words});
    const std::string before = "listening on ";
    if (!sick.wait_for(before) || !sick.wait_for("\n"))
        GTEST_SKIP() << "a limit of threads takes a user of its own, who can reach the programs: " << sick.output();
    const auto at = sick.output().find(before) + before.size();
    const auto endpoint = sick.output().substr(at, sick.output().find('\n', at) - at);
    std::ofstream(folder / "many.lua") << "place \"" << endpoint << "\" { places = 200 }\n";
    auto words = tiny;
    words.insert(words.end(), {"--hosts", (folder / "many.lua").string()});
    const auto run = launch(graph_file("cornell.lua"), folder, words);
    EXPECT_EQ(run.code, 1) << run.said;
    EXPECT_THAT(run.said, HasSubstr("threads"));
    EXPECT_TRUE(running(sick)) << "it outlives that";
    sick.signal(SIGTERM);
    EXPECT_EQ(sick.wait(), 0) << sick.output();
}

TEST_F(SickHostTest, IsAskedForNoMorePlacesThanItWouldGive) {
    const Daemon daemon(folder);
    std::ofstream(folder / "many.lua") << "place \"" << daemon.endpoint << "\" { places = 900 }\n";
    auto words = tiny;
    words.insert(words.end(), {"--hosts", (folder / "many.lua").string()});
    const auto run = launch(graph_file("cornell.lua"), folder, words);
    EXPECT_EQ(run.code, 1) << run.said;
    EXPECT_THAT(run.said, HasSubstr("900 places of this host, which gives at most 256"));
}

// ---- descriptors ----

std::vector<std::string> with_descriptors(int count, const std::vector<std::string>& words) {
    std::vector<std::string> all{"/bin/bash", "-c", "ulimit -n " + std::to_string(count) + "; exec \"$@\"", "bash"};
    all.insert(all.end(), words.begin(), words.end());
    return all;
}

// Without the sanitizer, which looks at objects by way of a pipe, and takes none for a broken object.
#if !defined(__SANITIZE_ADDRESS__)
TEST_F(SickHostTest, OutOfDescriptorsIsARefusalAndNoAbort) {
    const Daemon one(folder), two(other);
    std::ofstream(folder / "hosts.lua") << "place \"" << one.endpoint << "\" {}\nplace \"" << two.endpoint << "\" {}\n";
    const auto out = folder / "few.exr";
    for (const int limit : {10, 16, 24, 32, 48}) {
        auto words = launch_words(graph_file("cornell.lua"), out, tiny);
        words.insert(words.end(), {"--threads", "2", "--hosts", (folder / "hosts.lua").string()});
        Process run(with_descriptors(limit, words));
        const int code = run.wait(slowdown * seconds(60));
        EXPECT_TRUE(code == 0 || code == 1 || code == 2 || code == 127) << limit << " descriptors: " << code << "\n"
                                                                        << run.output();
    }
    auto words = launch_words(graph_file("cornell.lua"), out, tiny);
    words.insert(words.end(), {"--threads", "2", "--hosts", (folder / "hosts.lua").string()});
    Process run(with_descriptors(256, words));
    ASSERT_EQ(run.wait(slowdown * seconds(60)), 0) << run.output();
    EXPECT_TRUE(bytes_of(out) == alone());
}
#endif

TEST_F(SickHostTest, WithFewDescriptorsOutlivesThoseWhoTakeThem) {
    Process daemon(with_descriptors(
        256, {program("lightnetd"), "--listen", "tcp://127.0.0.1:*", "--places", "2", "--cache", folder / "cache"}));
    ASSERT_TRUE(daemon.wait_for("\n")) << daemon.output();
    const std::string before = "listening on ";
    const auto at = daemon.output().find(before) + before.size();
    const auto endpoint = daemon.output().substr(at, daemon.output().find('\n', at) - at);
    {
        std::vector<std::unique_ptr<Stranger>> idle;
        for (int i = 0; i < 400; ++i) idle.push_back(std::make_unique<Stranger>(endpoint));
        std::this_thread::sleep_for(slowdown * std::chrono::milliseconds(500));
        EXPECT_TRUE(running(daemon)) << daemon.output();
    }
    const auto run = launch_on({endpoint});
    ASSERT_EQ(run.code, 0) << run.said << daemon.output();
    EXPECT_TRUE(run.picture == alone());
}

}  // namespace
}  // namespace lightnet::test
