// Tells a scheduler stories, and collects what it does.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <map>
#include <utility>
#include <variant>
#include <vector>

#include "core/run/schedule/scheduler.hpp"

namespace lightnet::test {

class SchedulerStory : public ::testing::Test {
protected:
    using Replicas = std::vector<Scheduler::Replica>;

    // The replicas to which a tick sends.
    Replicas tick() {
        tell(Scheduler::Tick{});
        Replicas to;
        for (const auto& action : actions)
            if (const auto* send = std::get_if<Scheduler::Send>(&action)) {
                copies[{send->work, send->replica}] = send->copy;
                to.push_back(send->replica);
            }
        return to;
    }
    void reply(Scheduler::WorkId work, Scheduler::Replica from, double service = 0, std::size_t fill = 0) {
        tell(Scheduler::Replied{copies.at({work, from}), fill, service});
    }
    void tell(const Scheduler::Event& event) {
        actions.clear();
        scheduler.on(event, now, actions);
    }
    template <class Action>
    bool did() const {
        return !actions.empty() && std::holds_alternative<Action>(actions.front());
    }

    Scheduler scheduler{{}};
    double now = 0;
    std::vector<Scheduler::Action> actions;
    std::map<std::pair<Scheduler::WorkId, Scheduler::Replica>, Scheduler::CopyId> copies;
};

}  // namespace lightnet::test
