// Those who have no part in a run, and would like to: other users of the machine, launchers of others, floods.
#include <grp.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <fstream>
#include <thread>

#include "core/base/build_info.hpp"
#include "tests/modes/keyed.hpp"
#include "tests/modes/stranger.hpp"

namespace lightnet::test {
namespace {

using packet::Fields;
using packet::Type;
using std::chrono::seconds;
using ::testing::HasSubstr;
using ::testing::Not;

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
    const auto worker = first_ready(*run);
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

// Becomes a user of this machine who has nothing to do with us, and tries all that he can. What he got at; "": nothing.
std::string as_nobody(const std::vector<std::pair<std::string, PublicKey>>& doors,
                      const std::vector<std::string>& files, const std::string& open_door,
                      const std::string& open_file) {
    constexpr int nobody = 65534;
    if (::setgroups(0, nullptr) || ::setgid(nobody) || ::setuid(nobody)) return "can't be nobody";
    // Where there is nothing to keep him out he gets in, or the rest would prove nothing.
    if (std::ifstream(open_file).get() == std::ifstream::traits_type::eof()) return "can't read " + open_file;
    Stranger guest(open_door, 5000);
    guest.send(packet::pack(Type::status, 0, {}));
    if (guest.receive().first != Type::state) return "an open door says nothing";
    for (const auto& file : files)
        if (std::ifstream(file).get() != std::ifstream::traits_type::eof()) return "can read " + file;
    for (const auto& [endpoint, key] : doors)
        for (const auto& keys : {std::optional<LineKeys>(), std::optional(LineKeys{KeyPair::random(), key})}) {
            Stranger stranger(endpoint, 300, keys);
            for (const auto& packet : all_packets()) stranger.send(packet);
            if (const auto type = stranger.receive().first; type != Type::ping)
                return endpoint + " answers packets: " + std::to_string(static_cast<int>(type));
        }
    return "";
}

TEST_F(Keys, KeepOtherUsersOfTheMachineOut) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can become somebody else";
    const auto daemon = keyed_daemon("daemon");
    const auto run = start(place(daemon->endpoint, "daemon"), {"--local-workers", "1", "--samples", endless});
    ASSERT_TRUE(run->wait_for("\"event\":\"progress\"")) << run->output();
    std::vector<std::pair<std::string, PublicKey>> doors{{daemon->endpoint, key_in("daemon").open}};
    // His own process can't know the keys of the run, but even who guesses that of the worker has none that it knows.
    for (std::size_t at = 0; (at = run->output().find(" is ready", at)) != std::string::npos; ++at) {
        const auto begin = run->output().rfind("tcp://", at);
        doors.emplace_back(run->output().substr(begin, at - begin), key_in("guess").open);
    }
    ASSERT_GE(doors.size(), 3u) << "the daemon, and what is ready\n" << run->output();
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
    std::vector<std::string> files{folder.file("user.key"), folder.file("daemon.key")};
    auto processes = processes_with("--parent " + std::to_string(run->id()));
    EXPECT_EQ(processes.size(), 1u);
    processes.insert(processes.end(), {run->id(), daemon->process->id()});
    for (const auto process : processes) {
        files.push_back("/proc/" + std::to_string(process) + "/environ");
        std::ifstream line("/proc/" + std::to_string(process) + "/cmdline", std::ios::binary);
        const std::string words((std::istreambuf_iterator<char>(line)), {});
        for (const auto* name : {"user", "daemon"}) EXPECT_THAT(words, Not(HasSubstr(key_in(name).secret_text())));
    }
    const Folder other;
    const Daemon plain(other);
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const auto child = ::fork();
    if (child == 0) {
        const auto got = as_nobody(doors, files, plain.endpoint, folder.file("launchers"));
        [[maybe_unused]] const auto written = ::write(ends[1], got.data(), got.size());
        ::_exit(got.empty() ? 0 : 1);
    }
    ::close(ends[1]);
    std::string got(500, '\0');
    got.resize(static_cast<std::size_t>(std::max<ssize_t>(::read(ends[0], got.data(), got.size()), 0)));
    ::close(ends[0]);
    int status = -1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    run->signal(SIGINT);
    EXPECT_EQ(run->wait(), 130) << run->output();
    EXPECT_THAT(run->output(), Not(HasSubstr("is lost")));
    if (got.starts_with("can't be")) GTEST_SKIP() << "only root can become somebody else, and this root " << got;
    EXPECT_EQ(status, 0) << got;
}

// Connections with wrong keys, and handshakes that stop in their middle, as long as a run takes.
TEST_F(Keys, HoldOutAgainstFloods) {
    const auto one = keyed_daemon("one"), two = keyed_daemon("two");
    const auto run = start(place(one->endpoint, "one", "image = 1, lighting = 1, ") +
                           place(two->endpoint, "two", "direct = 1, bounce = 1, "));
    const PublicKey key_of_one = key_in("one").open, key_of_two = key_in("two").open;
    std::atomic<int> floods{0};
    std::string greeting("\xff\0\0\0\0\0\0\0\1\x7f\3\1CURVE", 17);
    greeting.resize(64, '\0');
    const auto flood = [&](const std::stop_token& stop) {
        std::vector<int> halves;
        for (; !stop.stop_requested(); ++floods) {
            const bool first = floods % 2 == 0;
            const auto& endpoint = first ? one->endpoint : two->endpoint;
            const auto& key = first ? key_of_one : key_of_two;
            sockaddr_in address{};
            address.sin_family = AF_INET;
            address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(endpoint.substr(endpoint.rfind(':') + 1))));
            address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
            Stranger stranger(endpoint, 1, LineKeys{KeyPair::random(), key});
            stranger.send(packet::pack(Type::end, 0, {}));
            for (int i = 0; i < 5; ++i) {
                halves.push_back(::socket(AF_INET, SOCK_STREAM, 0));
                if (::connect(halves.back(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
                    (void)!::write(halves.back(), greeting.data(), greeting.size());
            }
            for (; halves.size() > 100; halves.erase(halves.begin())) ::close(halves.front());
        }
        for (const int half : halves) ::close(half);
    };
    std::jthread flooding(flood);  // one thread: libpgm can't make two contexts of ZeroMQ at once
    const auto end = expect_same(*run);
    EXPECT_GT(floods, 10);
    EXPECT_THAT(end.said, Not(HasSubstr("is lost")));
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

}  // namespace
}  // namespace lightnet::test
