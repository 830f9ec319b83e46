#include "core/run/prepare/direct_port.hpp"

#include <xmmintrin.h>
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
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

// Which question a node threw at: each is asked alone until it throws again. Empty: none is to blame.
std::string culprit(const Callee& node, std::span<const Query> questions) {
    std::vector<Rgb> answer(node.layers);
    std::string found;
    for (const auto& question : questions) {
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

}  // namespace

DirectPort::DirectPort(Callee node, std::size_t width, std::uint64_t& count, std::function<void()> pause)
    : node_(node), width_(width), count_(count), pause_(std::move(pause)) {}

Port::Ticket DirectPort::begin(std::span<const Query> questions, std::span<Rgb> answers) {
    std::optional<Turned> turned;
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
    if (width == node.layers) {
        std::fill(answers.begin(), answers.end(), Rgb{});
        node.light.light(questions, answers);
    } else {
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
    check_float_mode();
    if (node.not_finite)
        for (const Rgb& colour : answers) *node.not_finite += !finite(colour);
} catch (const NodeError& error) {
    throw NodeError("'" + node.name + "'", error.what(), error.host());
} catch (const std::exception& error) {
    throw NodeError("'" + node.name + "'" + culprit(node, questions), error.what(), {});
}

}  // namespace lightnet
