#include "core/run/message/figures.hpp"

#include <array>
#include <charconv>
#include <cstddef>

#include "core/network/graph/graph.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_figured_places = 4096;

constexpr std::array of_place{&PlaceFigures::busy, &PlaceFigures::asking, &PlaceFigures::waiting, &PlaceFigures::idle};
constexpr std::array of_node{&NodeFigures::looks,     &NodeFigures::waiting, &NodeFigures::bundles,
                             &NodeFigures::questions, &NodeFigures::bytes,   &NodeFigures::nanoseconds,
                             &NodeFigures::answered};

constexpr std::array of_edge{&EdgeFigures::questions, &EdgeFigures::bundles, &EdgeFigures::sent, &EdgeFigures::bytes};

// Numbers, one behind the other.
class NumberReader {
public:
    explicit NumberReader(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}
    std::uint64_t next() {
        std::uint64_t number = 0;
        const auto [end, fault] = std::from_chars(at_, end_, number);
        sound_ = sound_ && fault == std::errc{} && end != end_ && *end == ' ';
        at_ = sound_ ? end + 1 : end_;
        return number;
    }
    // How many follow of something.
    std::size_t count(std::size_t most) {
        const auto number = next();
        sound_ = sound_ && number <= most;
        return sound_ ? static_cast<std::size_t>(number) : 0;
    }
    bool sound() const { return sound_; }
    bool finished() const { return sound_ && at_ == end_; }

private:
    const char *at_, *end_;
    bool sound_ = true;
};

}  // namespace

NodeFigures& NodeFigures::operator+=(const NodeFigures& more) {
    for (const auto member : of_node) this->*member += more.*member;
    return *this;
}

EdgeFigures& EdgeFigures::operator+=(const EdgeFigures& more) {
    for (const auto member : of_edge) this->*member += more.*member;
    return *this;
}

std::string to_text(const HostFigures& figures) {
    std::string text;
    const auto put = [&text](std::uint64_t number) { text += std::to_string(number) + ' '; };
    put(figures.places.size());
    for (const auto& place : figures.places)
        for (const auto member : of_place) put(place.*member);
    put(figures.nodes.size());
    for (const auto& node : figures.nodes)
        for (const auto member : of_node) put(node.*member);
    put(figures.edges.size());
    for (const auto& edge : figures.edges)
        for (const auto member : of_edge) put(edge.*member);
    put(figures.clock_ns), put(figures.processor_ns);
    return text;
}

std::optional<HostFigures> figures_from(std::string_view text) {
    NumberReader numbers(text);
    HostFigures figures;
    // Grows as numbers come: a short text takes no room for many.
    for (auto left = numbers.count(most_figured_places); left > 0 && numbers.sound(); --left)
        for (auto& place = figures.places.emplace_back(); const auto member : of_place) place.*member = numbers.next();
    for (auto left = numbers.count(most_nodes); left > 0 && numbers.sound(); --left)
        for (auto& node = figures.nodes.emplace_back(); const auto member : of_node) node.*member = numbers.next();
    for (auto left = numbers.count(most_references); left > 0 && numbers.sound(); --left)
        for (auto& edge = figures.edges.emplace_back(); const auto member : of_edge) edge.*member = numbers.next();
    figures.clock_ns = numbers.next(), figures.processor_ns = numbers.next();
    if (!numbers.finished()) return std::nullopt;
    return figures;
}

}  // namespace lightnet
