// The part of a proposed plan that is put in force.
#pragma once

#include <cstddef>
#include <set>

#include "core/run/master/prepare_state.hpp"

namespace lightnet {

/// Decides who is asked for what: nobody for a node that is not prepared there, except in a rehearsal. So that a place
/// that has not heard of the newest plan asks nobody falsely either, who is in force for a node stays so until all have
/// it. A view of the state, beside what it remembers of places.
class PlanInForce {
public:
    explicit PlanInForce(PrepareState& state) : state_(state) {}

    /// Puts in force what can be asked by now. `rehearsing`: those who take part in a rehearsal, and are asked before
    /// they are prepared; null: none goes on. False: that is in force already, or soon enough.
    bool enforce(const std::set<NodeCopy>* rehearsing);
    /// A place is gone.
    void lose(const PlaceAt& place) { known_prepared_.erase(place); }
    /// Nobody is known to have had all.
    void begin_pass() { known_prepared_.clear(); }

private:
    std::set<PlaceAt> behind() const;
    std::set<NodeCopy> copies_to_ask(std::size_t position, const std::set<PlaceAt>& late) const;
    void keep_where_it_was(Plan& plan, std::size_t position) const;
    Plan restricted();

    PrepareState& state_;
    const std::set<NodeCopy>* rehearsing_ = nullptr;
    std::set<PlaceAt> known_prepared_;  // had all that can be asked, once
    double enforced_ = 0;               // when
};

}  // namespace lightnet
