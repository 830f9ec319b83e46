// Operators in Lua: whatever they say, they end, and what they ask for is no more than a miss.
#include <array>
#include <cstring>
#include <limits>
#include <vector>

#include "core/base/error.hpp"
#include "core/scene/scene.hpp"
#include "lua/custom_call.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::fuzz {
namespace {

// The first bytes choose where on the room's walls the questions lie, and from where it is seen.
std::vector<Query> questions_of(std::span<const std::byte> bytes) {
    constexpr std::array extremes{0.0f,   -0.0f, 1.0f,   0.5f,
                                  1e-45f, 1e19f, -3e38f, std::numeric_limits<float>::infinity()};
    std::vector<Query> questions(5);
    for (std::size_t i = 0; i < bytes.size() && i < questions.size(); ++i) {
        const auto byte = std::to_integer<unsigned>(bytes[i]);
        questions[i].primitive = byte % 12;
        questions[i].u = questions[i].v = 0.25f;
        questions[i].outgoing = {0, extremes[byte / 12 % extremes.size()], 0.1f};
        questions[i].sample = static_cast<std::uint32_t>(i);
    }
    return questions;
}

void read(std::span<const std::byte> bytes) {
    static const Scene scene(test::furnace(0.5f, 1));
    constexpr std::size_t head = 5;
    lua::CustomProgram program{"odd", "odd.lua", "", &scene, {}, 7};
    const auto text = bytes.subspan(std::min(head, bytes.size()));
    program.source.assign(reinterpret_cast<const char*>(text.data()), text.size());
    if (!lua::CustomCall::mistake_in(program.source, program.file).empty()) return;
    const auto questions = questions_of(bytes.first(std::min(head, bytes.size())));
    std::vector<Rgb> answers(questions.size());
    try {
        lua::CustomCall(program, questions).answer(answers);
    } catch (const Error&) {
    }
}

std::vector<std::string> seeds() {
    const std::string head(5, '\1');
    return {head +
                "return function(q, ask) local open = 0 for i = 1, 4 do open = q:open(hemisphere(q.n, q:random(i, 4)), "
                "3) + open end return open / 4 end",
            head +
                "return function(q) local p = where(less(q.p.x, 0.5), q.n, q.out) return vec(dot(p, p), length(p), "
                "q:open(q.n * (0/0))) * q.albedo end",
            head +
                "return function(q) local s = 'xxxxxxxxxxxxxxxx' for i = 1, 9 do s = s .. s end for i = 1, 9999 do "
                "local t = s .. 'y' if s == t or s < t then t = #t end end return 1 end",
            head +
                "return function(q) local function f(...) return select('#', ...) end local t = {} for i = 1, 99 do "
                "t[i] = f(i, 1e38, t) end return max(q.p.x, 1e-45) / #t end"};
}

}  // namespace

Target customs() { return {"customs", read, seeds, 5}; }

}  // namespace lightnet::fuzz
