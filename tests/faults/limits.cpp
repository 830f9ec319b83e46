// Processes that run out of descriptors, memory or threads.
#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <memory>
#include <zmq.hpp>

#include "tests/faults/faults.hpp"
#include "tests/faults/memory_group.hpp"

namespace lightnet::test {
namespace {

/// Many that connect and say nothing ever after. Half of them are greeted, as far as there is room; the others do not
/// even greet, so that nobody can tell yet whether to turn them away.
class Idlers {
public:
    Idlers(const std::string& endpoint, int count) {
        for (int i = 0; i < count / 2; ++i) {
            sockets_.emplace_back(context_, zmq::socket_type::dealer);
            sockets_.back().set(zmq::sockopt::linger, 0);
            sockets_.back().set(zmq::sockopt::reconnect_ivl, -1);
            sockets_.back().connect(endpoint);
            mute_.push_back(connect_to(endpoint));
        }
    }
    ~Idlers() {
        for (const int file : mute_) ::close(file);
    }
    Idlers(const Idlers&) = delete;
    Idlers& operator=(const Idlers&) = delete;

private:
    zmq::context_t context_;
    std::vector<zmq::socket_t> sockets_;
    std::vector<int> mute_;
};

bool waits_for(const std::function<bool()>& what, seconds most) {
    for (const auto end = Clock::now() + slowdown * most; Clock::now() < end;) {
        if (what()) return true;
        std::this_thread::sleep_for(milliseconds(20));
    }
    return what();
}

TEST_F(Faults, OfDescriptorsEndNoProcess) {
    const Daemon healthy(folder);
    reference(usual);
    const OddDaemon few(under("ulimit -n 256", daemon_words(folder / "cache")));
    ASSERT_FALSE(few.endpoint.empty()) << few.process->output();
    const auto before = descriptors_of(few.process->id());
    {
        const Idlers idlers(few.endpoint, 600);
        EXPECT_TRUE(waits_for([&] { return descriptors_of(few.process->id()) > 200; }, seconds(10)))
            << "the daemon should have run out of descriptors";
        const auto run = start(usual, {"--hosts", hosts_file({whole(few.endpoint), whole(healthy.endpoint)})});
        expect_same(*run, usual);
        EXPECT_LT(few.process->wait(milliseconds(10)), 0) << "it ended\n" << few.process->output();
    }
    const auto freed = Clock::now();
    EXPECT_TRUE(waits_for([&] { return descriptors_of(few.process->id()) <= before + 20; }, seconds(5)));
    figure("given_back", seconds_since(freed), "s", 1, false);
    expect_same(*start(brief, {"--hosts", hosts_file({whole(few.endpoint)})}), brief);

    // Every number of descriptors: it works, or it is refused.
    int served = 0, refused = 0;
    for (int most = 8; most <= 48 && !HasFailure(); most += 2) {
        const auto words = launch_words(
            graph_file("cornell.lua"), out,
            join(brief, {"--threads", "2", "--hosts", hosts_file({whole(healthy.endpoint)}), "--wait", "1"}));
        Process run(under("ulimit -n " + std::to_string(most), words));
        const int code = run.wait(slowdown * seconds(30));
        EXPECT_TRUE(code >= 0 && code < 126) << "with " << most << ": ended by code " << code << "\n" << run.output();
        EXPECT_TRUE(code != 0 || bytes_of(out) == reference(brief));
        EXPECT_FALSE(run.output().empty()) << "it should say why";
        (code == 0 ? served : refused) += 1;
    }
    for (int most = 8; most <= 56 && !HasFailure(); most += 6) {
        const OddDaemon poor(under("ulimit -n " + std::to_string(most), daemon_words(folder / "cache")));
        if (!poor.endpoint.empty())
            expect_same(*start(brief, {"--hosts", hosts_file({whole(poor.endpoint), whole(healthy.endpoint)})}), brief);
        const int code = poor.process->wait(poor.endpoint.empty() ? milliseconds(5000) : milliseconds(50));
        EXPECT_LT(code, 126) << "with " << most << " the daemon was aborted\n" << poor.process->output();
        (code < 0 ? served : refused) += 1;
    }
    done("600 idle peers on a daemon with 256 descriptors; 8 to 56 descriptors for launcher and daemon");
    seen(fmt::format("{} served, {} refused with a message", served, refused));
}

TEST_F(Faults, OfMemoryTakeOutOneHostOnly) {
    const Daemon healthy(folder);
    reference(usual);
    int runs = 0, pictures = 0;
    std::string what;
    for (const int kilobytes : {200'000, 500'000}) {
        const OddDaemon poor(under("ulimit -v " + std::to_string(kilobytes), daemon_words(folder / "cache")));
        const auto host = poor.endpoint.empty() ? "tcp://127.0.0.1:1" : poor.endpoint;
        const auto run = start(usual, {"--hosts", hosts_file({whole(host), whole(healthy.endpoint)})});
        pictures += !expect_same(*run, usual).empty();
        ++runs;
    }
    const MemoryGroup group;
    if (group.there()) {
        const OddDaemon poor(under(group.entry(), daemon_words(folder / "cache")));
        ASSERT_FALSE(poor.endpoint.empty()) << poor.process->output();
        EXPECT_TRUE(group.limit(group.usage() + 1e6));
        const auto run = start(usual, {"--hosts", hosts_file({whole(poor.endpoint), whole(healthy.endpoint)})});
        pictures += !expect_same(*run, usual).empty();
        what =
            poor.process->wait(milliseconds(100)) == 128 + SIGKILL ? "; the system killed one" : "; one got on with it";
        ++runs;
    } else {
        what = "; no group with limited memory can be made here";
    }
    done(fmt::format("{} runs on a good host and one that may have 200 MB, 500 MB, 1 MB more than it has", runs));
    seen(fmt::format("{} runs ended with a picture{}", pictures, what));
}

// A user of its own, who has no other processes.
constexpr int lone_user = 61234;

TEST_F(Faults, OfThreadsTakeOutOneHostOnly) {
    if (geteuid() != 0) NOT_RUN("becoming another user takes root");
    const auto cache = folder / "lone";
    std::filesystem::create_directories(cache);
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
    ASSERT_EQ(::chown(cache.c_str(), lone_user, lone_user), 0);
    const Words become{"/usr/bin/setpriv", "--reuid=" + std::to_string(lone_user),
                       "--regid=" + std::to_string(lone_user), "--clear-groups"};
    const auto as_lone = [&](const Words& words) { return join(become, words); };
    if (Process(as_lone({program("lightnetd"), "--version"})).wait() != 0)
        NOT_RUN("another user can't reach the programs");
    const Daemon healthy(folder);
    reference(usual);
    int runs = 0, pictures = 0;
    for (const int most : {4, 40, 200}) {
        const OddDaemon few(as_lone(under("ulimit -u " + std::to_string(most), daemon_words(cache, {"--drain", "2"}))));
        const auto host = few.endpoint.empty() ? "tcp://127.0.0.1:1" : few.endpoint;
        const auto run =
            start(usual, {"--hosts", hosts_file({"'" + host + "' { places = 300 }", whole(healthy.endpoint)})});
        EXPECT_GE(run->wait(slowdown * seconds(45)), 0) << "it waits for ever\n" << run->output();
        pictures += !expect_same(*run, usual).empty();
        if (!few.endpoint.empty()) {
            few.process->signal(SIGTERM);
            EXPECT_EQ(few.process->wait(slowdown * seconds(8)), 0) << "with " << most << "\n" << few.process->output();
        } else {  // too few to begin at all, which it says
            EXPECT_EQ(few.process->wait(slowdown * seconds(8)), 1) << "with " << most << "\n" << few.process->output();
        }
        ++runs;
    }
    done(fmt::format("{} runs on a good host and one of 300 places that may have 4, 40, 200 threads", runs));
    seen(fmt::format("{} runs ended with a picture", pictures));
}

}  // namespace
}  // namespace lightnet::test
