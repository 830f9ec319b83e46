// Damaged and oversized packets, and connections that are none of ours.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <functional>
#include <random>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "core/base/build_info.hpp"
#include "core/network/graph/json.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/assembly/job.hpp"
#include "tests/faults/faults.hpp"
#include "tests/modes/stranger.hpp"
#include "tests/support/liar.hpp"
#include "transport/keys/key_file.hpp"

namespace lightnet::test {
namespace {

using packet::Fields;
using packet::Packet;
using packet::Type;

// A header that is right about a body that is not.
Packet with_body(Packet packet, std::span<const std::byte> body) {
    constexpr std::size_t checksum_at = packet::header_size - sizeof(std::uint64_t);
    packet.body.assign(body.begin(), body.end());
    const auto size = static_cast<std::uint32_t>(body.size());
    std::memcpy(packet.header.data() + checksum_at - sizeof size, &size, sizeof size);
    const std::uint64_t sum =
        XXH3_64bits_withSeed(body.data(), body.size(), XXH3_64bits(packet.header.data(), checksum_at));
    std::memcpy(packet.header.data() + checksum_at, &sum, sizeof sum);
    return packet;
}

Packet with_body(const Packet& packet, const std::string& body) {
    return with_body(packet, std::as_bytes(std::span(body)));
}

// A chain of so many nodes, each asking the one before.
Packet long_chain(int nodes) {
    std::string json =
        R"({"file":"x","nodes":[{"name":"scene","kind":"Scene","entries":["a.pbrt"],"params":{},"where":["x",1]},
        {"name":"n0","kind":"DirectLighting","entries":[],"params":{},"where":["x",1]})";
    for (int i = 1; i < nodes; ++i)
        json += fmt::format(
            R"(,{{"name":"n{}","kind":"Scale","entries":[{{"node":"n{}"}}],"params":{{}},"where":["x",1]}})", i, i - 1);
    json += fmt::format(R"(,{{"name":"image","kind":"RayTracer","entries":[{{"node":"n{}"}}],"params":{{
        "scene":{{"node":"scene"}},"film":{{"list":[16.0,16.0],"named":{{}}}}}},"where":["x",1]}}]}})",
                        nodes - 1);
    Job job;
    job.scene = "a.pbrt", job.isa = "sse4.2";
    job.width = job.height = 16;
    const auto text = to_json(job);
    const auto rest = text.substr(text.find("\"files\":"));  // all but its graph
    Plan plan;
    plan.places = {{"x", 0}};
    plan.places_of.resize(static_cast<std::size_t>(nodes) + 2);
    return packet::pack(
        Type::begin, 7,
        Fields{}.set("job", "{\"graph\":" + json + "," + rest).set("plan", to_json(plan)).set("you", "x"));
}

// Objects side by side: a parser that looks back at all of them takes the square of their number.
Packet many_siblings(int siblings) {
    std::string job = "[";
    for (int i = 0; i < siblings; ++i) job += "{\"\":0},";
    return packet::pack(Type::begin, 7, Fields{}.set("job", job + "0]").set("plan", to_json(Plan{})).set("you", "x"));
}

std::vector<std::pair<std::string, Packet>> bombs() {
    const auto begin = packet::pack(Type::begin, 7, Fields{}.set("job", "{}").set("plan", "{}").set("you", "x"));
    std::vector<std::pair<std::string, Packet>> all;
    for (const auto* claim : {"\xdd\xff\xff\xff\xff", "\xdf\xff\xff\xff\xff", "\xdb\xff\xff\xff\xff",
                              "\xc6\xff\xff\xff\xff", "\xc9\xff\xff\xff\xff\x01"})
        all.emplace_back("a claim of 4 G", with_body(begin, std::string(claim)));
    all.emplace_back("2 M levels", with_body(begin, std::string(2'000'000, '\x91')));
    all.emplace_back("a text of 60 MB", packet::pack(Type::begin, 7, Fields{}.set("job", std::string(60 << 20, '['))));
    all.emplace_back("100,000 siblings", many_siblings(100'000));
    all.emplace_back("a chain of 12,000 nodes", long_chain(12'000));
    all.emplace_back("a chain of 100,000 nodes", long_chain(100'000));
    return all;
}

// Every byte of good packets changed, some cut.
int damage(const std::string& daemon, int count, unsigned seed) {
    std::mt19937 random(seed);
    const std::vector<Packet> good{
        packet::pack(Type::hello, 0, Fields{}.set("build", build_id()).set("isa", "sse4.2")),
        packet::pack(Type::begin, 7, Fields{}.set("job", "{}").set("plan", to_json(Plan{})).set("you", "x")),
        packet::pack(Type::plan, 7, Fields{}.set("plan", to_json(Plan{}))), packet::pack(Type::status, 0, {}),
        packet::pack(Type::expect, 7, Fields{}.set("hash", std::string(64, 'a')).set("size", 5))};
    Stranger stranger(daemon, 100);
    for (int i = 0; i < count; ++i) {
        auto packet = good[random() % good.size()];
        auto& bytes = random() % 3 ? packet.body : packet.header;
        if (!bytes.empty()) bytes[random() % bytes.size()] ^= static_cast<std::byte>(1 + random() % 255);
        if (random() % 4 == 0 && !packet.body.empty()) packet.body.resize(random() % packet.body.size());
        stranger.send(random() % 2 && packet.header.size() == packet::header_size
                          ? with_body(packet, std::span<const std::byte>(packet.body))
                          : packet);
    }
    stranger.receive();
    return count;
}

// ZMTP without libzmq, which would not send what follows: the parts of one message, and no last one.
double endless_message(const Daemon& daemon, std::size_t megabytes) {
    const int file = connect_to(daemon.endpoint);
    ::fcntl(file, F_SETFL, 0);
    const timeval patience{2, 0};
    ::setsockopt(file, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    std::this_thread::sleep_for(milliseconds(100));
    const auto send = [&](const std::string& bytes) {
        return ::send(file, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
    };
    using namespace std::string_literals;
    send("\xff\0\0\0\0\0\0\0\0\x7f\x03\0NULL"s + std::string(16 + 1 + 31, '\0'));
    const auto ready =
        "\x05READY\x0bSocket-Type\0\0\0\x06"
        "DEALER\x08Identity\0\0\0\0"s;
    send("\x04"s + static_cast<char>(ready.size()) + ready);
    const std::string part = "\x03\0\0\0\0\x02\0\0\0"s + std::string(32 << 20, 'A');
    double most = 0;
    for (std::size_t sent = 0; sent < megabytes && send(part); sent += 32)
        most = std::max(most, memory_of(daemon.process->id()));
    ::close(file);
    return most;
}

// It answers who asks behind the bomb, on the same connection or, where that was closed, on another.
bool answers_after(const Daemon& daemon, const Packet& bomb) {
    const auto status = packet::pack(Type::status, 0, {});
    Stranger bombing(daemon.endpoint, 15'000);
    bombing.send(bomb);
    bombing.send(status);
    for (int i = 0; i < 3; ++i)
        if (bombing.receive().first == Type::state) return true;
    Stranger other(daemon.endpoint, 15'000);
    other.send(status);
    return other.receive().first == Type::state;
}

TEST_F(Faults, OfPacketsThatAreBombsAreDropped) {
    const Daemon daemon(folder);
    expect_same(*start(brief, {"--hosts", hosts_file({whole(daemon.endpoint)})}), brief);
    const double before = memory_of(daemon.process->id());
    const auto alive = [&] { return daemon.process->wait(milliseconds(1)) < 0; };
    const int damaged = damage(daemon.endpoint, 20'000, 10);
    double slowest = 0, most = memory_of(daemon.process->id());
    const auto all = bombs();
    for (const auto& [name, bomb] : all) {
        const auto begun = Clock::now();
        const auto said = answers_after(daemon, bomb);
        ASSERT_TRUE(alive()) << name << " ended the daemon\n" << daemon.process->output();
        EXPECT_TRUE(said) << "the daemon says nothing after " << name;
        const double took = seconds_since(begun);
        EXPECT_LT(took, slowdown * 5.0) << name;
        slowest = std::max(slowest, took);
        most = std::max(most, memory_of(daemon.process->id()));
    }
    const double endless = endless_message(daemon, 512);
    ASSERT_TRUE(alive()) << daemon.process->output();
    expect_same(*start(brief, {"--hosts", hosts_file({whole(daemon.endpoint)})}), brief);
    done(fmt::format("{} damaged packets, {} bombs, one message of 512 MB in parts", damaged, all.size()));
    // ZeroMQ keeps all parts of a message until the last has come, and has no limit for their number (docs/trust.md).
    seen(fmt::format(
        "at most {:.1f} s until the next was answered, {:.0f} MB more memory; {:.0f} MB while the parts came", slowest,
        most - before, endless - before));
    EXPECT_LT(most - before, 300);
    figure("memory", most - before, "MB", 64, false);
    figure("answered", slowest, "s", 2, false);

    const Liar garbler([](const packet::Header& header, std::span<const std::byte>) {
        return std::vector{with_body(packet::pack(Type::welcome, header.run, Fields{}), std::string(1000, '\x91')),
                           packet::pack(Type::welcome, header.run, Fields{}.set("places", ~0ull))};
    });
    expect_same(*start(brief, {"--hosts", hosts_file({whole(garbler.endpoint()), whole(daemon.endpoint)})}), brief);
}

// As many descriptors as we may have, but for some.
int affordable(int wanted) {
    rlimit limits{};
    ::getrlimit(RLIMIT_NOFILE, &limits);
    return static_cast<int>(std::min<rlim_t>(static_cast<rlim_t>(wanted), limits.rlim_cur / 2 - 100));
}

// What a client of ZeroMQ says first when it has a key; whoever says no more has stopped in the middle of a handshake.
std::string greeting() {
    std::string text("\xff\0\0\0\0\0\0\0\1\x7f\3\1CURVE", 17);
    text.resize(64, '\0');
    return text;
}

// During a run at this daemon.
struct Crowding {
    double seconds, megabytes, with, alone;
    int count;
};
Crowding crowding_of(const Daemon& daemon, const std::function<void()>& expect_same_picture) {
    const auto timed = [&] {
        const auto begun = Clock::now();
        expect_same_picture();
        return seconds_since(begun);
    };
    const double alone = timed();
    const auto files = descriptors_of(daemon.process->id());
    const double memory = memory_of(daemon.process->id());
    const int count = affordable(2000);
    std::vector<int> connections;
    std::jthread crowd([&](const std::stop_token& over) {
        std::mt19937 random(14);
        const std::vector<std::string> words{"",
                                             "GET / HTTP/1.1\r\nHost: x\r\n\r\n",
                                             std::string(100, '\x80'),
                                             std::string("\xff\0\0\0\0\0\0\0\0\x7f", 10),
                                             greeting(),
                                             greeting() + std::string("\4\xc8\5HELLO\1\0", 10)};
        for (int i = 0; i < count && !over.stop_requested(); ++i) {
            connections.push_back(connect_to(daemon.endpoint));
            std::this_thread::sleep_for(milliseconds(1));
            const auto& text = words[random() % words.size()];
            (void)::send(connections.back(), text.data(), text.size(), MSG_NOSIGNAL);
        }
        while (!over.stop_requested()) {  // some say a byte from time to time
            for (std::size_t i = 0; i < connections.size(); i += 7) (void)::send(connections[i], "\0", 1, MSG_NOSIGNAL);
            std::this_thread::sleep_for(milliseconds(200));
        }
    });
    const double with = timed();
    const auto begun = Clock::now();
    while (static_cast<int>(connections.size()) < count) std::this_thread::sleep_for(milliseconds(10));
    const auto all_there = Clock::now();
    while (descriptors_of(daemon.process->id()) > files + 10 && seconds_since(begun) < 60)
        std::this_thread::sleep_for(milliseconds(50));
    const double shed = seconds_since(all_there), more = memory_of(daemon.process->id()) - memory;
    crowd = {};
    for (const int connection : connections) ::close(connection);
    EXPECT_LT(shed, slowdown * 20.0);
    EXPECT_LT(more, 64);
    return {shed, more, with, alone, count};
}

TEST_F(Faults, OfStrayConnectionsAreShedInTime) {
    reference(usual);
    const Daemon plain(folder);
    const auto open = crowding_of(plain, [&] {
        expect_same(*start(usual, {"--hosts", hosts_file({whole(plain.endpoint)})}), usual);
    });
    const auto user = load_or_make_key(folder.file("user.key")), own = load_or_make_key(folder.file("own.key"));
    const Daemon locked(
        folder, 1, "tcp://127.0.0.1:*",
        {"--key", folder.file("own.key"), "--allow", folder.write("allow", user.open.text() + " me\n")});
    const auto hosts =
        folder.write("keyed.lua", "place '" + locked.endpoint + "' { key = '" + own.open.text() + "' }\n");
    const auto keyed = crowding_of(locked, [&] {
        expect_same(*start(usual, {"--hosts", hosts, "--key", folder.file("user.key")}), usual);
    });
    done(
        fmt::format("{} connections that are silent, HTTP, garbage, slow or stop in a handshake, during a run, and as "
                    "many during one with keys",
                    open.count));
    seen(fmt::format(
        "all shed {:.1f} s ({:.1f} s with keys) after the last came; {:.0f} MB ({:.0f} MB) more; {:.1f} s "
        "({:.1f} s) for the run, {:.1f} s ({:.1f} s) alone",
        open.seconds, keyed.seconds, open.megabytes, keyed.megabytes, open.with, keyed.with, open.alone, keyed.alone));
    figure("shed", std::max(open.seconds, keyed.seconds), "s", 4, false);
    figure("time", std::max(open.with / open.alone, keyed.with / keyed.alone), "of the time without them", 1.05, false);
}

}  // namespace
}  // namespace lightnet::test
