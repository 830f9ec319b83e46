#include "tools/session/run_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "core/base/json_tree.hpp"
#include "core/network/graph/hosts.hpp"
#include "core/run/message/place_name.hpp"

namespace lightnet {
namespace {

constexpr std::array<const char*, 7> kind_names{"prepare", "light", "tiles", "call", "send", "take", "waiting"};

// A text of JSON, with its quotes.
std::string json_text(const std::string& text) { return to_text(text); }

struct TraceEnds {
    std::size_t sent = 0, taken = 0;
};

class TraceWriter {
public:
    TraceWriter(const std::vector<PlaceTrace>& traces, const std::vector<std::string>& nodes)
        : traces_(traces), nodes_(nodes) {
        for (const auto& trace : traces) {
            hosts_.try_emplace(trace.host, 0);
            for (const auto& event : trace.events) {
                first_ = std::min(first_, time_of(trace, event.begin));
                if (event.kind == TraceKind::send) ++ends_[event.id].sent;
                if (event.kind == TraceKind::take) ++ends_[event.id].taken;
            }
        }
        int number = 0;
        for (auto& [host, process] : hosts_) process = ++number;
    }

    std::string write(const std::vector<MoveReport>& moves) {
        text_ = metadata() + ",\"traceEvents\":[";
        for (const auto& [host, process] : hosts_)
            add(fmt::format(R"({{"ph":"M","name":"process_name","pid":{},"tid":0,"args":{{"name":{}}}}})", process,
                            json_text(name_of_host(host))));
        for (const auto& trace : traces_) write_place(trace);
        for (const auto& move : moves)
            for (const auto& who : move.nodes)
                add(fmt::format(R"({{"ph":"i","name":{},"cat":"move","s":"g","pid":1,"tid":0,"ts":{:.3f}}})",
                                json_text(who), double(static_cast<std::int64_t>(move.at_ns) - first_) / 1000));
        return text_ + "\n]}\n";
    }

private:
    static std::string name_of_host(const std::string& host) { return host.empty() ? std::string(own_process) : host; }
    static std::int64_t time_of(const PlaceTrace& trace, std::uint64_t time) {
        return static_cast<std::int64_t>(time) - trace.clock_ahead;
    }
    static std::uint32_t thread_of(const PlaceTrace& trace) {
        return trace.index == any_place ? 100000 : trace.index + 1;
    }

    std::string metadata() const {
        std::uint64_t dropped = 0, lonely = 0;
        for (const auto& trace : traces_) dropped += trace.dropped;
        for (const auto& [id, ends] : ends_) lonely += !(ends.sent && ends.taken);
        std::string clocks;
        for (const auto& [host, process] : hosts_) {
            const auto trace = std::find_if(traces_.begin(), traces_.end(),
                                            [&, host = host](const auto& one) { return one.host == host; });
            const bool known = trace->clock_error != std::numeric_limits<std::uint64_t>::max();
            clocks += fmt::format("{}{}:{{\"ahead_us\":{:.3f},\"error_us\":{}}}", clocks.empty() ? "" : ",",
                                  json_text(name_of_host(host)), double(trace->clock_ahead) / 1000,
                                  known ? fmt::format("{:.3f}", double(trace->clock_error) / 1000) : "null");
        }
        return fmt::format("{}1\",\"dropped_events\":{},\"arrows_with_one_end\":{},\"clocks\":{{{}}}}}",
                           trace_beginning, dropped, lonely, clocks);
    }

    void add(const std::string& event) { text_ += (std::exchange(any_, true) ? ",\n" : "\n") + event; }

    void write_place(const PlaceTrace& trace) {
        const int process = hosts_.at(trace.host);
        const auto thread = thread_of(trace);
        add(fmt::format(R"({{"ph":"M","name":"thread_name","pid":{},"tid":{},"args":{{"name":"{}"}}}})", process,
                        thread, trace.index == any_place ? "dispatcher" : fmt::format("place {}", trace.index)));
        for (const auto& event : trace.events) {
            const double begin = microseconds(trace, event.begin), end = microseconds(trace, event.end);
            if (event.kind == TraceKind::waiting) {
                add(fmt::format(
                    R"({{"ph":"C","name":"waiting {}","pid":{},"tid":{},"ts":{:.3f},"args":{{"questions":{}}}}})",
                    trace.index, process, thread, begin, event.id));
                continue;
            }
            write_slice(event, process, thread, begin, end);
        }
    }

    void write_slice(const TraceEvent& event, int process, std::uint32_t thread, double begin, double end) {
        const auto kind = static_cast<std::size_t>(event.kind);
        const std::string node = event.node < nodes_.size() ? nodes_[event.node] : fmt::format("node {}", event.node);
        const bool bundle = event.kind == TraceKind::send || event.kind == TraceKind::take;
        const auto name = bundle ? fmt::format("{} {}", kind_names[kind], node) : node;
        add(fmt::format(R"({{"ph":"X","name":{},"cat":"{}","pid":{},"tid":{},"ts":{:.3f},"dur":{:.3f}}})",
                        json_text(name), kind_names[kind], process, thread, begin, end - begin));
        if (!bundle || !ends_[event.id].sent || !ends_[event.id].taken) return;
        // What is sent has left before the slice ends, and what is taken has come by then.
        const double at = event.kind == TraceKind::send ? begin : std::max(begin, end - 0.001);
        add(fmt::format(R"({{"ph":"{}","name":"bundle","cat":"bundle","id":"{:#x}","pid":{},"tid":{},"ts":{:.3f}{}}})",
                        event.kind == TraceKind::send ? "s" : "f", event.id, process, thread, at,
                        event.kind == TraceKind::send ? "" : R"(,"bp":"e")"));
    }

    double microseconds(const PlaceTrace& trace, std::uint64_t time) const {
        return static_cast<double>(time_of(trace, time) - first_) / 1000;
    }

    const std::vector<PlaceTrace>& traces_;
    const std::vector<std::string>& nodes_;
    std::map<std::string, int> hosts_;
    std::map<std::uint64_t, TraceEnds> ends_;
    std::int64_t first_ = std::numeric_limits<std::int64_t>::max();
    std::string text_;
    bool any_ = false;
};

}  // namespace

std::string to_trace_json(const std::vector<PlaceTrace>& traces, const std::vector<std::string>& nodes,
                          const std::vector<MoveReport>& moves) {
    return TraceWriter(traces, nodes).write(moves);
}

}  // namespace lightnet
