// Packets in any order, from whoever gets to a daemon's door: after each conversation it serves the next launcher.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include "core/base/build_info.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "core/run/assembly/job.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/fuzz/put_right.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/modes/stranger.hpp"
#include "tests/support/host_thread.hpp"
#include "transport/wire/relay_address.hpp"

namespace lightnet::fuzz {
namespace {

using packet::Fields;
using packet::Type;
using View = std::span<const std::byte>;

// A packet of an input: type (0: nothing is said for a moment), number of the run (and 128, if it comes from another
// host, behind an address), and 16 bits of how long the body is that follows.
constexpr std::size_t head = 4, most_packets = 40;
constexpr std::byte of_another_host{128};
constexpr auto moment = std::chrono::milliseconds(4);

struct Daemon {
    const Registry kinds{standard_nodes()};
    const std::filesystem::path cache =
        std::filesystem::temp_directory_path() / ("lightnet-fuzz-daemon-" + std::to_string(getpid()));
    test::HostThread host{kinds, 1, cache.string()};
    ~Daemon() {
        std::error_code none_there;
        std::filesystem::remove_all(cache, none_there);
    }
};

packet::Packet packet_of(Type type, std::uint64_t run, View body) {
    auto made = packet::pack(type, run, Fields{});
    made.body.assign(body.begin(), body.end());
    made.header = put_right(made.header, made.body);
    return made;
}

// Waits for `wanted`, past whatever else is said.
bool hears(test::Stranger& stranger, Type wanted) {
    for (int i = 0; i < 1000; ++i) {
        const auto [type, fields] = stranger.receive();
        if (type == wanted) return true;
    }
    return false;
}

void say(test::Stranger& stranger, bool as_another_host, const packet::Packet& packet) {
    static const std::string address = seal({"another", "place"});
    if (as_another_host)
        stranger.send_behind(address, packet);
    else
        stranger.send(packet);
}

void read(View bytes) {
    static Daemon daemon;
    test::Stranger stranger(daemon.host.endpoint());
    std::size_t packets = 0;
    while (bytes.size() >= head && packets++ < most_packets) {
        const auto size = std::min<std::size_t>(
            std::to_integer<std::size_t>(bytes[2]) << 8 | std::to_integer<std::size_t>(bytes[3]), bytes.size() - head);
        if (bytes[0] == std::byte{0})
            std::this_thread::sleep_for(moment);
        else
            say(stranger, (bytes[1] & of_another_host) != std::byte{0},
                packet_of(static_cast<Type>(bytes[0]), std::to_integer<std::uint64_t>(bytes[1] & ~of_another_host),
                          bytes.subspan(head, size)));
        bytes = bytes.subspan(head + size);
    }
    for (int run = 0; run < 256; ++run) stranger.send(packet::pack(Type::end, std::uint64_t(run), {}));
    stranger.send(packet::pack(Type::status, 0, {}));
    if (!hears(stranger, Type::state)) throw std::logic_error("the daemon says nothing any more");
}

std::string said(Type type, char run, const packet::Packet& packet) {
    const auto& body = packet.body;
    std::string text{static_cast<char>(type), run, static_cast<char>(body.size() >> 8),
                     static_cast<char>(body.size() & 255)};
    return text.append(reinterpret_cast<const char*>(body.data()), body.size());
}

std::string say(Type type, char run, const Fields& fields) {
    return said(type, run, packet::pack(type, std::uint64_t{1}, fields));
}

std::vector<std::string> seeds() {
    const std::string scene = "WorldBegin\nLightSource \"infinite\"\nShape \"sphere\"\n";
    Job job;
    job.graph = {"box.lua",
                 {{"scene", "Scene", {Value{std::string("box.pbrt")}}, {}, {"box.lua", 1}},
                  {"direct", "DirectLighting", {}, {}, {"box.lua", 2}},
                  {"image",
                   "RayTracer",
                   {Value{NodeRef{"direct"}}},
                   {{"scene", Value{NodeRef{"scene"}}}, {"film", Value{Table{{Value{8.0}, Value{4.0}}, {}}}}},
                   {"box.lua", 3}}}};
    job.scene = "box.pbrt";
    const auto hash = content_hash(std::string_view(scene));
    job.files = {{"box.pbrt", hash, scene.size()}};
    job.isa = usual_isa(), job.width = 8, job.height = 4;
    const Plan plan{{{"me", 0}}, {{}, {0}, {0}}};
    const auto begin = Fields{}
                           .set("job", to_json(job))
                           .set("plan", to_json(plan))
                           .set("you", "me")
                           .set("who", "somebody")
                           .set("members", "")
                           .set("numbers", "me 127.0.0.1\n");
    const auto hello = Fields{}.set("build", build_id()).set("isa", usual_isa()).set("version", 1);
    const auto blob = packet::pack(std::uint64_t{7}, packet::Piece{hash, 0, std::as_bytes(std::span(scene))});
    const auto expect = Fields{}.set("hash", to_hex(hash)).set("size", 40);
    const auto fetch = Fields{}.set("hash", to_hex(hash)).set("offset", 3).set("size", 10);
    constexpr char another = 7 | char(-128);
    const auto ping = Fields{}.set("sent", 1).set("watch", 1).set("asked_at", 5);
    const std::string pause(head, '\0'), opening = say(Type::hello, 0, hello) + say(Type::begin, 7, begin);
    const std::string served = opening + pause + pause + said(Type::blob, 7, blob) + pause + pause + pause;
    return {served + say(Type::ping, 7, ping) + say(Type::plan, 7, Fields{}.set("plan", to_json(plan))) + pause,
            served + say(Type::ask_light, 7, {}) + say(Type::ask_step, 7, {}) + say(Type::leaving, 7, {}) + pause,
            opening + say(Type::ping, 7, ping) + said(Type::blob, 7, blob) +
                say(Type::plan, 7, Fields{}.set("plan", to_json(plan))),
            opening + say(Type::expect, 7, expect) +
                say(Type::members, 7, Fields{}.set("members", "").set("numbers", "")) + say(Type::leaving, 7, {}) +
                say(Type::end, 7, {}) + opening,
            served + say(Type::fetch, another, fetch) + say(Type::fetch, another, {}) + pause +
                say(Type::fetch, another, Fields{fetch}.set("offset", std::uint64_t{1} << 40)) +
                say(Type::ask_light, another, {}) + say(Type::lacks, another, fetch) + pause,
            say(Type::join, 0, Fields{}.set("name", "x").set("process", 1)) + say(Type::state, 0, {}) +
                say(Type::ask_pixels, 7, {}) + say(Type::part, 7, {}) + say(Type::mark, 7, {}) + opening};
}

}  // namespace

Target conversations() { return {"conversations", read, seeds, 8}; }

}  // namespace lightnet::fuzz
