#include "core/run/assembly/edge_meter.hpp"

#include <algorithm>
#include <utility>

#include "core/network/light/port.hpp"

namespace lightnet {
namespace {

std::uint64_t since(std::chrono::nanoseconds begun, std::chrono::nanoseconds now) {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(0, (now - begun).count()));
}

}  // namespace

class EdgeMeter::MeteredPort final : public Port {
public:
    MeteredPort(EdgeMeter& meter, Measured& edge, std::size_t asker, std::size_t asked, Port& port)
        : meter_(meter), figures_(edge.record), shown_(*edge.shown), asker_(asker), asked_(asked), port_(port) {}

    Ticket begin(std::span<const Query> questions, std::span<Rgb> answers) override {
        ++figures_.asks;
        figures_.questions += questions.size();
        shown_.questions.add(questions.size());
        const Asking asking(meter_.gauge_, &shown_);
        const auto begun = meter_.running_();
        const auto called_at =
            meter_.tracer_ ? std::chrono::steady_clock::now() : std::chrono::steady_clock::time_point{};
        const auto ticket = port_.begin(questions, answers);
        const auto ran = since(begun, meter_.running_());
        figures_.called_ns += ran;
        if (meter_.learns_ && meter_.learns_(asker_))
            figures_.learning += questions.size(), figures_.learning_ns += ran;
        if (meter_.tracer_ && !ticket) meter_.tracer_->called(asked_, called_at);
        return ticket;
    }
    void finish(Ticket ticket) override {
        const auto begun = std::chrono::steady_clock::now();
        port_.finish(ticket);
        figures_.waited_ns += since({}, std::chrono::steady_clock::now() - begun);
    }
    void abandon(Ticket ticket) noexcept override { port_.abandon(ticket); }

private:
    // Nodes that are called meanwhile ask along edges of their own.
    class Asking {
    public:
        Asking(Gauge& gauge, Gauge::Edge* edge) : gauge_(gauge), before_(std::exchange(gauge.along, edge)) {}
        ~Asking() { gauge_.along = before_; }
        Asking(const Asking&) = delete;
        Asking& operator=(const Asking&) = delete;

    private:
        Gauge& gauge_;
        Gauge::Edge* before_;
    };

    EdgeMeter& meter_;
    EdgeRecord& figures_;
    Gauge::Edge& shown_;
    std::size_t asker_, asked_;
    Port& port_;
};

EdgeMeter::EdgeMeter(Gauge& gauge, std::vector<AskingEdge> shown, Running running)
    : gauge_(gauge), shown_(std::move(shown)), running_(std::move(running)) {}

// Who names an input twice has two edges to it: the first stands for both.
EdgeMeter::Measured& EdgeMeter::measured(std::size_t asker, std::size_t asked) {
    auto& edge = edges_[{asker, asked}];
    if (edge.shown) return edge;
    const auto found = std::find(shown_.begin(), shown_.end(), AskingEdge{asker, asked});
    edge.shown = found == shown_.end() ? &edge.own : &gauge_.edges[static_cast<std::size_t>(found - shown_.begin())];
    return edge;
}

EdgeMeter::~EdgeMeter() = default;

Assembly::Tap EdgeMeter::tap(Assembly::Tap behind) {
    return [this, behind](std::size_t asker, std::size_t asked, std::size_t width, Port* port) -> Port* {
        if (behind) port = behind(asker, asked, width, port);
        return ports_.emplace_back(std::make_unique<MeteredPort>(*this, measured(asker, asked), asker, asked, *port))
            .get();
    };
}

void EdgeMeter::write(const Graph& graph, PlaceRecord& to) const {
    for (const auto& [ends, edge] : edges_) {
        if (!edge.record.asks) continue;
        auto& record = to.edges[{graph.nodes[ends.first].name, graph.nodes[ends.second].name}] = edge.record;
        record.bundles = edge.shown->bundles.get();
        record.sent = edge.shown->sent.get(), record.bytes = edge.shown->bytes.get();
    }
}

}  // namespace lightnet
