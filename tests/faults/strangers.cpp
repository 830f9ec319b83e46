// Peers that are of another version, have no key, or give orders that are not theirs to give.
#include <fmt/format.h>

#include <array>
#include <csignal>
#include <optional>
#include <random>

#include "core/base/build_info.hpp"
#include "core/base/hash.hpp"
#include "core/network/graph/plan.hpp"
#include "tests/faults/faults.hpp"
#include "tests/modes/stranger.hpp"
#include "tests/support/liar.hpp"
#include "transport/keys/key_file.hpp"
#include "transport/zmq/doorkeeper.hpp"
#include "transport/zmq/socket.hpp"

namespace lightnet::test {
namespace {

using packet::Fields;
using packet::Packet;
using packet::Type;

Packet of_version(Packet packet, unsigned version) {
    packet.header[4] = static_cast<std::byte>(version & 255);
    packet.header[5] = static_cast<std::byte>(version >> 8);
    return packet;
}

TEST_F(Faults, OfVersionsAreRefusedByName) {
    const Daemon daemon(folder);
    const auto hello = packet::pack(Type::hello, 0, Fields{}.set("build", build_id()).set("isa", "sse4.2"));
    double slowest = 0;
    int refused = 0;
    for (unsigned version = 0; version < 256; ++version) {
        if (version == packet::version) continue;
        Stranger stranger(daemon.endpoint);
        const auto begun = Clock::now();
        stranger.send(of_version(hello, version));
        const auto [type, fields] = stranger.receive();
        slowest = std::max(slowest, seconds_since(begun));
        const auto text = fields.text("text");
        const bool named = type == Type::refuse && text.find(std::to_string(version)) != std::string::npos &&
                           text.find(std::to_string(packet::version)) != std::string::npos;
        EXPECT_TRUE(named) << "version " << version << ": " << text;
        refused += named;
    }
    int launchers = 0;
    for (const unsigned version : {0u, packet::version + 1u, 255u, 65535u}) {
        const Liar old([&](const packet::Header& header, std::span<const std::byte>) {
            return std::vector{of_version(packet::pack(Type::welcome, header.run, Fields{}.set("places", 1)), version)};
        });
        const auto run = start(brief, {"--hosts", hosts_file({whole(old.endpoint())})});
        EXPECT_EQ(run->wait(slowdown * seconds(30)), 3) << run->output();
        const auto text =
            "speaks protocol version " + std::to_string(version) + ", we speak " + std::to_string(packet::version);
        EXPECT_NE(run->output().find(text), std::string::npos) << run->output();
        ++launchers;
    }
    done(fmt::format("255 other versions at a daemon, {} at a launcher", launchers));
    seen(fmt::format("{} refused with both versions named, after {:.0f} ms at most", refused, 1000 * slowest));
    figure("refused", slowest, "s", 0.1, false);
}

// Each packet that there is.
std::vector<Packet> all_packets() {
    std::vector<Packet> all;
    for (std::uint8_t type = 1; type <= static_cast<std::uint8_t>(Type::last); ++type)
        all.push_back(packet::pack(static_cast<Type>(type), 0, Fields{}.set("build", build_id()).set("isa", "sse4.2")));
    return all;
}

// Knocks with wrong keys of each kind, over and over, while a run goes on.
TEST_F(Faults, OfKeysLetNobodyIn) {
    const auto user = load_or_make_key(folder.file("user.key")), door = load_or_make_key(folder.file("door.key"));
    const OddDaemon daemon(daemon_words(folder.file("cache"), {"--key", folder.file("door.key"), "--allow",
                                                               folder.write("allow", user.open.text() + " user\n")}));
    const auto hosts =
        folder.write("keyed.lua", "place '" + daemon.endpoint + "' { key = '" + door.open.text() + "' }\n");
    const Words keyed{"--hosts", hosts, "--key", folder.file("user.key")};
    reference(usual);
    const auto files = descriptors_of(daemon.process->id());
    const auto run = start(usual, keyed);
    EXPECT_TRUE(run->wait_for("\"event\":\"progress\"")) << run->output();
    const int tries = 300;
    int answered = 0;
    const auto packets = all_packets();
    for (int i = 0; i < tries; ++i) {
        const std::array<std::optional<LineKeys>, 3> wrong{LineKeys{KeyPair::random(), door.open},
                                                           LineKeys{user, KeyPair::random().open}, std::nullopt};
        Stranger stranger(daemon.endpoint, 10, wrong[static_cast<std::size_t>(i) % wrong.size()]);
        for (const auto& packet : packets) stranger.send(packet);
        answered += stranger.receive().first != Type::ping;
    }
    expect_same(*run, usual);
    EXPECT_EQ(answered, 0);
    int told = 0;
    double slowest = 0;
    for (const auto* kind : {"unknown", "wrong", "none"}) {
        const bool unknown = std::string(kind) == "unknown";
        load_or_make_key(folder.file("other.key"));
        const auto theirs = std::string(kind) == "wrong" ? user.open.text() : door.open.text();
        const auto place = "place '" + daemon.endpoint + "' { " +
                           (std::string(kind) == "none" ? "" : "key = '" + theirs + "'") + " }\n";
        const auto begun = Clock::now();
        const auto refused = start(brief, {"--hosts", folder.write("wrong.lua", place), "--key",
                                           folder.file(unknown ? "other.key" : "user.key")});
        told += refused->wait(slowdown * seconds(10)) == 4;
        slowest = std::max(slowest, seconds_since(begun));
    }
    EXPECT_EQ(told, 3);
    const auto end = Clock::now() + slowdown * seconds(10);
    while (descriptors_of(daemon.process->id()) > files + 10 && Clock::now() < end)
        std::this_thread::sleep_for(milliseconds(50));
    EXPECT_LE(descriptors_of(daemon.process->id()), files + 10);
    expect_same(*start(brief, keyed), brief);
    done(fmt::format("{} connections with wrong keys, unknown keys and none, each packet on each", tries));
    seen(fmt::format("{} were answered; launchers end with code 4 and a reason after {:.1f} s at most", answered,
                     slowest));
    figure("told", slowest, "s", 2, false);
}

TEST_F(Faults, OfTheGatekeeperLetNobodyIn) {
    const auto own = KeyPair::random(), known = KeyPair::random();
    const SocketContext context;
    std::optional<Doorkeeper> keeper(std::in_place, context,
                                     Doorkeeper::Keys{own, [&](const PublicKey& key) { return key == known.open; }});
    auto door = door_socket(context);
    keeper->guard(door);
    door.bind("tcp://127.0.0.1:*");
    const auto comes_in = [&](const std::optional<LineKeys>& keys) {
        Stranger caller(door.endpoint(), 10, keys);
        caller.send(packet::pack(Type::hello, 0, {}));
        for (const auto end = Clock::now() + milliseconds(keeper ? 2000 : 100); Clock::now() < end;) {
            if (keeper) keeper->tick();
            if (door.receive()) return true;
            std::this_thread::sleep_for(milliseconds(1));
        }
        return false;
    };
    EXPECT_TRUE(comes_in(LineKeys{known, own.open})) << "or the test shows nothing";
    keeper.reset();
    int in = 0;
    const int tries = 60;
    for (int i = 0; i < tries; ++i) {
        const std::array<std::optional<LineKeys>, 3> keys{LineKeys{known, own.open},
                                                          LineKeys{KeyPair::random(), own.open}, std::nullopt};
        in += comes_in(keys[static_cast<std::size_t>(i) % keys.size()]);
    }
    EXPECT_EQ(in, 0);
    done(fmt::format("the handler of keys is ended, then {} callers, a third of them with a known key", tries));
    seen(fmt::format("{} got in", in));
}

// The number of the run that a stranger finds out by asking nicely; 0: nobody tells.
std::uint64_t learn_run(const std::string& daemon, const std::string& launcher) {
    std::uint64_t found = 0;
    for (const auto& [endpoint, packet] :
         {std::pair{daemon, packet::pack(Type::ping, 0, Fields{}.set("sent", 0))},
          std::pair{daemon, packet::pack(Type::status, 0, {})}, std::pair{launcher, packet::pack(Type::status, 0, {})},
          std::pair{launcher,
                    packet::pack(Type::join, 0, Fields{}.set("name", "x").set("endpoint", "tcp://127.0.0.1:1"))}}) {
        Stranger stranger(endpoint, 500);
        stranger.send(packet);
        const auto [type, fields] = stranger.receive();
        if (const auto run = std::max(fields.number("run"), stranger.run())) found = run;
    }
    return found;
}

// All light comes from the liar, by this plan.
std::string false_plan(const std::string& daemon, const std::string& liar) {
    Plan plan;
    plan.places = {{daemon, 0}, {liar, 0}};
    plan.places_of = {{}, {1}, {1}, {1}, {0}};  // scene, direct, bounce, lighting, image
    return to_json(plan);
}

// So that what was sent has arrived.
int send_all(Stranger& stranger, const std::vector<Packet>& packets) {
    for (const auto& packet : packets) stranger.send(packet);
    stranger.receive();
    return static_cast<int>(packets.size());
}

int order_false_plan(const std::string& daemon, const std::string& liar, std::uint64_t run) {
    Stranger stranger(daemon, 200);
    return send_all(stranger, {packet::pack(Type::plan, run, Fields{}.set("plan", false_plan(daemon, liar)))});
}

// All else that a launcher may say to its daemon, said by somebody else.
int order(const std::string& daemon, const std::string& liar, std::uint64_t run) {
    Stranger stranger(daemon, 200);
    const std::string junk(10'000, 'x');
    const auto scene = content_hash(bytes_of(graph_file("cornell_box.pbrt")));
    const auto plan = false_plan(daemon, liar);
    return send_all(
        stranger, {packet::pack(Type::expect, run, Fields{}.set("hash", to_hex(scene)).set("size", 1 << 20)),
                   packet::pack(run, {scene, 0, std::as_bytes(std::span(junk))}),
                   packet::pack(Type::ping, run, Fields{}.set("sent", 1'000'000)), packet::pack(Type::leaving, run, {}),
                   packet::pack(Type::ready, run, {}), packet::pack(Type::ended, run, {}),
                   packet::pack(Type::begin, run, Fields{}.set("job", "{}").set("plan", plan).set("you", daemon)),
                   packet::pack(Type::end, run, {})});
}

// All that a host may say to its launcher, said by somebody else.
int report(const std::string& launcher, std::uint64_t run) {
    Stranger stranger(launcher, 200);
    const auto join = [](const std::string& endpoint, std::uint64_t process) {
        return packet::pack(Type::join, 0, Fields{}.set("name", "y").set("process", process).set("endpoint", endpoint));
    };
    std::vector<Packet> reports;
    for (const std::string place : {"reports", "place-0", "place-1"})
        reports.push_back(join("inproc://run-" + std::to_string(run) + "/" + place, 0));
    reports.push_back(join("ipc:///tmp/lightnet-none.sock", 0));
    for (int port = 1; port < 20; ++port) reports.push_back(join("tcp://127.0.0.1:" + std::to_string(port), 0));
    for (const auto type : {Type::ready, Type::broken, Type::leaving, Type::ended, Type::refuse, Type::failure})
        reports.push_back(packet::pack(type, run, Fields{}.set("text", "lies")));
    return send_all(stranger, reports);
}

TEST_F(Faults, OfStrangersOrdersAreObeyedByNobody) {
    const Liar liar([](const packet::Header& header, std::span<const std::byte>) { return Liar::green_light(header); });
    reference(usual);
    int said = 0, learnt = 0;
    constexpr int runs = 3;
    for (int i = 0; i < runs; ++i) {
        const Daemon one(folder), two(folder);
        const auto run = start(usual, {"--listen", "tcp://127.0.0.1:*", "--hosts",
                                       hosts_file({whole(one.endpoint), whole(two.endpoint)})});
        const auto launcher = join_endpoint(*run);
        EXPECT_TRUE(run->wait_for("\"event\":\"progress\"")) << run->output();
        const auto found = learn_run(one.endpoint, launcher);
        learnt += found != 0;
        for (const auto id : {found, std::uint64_t{0}})
            said += order_false_plan(one.endpoint, liar.endpoint(), id) +
                    order_false_plan(two.endpoint, liar.endpoint(), id);
        pause(*run, milliseconds(300));
        for (int again = 0; again < 3 && pause(*run, milliseconds(50)); ++again) {
            for (const auto id : {found, std::uint64_t{0}, std::uint64_t{1}})
                said += order(one.endpoint, liar.endpoint(), id);
            said += report(launcher, found);
        }
        expect_same(*run, usual);
        EXPECT_LT(one.process->wait(milliseconds(10)), 0) << one.process->output();
        expect_same(*start(brief, {"--hosts", hosts_file({whole(one.endpoint)})}), brief);
    }
    done(fmt::format("{} orders and reports of strangers in {} runs", said, runs));
    seen(fmt::format("{} times a stranger learnt the number of the run; the liar was asked {} times", learnt,
                     liar.asked()));
    EXPECT_EQ(learnt, 0);
    EXPECT_EQ(liar.asked(), 0u);
}

}  // namespace
}  // namespace lightnet::test
