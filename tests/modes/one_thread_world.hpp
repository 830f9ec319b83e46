// Worlds in which a whole cluster runs in one thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/math/random.hpp"
#include "core/run/message/tuning.hpp"

namespace lightnet::test {

/// Chance from a seed.
class Chance {
public:
    explicit Chance(std::uint64_t seed) : seed_(seed) {}
    std::uint64_t number() { return child(seed_, ++drawn_); }
    /// 0 … 1, below 1.
    double part() { return static_cast<double>(number() >> 11) * 0x1p-53; }
    std::uint64_t below(std::uint64_t count) { return number() % count; }
    bool happens(double probability) { return part() < probability; }

private:
    std::uint64_t seed_, drawn_ = 0;
};

/// What happens at some event of a run, to a host.
struct Mishap {
    enum class Kind {
        kill,     // its process ends, and another one begins there some time later
        drain,    // it is told to stop
        cut_off,  // its line to the launcher is cut
        cut,      // its line to some other host
        freeze,   // its process stands still for some time
        move,     // nodes move
    };
    Kind kind = Kind::move;
    std::uint64_t event = 0;
    std::uint32_t host = 0;
    double seconds = 0;  // how long until it comes back, or goes on
};

inline std::string words_for(const Mishap& mishap) {
    static const char* const words[] = {"killed", "told to stop", "cut off", "cut from the next", "frozen", "moves"};
    return std::string(words[static_cast<int>(mishap.kind)]) + ", host " + std::to_string(mishap.host) + " for " +
           std::to_string(mishap.seconds) + " s";
}

/// All that is not the same from run to run.
struct OneThreadWorld {
    std::uint64_t seed = 1;
    struct Of {
        std::uint32_t places = 1;
        double slowness = 1, comes_after = 0;  // seconds
    };
    std::vector<Of> hosts{};
    double delay = 0.001;  // seconds, of a message, on average
    double loss = 0;       // part of all messages between hosts
    double unnoticed = 0;  // part of those between launcher and hosts, whose loss both ends find out later
    double twice = 0;      // part of what is asked between hosts
    double refused = 0;    // part of what is asked between hosts: the line is full just now
    double slow_news = 0;  // seconds at most, that the launcher's line to a host is busy before each plan
    double let_go_after = 5;
    bool by_hash = false;     // results go by their hash, however small they are
    bool by_holders = false;  // and come from hosts that have them ...
    double lies = 0;          // ... a part of whose pieces is not what it should be
    Tuning tuning{};
    std::vector<Mishap> mishaps{};
};

/// In some worlds all goes wrong while nodes prepare, who was killed is back before others have noticed, nodes are
/// let go of before all can have heard of it, and some hosts hear of plans later than others.
inline void hasten(OneThreadWorld& world) {
    Chance chance(child(world.seed, 18));
    const bool soon = chance.happens(0.3), at_once = chance.happens(0.4);
    if (chance.happens(0.3)) world.let_go_after = 0.3 * chance.part();
    if (chance.happens(0.4)) world.slow_news = 0.3 * chance.part();
    for (auto& mishap : world.mishaps) {
        if (soon) mishap.event = chance.below(1u << (4 + chance.below(5)));
        if (at_once && mishap.kind == Mishap::Kind::kill) mishap.seconds *= 0.02;
    }
}

/// The world of a seed. Processes die twice at most, as what was asked of three that died is set aside.
inline OneThreadWorld world_of(std::uint64_t seed) {
    Chance chance(child(seed, 17));
    OneThreadWorld world{.seed = seed};
    const auto hosts = 2 + chance.below(chance.happens(0.2) ? 7 : 3);
    for (std::uint64_t i = 0; i < hosts; ++i)
        world.hosts.push_back({static_cast<std::uint32_t>(1 + chance.below(3)),
                               chance.happens(0.2) ? 8.0 : 1 + chance.part(),
                               i > 0 && chance.happens(0.25) ? 2 * chance.part() : 0});
    world.delay = chance.happens(0.3) ? 0.005 : 0.0003;
    if (chance.happens(0.4)) world.loss = 0.01 * chance.part();
    if (chance.happens(0.2)) world.unnoticed = 0.002 * chance.part();
    if (chance.happens(0.5)) world.twice = 0.2 * chance.part();
    if (chance.happens(0.3)) world.refused = 0.1;
    world.let_go_after = chance.happens(0.5) ? 5 : 10;
    world.by_hash = chance.happens(0.5);
    Chance more(child(seed, 19));
    world.by_holders = world.by_hash && more.happens(0.7);
    if (more.happens(0.3)) world.lies = 0.3 * more.part();
    world.tuning.bundle = static_cast<std::uint32_t>(1u << (3 + chance.below(6)));
    world.tuning.credit = static_cast<std::uint32_t>(1 + chance.below(8));
    world.tuning.credit_questions = chance.happens(0.5) ? 64 : 8192;
    world.tuning.call_own_nodes = chance.happens(0.8);
    world.tuning.spare_fibers = chance.happens(0.3) ? 1 : 16;
    world.tuning.check_answers = true;
    const auto happens = chance.below(chance.happens(0.3) ? 20 : 7);
    int deaths = 2;
    for (std::uint64_t i = 0; i < happens; ++i) {
        Mishap mishap;
        mishap.kind = static_cast<Mishap::Kind>(chance.below(6));
        if (mishap.kind <= Mishap::Kind::drain && --deaths < 0) mishap.kind = Mishap::Kind::move;
        mishap.event = chance.below(1u << (4 + chance.below(10)));
        mishap.host = static_cast<std::uint32_t>(chance.below(hosts));
        mishap.seconds = (chance.happens(0.3) ? 3 : 0.3) * chance.part();
        world.mishaps.push_back(mishap);
    }
    hasten(world);
    return world;
}

}  // namespace lightnet::test
