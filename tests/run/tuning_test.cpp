#include "core/run/message/tuning.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <string>
#include <utility>

#include "core/base/error.hpp"
#include "core/run/assembly/job.hpp"

namespace lightnet::tuning_test {
namespace {

struct Anything {
    template <class T>
    operator T() const;
};
template <std::size_t>
using AnythingAt = Anything;

template <std::size_t... index>
constexpr bool has_room_for(std::index_sequence<index...>) {
    return requires { Tuning{AnythingAt<index>{}...}; };
}
constexpr std::size_t lines = std::size(knobs);
static_assert(has_room_for(std::make_index_sequence<lines>()) && !has_room_for(std::make_index_sequence<lines + 1>()),
              "each member of Tuning has one line in `knobs`");

// Other than it usually is.
void turn(const Knob& knob, Tuning& tuning) {
    struct Turn {
        std::uint64_t most;
        void operator()(bool& flag) const { flag = !flag; }
        void operator()(std::string& text) const { text = "other"; }
        void operator()(std::uint32_t& number) const { number < most ? ++number : --number; }
        void operator()(std::uint64_t& number) const { number < most ? ++number : --number; }
    };
    std::visit([&](const auto& member) { Turn{knob.most}(tuning.*member); }, knob.member);
}

TEST(Tuning, HasAKnobOfItsOwnForEachMember) {
    std::set<std::string> names;
    Tuning all;
    for (const auto& knob : knobs) {
        EXPECT_TRUE(names.insert(knob.name).second) << knob.name;
        const auto before = all;
        turn(knob, all);
        EXPECT_NE(all, before) << knob.name;
        EXPECT_EQ(text_of(before, knob), text_of(Tuning{}, knob)) << knob.name << " has the member of another line";
    }
}

TEST(Tuning, TravelsAsFarAsPlacesMustKnowOfIt) {
    for (const auto& knob : knobs) {
        Job job;
        turn(knob, job.tuning);
        const bool came = job_from_json(to_json(job)).tuning == job.tuning;
        EXPECT_EQ(came, knob.where == Knob::Where::places) << knob.name;
    }
}

TEST(Tuning, OutOfItsRangeInAJobIsRefused) {
    for (const auto& knob : knobs) {
        auto* const number = std::get_if<std::uint32_t Tuning::*>(&knob.member);
        if (!number || knob.where != Knob::Where::places) continue;
        Job job;
        job.tuning.** number = static_cast<std::uint32_t>(knob.most);
        EXPECT_EQ(job_from_json(to_json(job)).tuning, job.tuning) << knob.name;
        job.tuning.** number = static_cast<std::uint32_t>(knob.most + 1);
        EXPECT_THROW(job_from_json(to_json(job)), Error) << knob.name;
    }
}

}  // namespace
}  // namespace lightnet::tuning_test
