// Activities that the nodes of a process report while they prepare: for display.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <string_view>

namespace lightnet {

/// What a node does, and how much of it is done.
struct Doing {
    std::string what;
    std::uint64_t done = 0, total = 0;  // 0 of 0: not known
    friend bool operator==(const Doing&, const Doing&) = default;
};
/// By name of the node.
using Doings = std::map<std::string, Doing>;

/// As it rides on heartbeats, and back; what is damaged is left out.
std::string to_text(const Doings& doings);
Doings doings_from(std::string_view text);

/// Any thread. What was said last counts, whichever place said it.
class Activity {
public:
    void set(const std::string& node, Doing doing);
    /// How far a node has got with what it does.
    void set(const std::string& node, std::uint64_t done, std::uint64_t total);
    Doings all() const;

private:
    mutable std::mutex mutex_;
    Doings doings_;
};

}  // namespace lightnet
