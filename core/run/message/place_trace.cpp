#include "core/run/message/place_trace.hpp"

#include <bit>
#include <cstring>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

static_assert(std::endian::native == std::endian::little, "traces travel as they lie in memory");

template <class Number>
void put(std::string& bytes, Number number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

class TraceReader {
public:
    explicit TraceReader(std::string_view bytes) : bytes_(bytes) {}
    bool at_end() const { return bytes_.empty(); }
    std::string_view take(std::size_t size) {
        if (size > bytes_.size()) throw Error("a trace is cut off");
        const auto taken = bytes_.substr(0, size);
        bytes_.remove_prefix(size);
        return taken;
    }
    template <class Number>
    Number number() {
        Number number;
        std::memcpy(&number, take(sizeof number).data(), sizeof number);
        return number;
    }
    std::size_t left() const { return bytes_.size(); }

private:
    std::string_view bytes_;
};

}  // namespace

std::string to_bytes(const std::vector<PlaceTrace>& traces) {
    std::string bytes;
    for (const auto& trace : traces) {
        put(bytes, static_cast<std::uint32_t>(trace.host.size()));
        bytes += trace.host;
        put(bytes, trace.index);
        put(bytes, trace.dropped);
        put(bytes, static_cast<std::uint64_t>(trace.events.size()));
        bytes.append(reinterpret_cast<const char*>(trace.events.data()), trace.events.size() * sizeof(TraceEvent));
    }
    return bytes;
}

std::vector<PlaceTrace> place_traces_from(std::string_view bytes) {
    std::vector<PlaceTrace> traces;
    for (TraceReader reader(bytes); !reader.at_end();) {
        auto& trace = traces.emplace_back();
        trace.host = reader.take(reader.number<std::uint32_t>());
        trace.index = reader.number<std::uint32_t>();
        trace.dropped = reader.number<std::uint64_t>();
        const auto count = reader.number<std::uint64_t>();
        if (count > reader.left() / sizeof(TraceEvent)) throw Error("a trace is cut off");
        trace.events.resize(count);
        const auto events = reader.take(count * sizeof(TraceEvent));
        if (count) std::memcpy(trace.events.data(), events.data(), events.size());
        for (const auto& event : trace.events)
            if (event.kind > TraceKind::waiting || event.end < event.begin) throw Error("a trace is damaged");
    }
    return traces;
}

}  // namespace lightnet
