// Lines that nodes say to the user.
#pragma once

#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace lightnet {

/// Says each line once, however many places say it.
class SaidOnce {
public:
    explicit SaidOnce(std::function<void(const std::string&)> say) : say_(std::move(say)) {}

    /// The lines of a node.
    void say(const std::string& node, std::string_view lines) {
        while (!lines.empty()) {
            const auto end = std::min(lines.find('\n'), lines.size());
            const std::string line = node + ": " + std::string(lines.substr(0, end));
            if (said_.insert(line).second) say_(line);
            lines.remove_prefix(std::min(end + 1, lines.size()));
        }
    }

private:
    std::function<void(const std::string&)> say_;
    std::set<std::string> said_;
};

}  // namespace lightnet
