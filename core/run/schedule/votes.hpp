// Votes of several hosts on the same questions, and whom to believe.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/hash.hpp"

namespace lightnet {

/// One vote for each host; answers are told apart by their hash. A value.
class Votes {
public:
    /// `own`: the host whose answers are believed without another's, as they are the asker's own; none: no host's are.
    explicit Votes(std::optional<std::string> own = std::nullopt) : own_(std::move(own)) {}

    /// A host has one vote: what it says a second time does not count.
    void add(const std::string& host, const Hash& answer) {
        const bool known =
            std::any_of(given_.begin(), given_.end(), [&](const auto& vote) { return vote.first == host; });
        if (!known) given_.emplace_back(host, answer);
    }
    bool empty() const { return given_.empty(); }
    std::size_t size() const { return given_.size(); }
    /// What two hosts have answered alike, or our own, when another has answered as well. None: it is not settled.
    std::optional<Hash> settled() const {
        if (given_.size() < 2) return std::nullopt;
        const std::pair<std::string, Hash>* found = nullptr;
        for (auto vote = given_.begin(); vote != given_.end(); ++vote) {
            if (vote->first == own_) return vote->second;
            if (std::any_of(vote + 1, given_.end(), [&](const auto& other) { return other.second == vote->second; }))
                found = &*vote;
        }
        return found ? std::optional(found->second) : std::nullopt;
    }
    /// Who has answered otherwise.
    std::vector<std::string> against(const Hash& answer) const {
        std::vector<std::string> hosts;
        for (const auto& [host, said] : given_)
            if (said != answer) hosts.push_back(host);
        return hosts;
    }
    std::vector<std::string> hosts() const {
        std::vector<std::string> hosts;
        for (const auto& [host, said] : given_) hosts.push_back(host);
        return hosts;
    }
    /// "tcp://a:1, tcp://b:1".
    std::string names() const {
        std::string names;
        for (const auto& [host, said] : given_)
            names += (names.empty() ? "" : ", ") + (host.empty() ? "this process" : host);
        return names;
    }

private:
    std::optional<std::string> own_;
    std::vector<std::pair<std::string, Hash>> given_;
};

}  // namespace lightnet
