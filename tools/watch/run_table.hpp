// The state of a run, as a table for terminals.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json.hpp"

namespace lightnet {

/// A value.
struct RunTable {
    struct HostRow {
        std::string name, state;
        bool there = true;
        std::uint64_t places = 0, answered = 0;
        std::array<double, 4> parts{};  // of its places' time: busy, asking, waiting, idle; all 0: not known
    };
    struct NodeRow {
        std::string name, kind;
        double questions = 0;  // a second, or in all
        double share = 0;      // of the time of all places
        double waiting = 0;    // questions that wait there
        double bundle = 0;     // questions in one, on average
        double bytes = 0;      // a second, or in all
        double latency = 0;    // seconds from sending a bundle to its answer
    };
    std::string graph, standing;
    std::optional<double> done;  // 0 … 1; none: not known
    double seconds = 0;
    std::optional<double> left;  // seconds
    bool rates = true;           // questions and bytes are per second
    std::vector<HostRow> hosts;
    std::vector<NodeRow> nodes;
    std::vector<std::string> lines;  // of the log, the newest last
};

/// In lines of at most so many letters and, where there are more hosts or lines of the log than fit, at most so many
/// lines. `rows` 0: all.
std::string to_text(const RunTable& table, std::size_t columns, std::size_t rows);

/// Of x.run.json. Throws Error when it is none.
RunTable table_of_report(const std::string& text);

/// A run that is watched, from what its launcher says to pages (watch_json.hpp). One thread's.
class LiveTable {
public:
    /// Throws Error on what no launcher of this build says.
    void hear(const std::string& text);
    RunTable table() const;
    /// "": it goes on.
    std::string outcome() const;
    /// Something has changed since this was last asked.
    bool changed();
    /// What became of the last wish: it was allowed; none: nothing was said.
    std::optional<bool> allowed() const { return allowed_; }
    /// And that it was obeyed: "", or why not; none: not yet.
    const std::optional<std::string>& why_not() const { return why_not_; }

private:
    const Json* before() const;

    Json hello_, none_;
    std::deque<Json> states_;
    std::vector<std::string> lines_;
    std::optional<bool> allowed_;
    std::optional<std::string> why_not_;
    bool changed_ = false;
};

}  // namespace lightnet
