#include "core/run/assembly/activity.hpp"

#include <sstream>
#include <utility>

namespace lightnet {

// A line each: numbers, the node, and what it does.
std::string to_text(const Doings& doings) {
    std::string text;
    for (const auto& [node, doing] : doings)
        text += std::to_string(doing.done) + ' ' + std::to_string(doing.total) + ' ' + node + ' ' + doing.what + '\n';
    return text;
}

Doings doings_from(std::string_view text) {
    Doings doings;
    std::istringstream lines{std::string(text)};
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string node;
        Doing doing;
        if (words >> doing.done >> doing.total >> node && words.get() == ' ' && std::getline(words, doing.what))
            doings[node] = std::move(doing);
    }
    return doings;
}

void Activity::set(const std::string& node, Doing doing) {
    const std::lock_guard lock(mutex_);
    doings_[node] = std::move(doing);
}

void Activity::set(const std::string& node, std::uint64_t done, std::uint64_t total) {
    const std::lock_guard lock(mutex_);
    const auto found = doings_.find(node);
    if (found != doings_.end()) found->second.done = done, found->second.total = total;
}

Doings Activity::all() const {
    const std::lock_guard lock(mutex_);
    return doings_;
}

}  // namespace lightnet
