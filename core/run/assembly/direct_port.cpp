#include "core/run/assembly/direct_port.hpp"

#include <xmmintrin.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/odd_numbers.hpp"
#include "core/base/unwanted.hpp"
#include "core/base/words_of.hpp"
#include "core/network/light/describe_question.hpp"

namespace lightnet {
namespace {

constexpr std::size_t chunk = 256;
constexpr unsigned usual_float_mode = 0x1f80;

// Flush-to-zero, denormals-are-zero and rounding must be those that every place starts with.
void check_float_mode() {
    constexpr unsigned modes = 0xffc0;
    if ((_mm_getcsr() & modes) != usual_float_mode) {
        _mm_setcsr(usual_float_mode);
        throw Error("the node changed the floating-point mode of its thread");
    }
}

// Nodes need not be ready for what follows from numbers that are none.
bool is_sound(const Query& question) {
    return finite(question.outgoing) && std::isfinite(question.u) && std::isfinite(question.v) &&
           (!question.is_in_space() || finite(question.place_in_space()));
}

// Has the node an answer? Most know surfaces only: what they would say of a point in a medium is black.
bool is_for(const Callee& node, const Query& question) {
    return is_sound(question) && (node.space || !question.is_in_space());
}

// Which question a node threw at: each is asked alone until it throws again. Empty: none is to blame.
std::string culprit(const Callee& node, std::span<const Query> questions) {
    std::vector<Rgb> answer(node.layers);
    std::string found;
    for (const auto& question : questions) {
        end_if_unwanted();
        if (!is_for(node, question)) continue;
        try {
            node.light.light({&question, 1}, answer);
        } catch (const std::exception&) {
            found = " at " + describe(question);
            break;
        }
    }
    _mm_setcsr(usual_float_mode);
    return found;
}

void answer_all(const Callee& node, std::size_t width, std::span<const Query> questions, std::span<Rgb> answers) {
    if (width == node.layers) {
        std::fill(answers.begin(), answers.end(), Rgb{});
        node.light.light(questions, answers);
        return;
    }
    std::vector<Rgb> apart(questions.size() * node.layers);
    node.light.light(questions, apart);
    for (std::size_t q = 0; q < questions.size(); ++q) {
        // one for all, or for each group of lamps: those of each light that is kept apart follow one another
        for (std::size_t k = 0; k < node.layers; ++k) {
            const Rgb& one = apart[q * node.layers + k];
            Rgb& sum = answers[q * width + k % width];
            sum = k < width ? one : sum + one;
        }
    }
}

void answer_some(const Callee& node, std::size_t width, std::span<const Query> questions, std::span<Rgb> answers) {
    std::vector<std::size_t> which;
    std::vector<Query> sound;
    for (std::size_t q = 0; q < questions.size(); ++q) {
        if (node.unsound) *node.unsound += !is_sound(questions[q]);
        if (is_for(node, questions[q])) which.push_back(q), sound.push_back(questions[q]);
    }
    std::fill(answers.begin(), answers.end(), Rgb{});
    if (sound.empty()) return;
    std::vector<Rgb> some(sound.size() * width);
    answer_all(node, width, sound, some);
    for (std::size_t i = 0; i < which.size(); ++i)
        std::copy_n(some.begin() + std::ptrdiff_t(i * width), width,
                    answers.begin() + std::ptrdiff_t(which[i] * width));
}

}  // namespace

DirectPort::DirectPort(Callee node, std::size_t width, std::uint64_t& count, std::function<void()> pause)
    : node_(node), width_(width), count_(count), pause_(std::move(pause)) {}

Port::Ticket DirectPort::begin(std::span<const Query> questions, std::span<Rgb> answers) {
    std::optional<ScopedActivity> turned;
    if (node_.gauge) turned.emplace(*node_.gauge, node_.doing);
    const std::size_t most = node_.whole ? questions.size() : chunk;
    for (std::size_t first = 0; first < questions.size(); first += most) {
        const std::size_t n = std::min(most, questions.size() - first);
        if (pause_) pause_();
        answer(node_, width_, questions.subspan(first, n), answers.subspan(first * width_, n * width_));
    }
    count_ += questions.size();
    return 0;
}

void answer(const Callee& node, std::size_t width, std::span<const Query> questions, std::span<Rgb> answers) try {
    if (are_plain(questions) ||
        std::all_of(questions.begin(), questions.end(), [&](const Query& q) { return is_for(node, q); }))
        answer_all(node, width, questions, answers);
    else
        answer_some(node, width, questions, answers);
    check_float_mode();
    if (node.not_finite) *node.not_finite += not_finite_among(answers);
} catch (const NodeError& error) {
    throw NodeError("'" + node.name + "'", error.what(), error.host());
} catch (const std::exception& error) {
    throw NodeError("'" + node.name + "'" + culprit(node, questions), words_of(error), {});
}

}  // namespace lightnet
