// All that decides how fast a run is, and never what it computes.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>

namespace lightnet {

/// Bytes that a cache may keep, the launcher's or a daemon's, when nothing else is said.
inline constexpr std::uint64_t usual_cache_size = std::uint64_t{4} << 30;

/// A value. Each member has a line in `knobs`, which serves the command line, the job that hosts are sent, and the
/// report.
struct Tuning {
    std::uint32_t tile = 32;
    std::uint32_t bundle = 1024;
    std::uint32_t credit = 32;
    std::uint32_t checkpoint = 5;
    std::string cache;
    std::uint64_t cache_size = usual_cache_size;
    std::uint32_t spare_fibers = 16;
    std::uint32_t side_fibers = 2048;
    bool check_answers = false;
    std::uint32_t verify = 0;
    std::uint32_t oldest_us = 3000;
    std::uint32_t eager = 2;
    std::uint32_t credit_questions = 8192;
    std::uint64_t credit_bytes = std::uint64_t{8} << 20;
    std::uint32_t own_lines = 64;
    std::uint32_t share = 100;
    bool call_own_nodes = true;
    bool trace = false;
    friend bool operator==(const Tuning&, const Tuning&) = default;
};

/// What is to be known of one member of Tuning.
struct Knob {
    using Member =
        std::variant<std::uint32_t Tuning::*, std::uint64_t Tuning::*, std::string Tuning::*, bool Tuning::*>;
    /// Who turns it: users, or tests and benchmarks only.
    enum class By { users, tests };
    /// Who must know it: the launcher alone, or every place.
    enum class Where { launcher, places };

    const char* name;  // "side_fibers"; on the command line "--side-fibers"
    Member member;
    By by;
    Where where;
    std::uint64_t least, most;  // of a number
    const char* unit;           // as help shows it; "SIZE": bytes, like 500M. "": a switch
    const char* help;
};

inline constexpr std::array<Knob, 18> knobs{{
    {"tile", &Tuning::tile, Knob::By::users, Knob::Where::launcher, 1, 256, "N", "pixels along a side of a tile"},
    {"bundle", &Tuning::bundle, Knob::By::users, Knob::Where::places, 1, 65536, "N", "questions in a full bundle"},
    {"credit", &Tuning::credit, Knob::By::users, Knob::Where::places, 1, 1024, "N",
     "bundles under way to one place, per node asked"},
    {"checkpoint", &Tuning::checkpoint, Knob::By::users, Knob::Where::launcher, 1, 86400, "N",
     "seconds between two checkpoints"},
    {"cache", &Tuning::cache, Knob::By::users, Knob::Where::launcher, 0, 0, "FOLDER",
     "where what nodes prepare is kept from run to run; 'none': nowhere"},
    {"cache_size", &Tuning::cache_size, Knob::By::users, Knob::Where::launcher, 0, std::uint64_t{1} << 60, "SIZE",
     "bytes that the cache may keep, like 500M"},
    {"spare_fibers", &Tuning::spare_fibers, Knob::By::users, Knob::Where::places, 0, 4096, "N",
     "fibers of a place beside one per node"},
    {"side_fibers", &Tuning::side_fibers, Knob::By::users, Knob::Where::places, 0, 8192, "N",
     "fibers of a place for questions that wrapped code asks"},
    {"check_answers", &Tuning::check_answers, Knob::By::users, Knob::Where::places, 0, 0, "",
     "ask wrapped classes some questions twice, and compare all that is answered twice, bit by bit"},
    {"share", &Tuning::share, Knob::By::users, Knob::Where::places, 2, 100, "PERCENT",
     "of an equal part of a host's processors, while other runs want them, too"},
    {"verify", &Tuning::verify, Knob::By::tests, Knob::Where::places, 0, 1'000'000, "N",
     "millionths of all answers that are asked of a second host as well; users say --verify FRACTION"},
    {"oldest_us", &Tuning::oldest_us, Knob::By::tests, Knob::Where::places, 0, 3'600'000'000, "N",
     "microseconds after which a question leaves in a bundle that is not full"},
    {"eager", &Tuning::eager, Knob::By::tests, Knob::Where::places, 0, 1024, "N",
     "a place with nothing else to do sends bundles that are not full while fewer than these are under way"},
    {"credit_questions", &Tuning::credit_questions, Knob::By::tests, Knob::Where::places, 1, 1 << 26, "N",
     "questions under way to one place, per node asked"},
    {"credit_bytes", &Tuning::credit_bytes, Knob::By::tests, Knob::Where::places, 1, std::uint64_t{1} << 40, "SIZE",
     "bytes under way to one place, per node asked, with the room for answers"},
    {"own_lines", &Tuning::own_lines, Knob::By::tests, Knob::Where::places, 0, 1 << 20, "N",
     "lines that the places of a host may have to others by themselves, all together"},
    {"call_own_nodes", &Tuning::call_own_nodes, Knob::By::tests, Knob::Where::places, 0, 0, "",
     "call a node of the same place, rather than send it bundles"},
    {"trace", &Tuning::trace, Knob::By::tests, Knob::Where::places, 0, 0, "",
     "record what every place is busy with; --trace FILE turns it on"},
}};

/// How a knob is set: "512", "true", "/tmp/cache".
inline std::string text_of(const Tuning& tuning, const Knob& knob) {
    struct Text {
        std::string operator()(const std::string& text) const { return text; }
        std::string operator()(bool flag) const { return flag ? "true" : "false"; }
        std::string operator()(std::uint64_t number) const { return std::to_string(number); }
        std::string operator()(std::uint32_t number) const { return std::to_string(number); }
    };
    return std::visit([&](const auto& member) { return Text{}(tuning.*member); }, knob.member);
}

}  // namespace lightnet
