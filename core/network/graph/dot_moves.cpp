#include "core/network/graph/dot_moves.hpp"

#include <fmt/format.h>

#include <optional>

namespace lightnet {
namespace {

/// Adds to the end of a drawing.
class MovesDrawing {
public:
    MovesDrawing(const Graph& graph, const Plan& plan) : graph_(graph), plan_(plan) {}

    void draw(const DrawnMove& move) {
        const auto when = fmt::format("{:.1f} s", move.seconds);
        std::vector<std::string> begin;
        for (const auto& host : move.from) begin.push_back(draw_box(move.node, host, when));
        if (begin.empty()) begin.emplace_back("launcher");
        for (const auto& host : move.to)
            if (const auto end = replica(move.node, host))
                for (const auto& from : begin)
                    text_ += fmt::format("  {} -> {} [label=\"{} moves\\nat {}\", style=dotted, constraint=false];\n",
                                         from, *end, move.node, when);
    }
    const std::string& text() const { return text_; }

private:
    // Where the node was, within its host if that is still there.
    std::string draw_box(const std::string& node, const std::string& host, const std::string& when) {
        const auto id = fmt::format("left_{}_{}", node, boxes_++);
        const auto box =
            fmt::format("{} [label=\"{}\\nuntil {}\", style=\"rounded,dashed\", color=grey];", id, node, when);
        const auto number = number_of(host);
        text_ += number ? fmt::format("  subgraph cluster_host_{} {{ {} }}\n", *number, box) : "  " + box + "\n";
        return id;
    }

    // As to_dot() counts hosts.
    std::optional<std::size_t> number_of(const std::string& host) const {
        std::size_t number = 0;
        for (std::size_t place = 0; place < plan_.places.size(); ++place) {
            if (place > 0 && plan_.places[place].host != plan_.places[place - 1].host) ++number;
            if (plan_.places[place].host == host) return number;
        }
        return std::nullopt;
    }

    // The first of the host; none: the node has gone on, or the host has.
    std::optional<std::string> replica(const std::string& name, const std::string& host) const {
        const auto node = graph_.find(name);
        if (!node) return std::nullopt;
        for (const auto place : plan_.places_of[*node])
            if (plan_.places[place].host == host) return fmt::format("node_{}_{}", name, place);
        return std::nullopt;
    }

    const Graph& graph_;
    const Plan& plan_;
    std::string text_;
    int boxes_ = 0;
};

}  // namespace

std::string with_moves(std::string dot, const Graph& graph, const Plan& plan, const std::vector<DrawnMove>& moves) {
    MovesDrawing drawing(graph, plan);
    for (const auto& move : moves) drawing.draw(move);
    return dot.insert(dot.rfind('}'), drawing.text());
}

}  // namespace lightnet
